//! What to simulate.

use super::profile::{DriveProfile, YawRateSensor};
use super::scenario::Scenario;
use super::wire;
use boresight_core::InputError;
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_math::error::check_range;
use boresight_options::{Described, Naming, check};
use serde::{Deserialize, Serialize};

/// Longest drive, s.
pub const MAX_DURATION_S: f64 = 7200.0;

/// Most radars times seconds of one drive: four radars for an hour.
pub const MAX_SENSOR_SECONDS: f64 = 14_400.0;

/// Most radars times seconds of one drive of the profile "radarscenes", whose scans hold five times as
/// much: four radars for twenty minutes.
pub const MAX_DENSE_SENSOR_SECONDS: f64 = 4800.0;

/// Highest share of moving detections that can be asked for.
pub const MAX_MOVING_SHARE: f64 = 0.8;

/// How well a radar measures.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct RadarNoise {
    /// Standard deviation of azimuth at boresight.
    #[option(default = 0.35_f64.to_radians(), range = 0..=10)]
    pub azimuth_sigma_rad: f64,
    /// Growth of it: `sigma (1 + growth (azimuth / 60 deg)^2)`.
    #[option(default = 2.0, range = 0..=20)]
    pub azimuth_growth: f64,
    /// Standard deviation of range rate.
    #[option(default = 0.05, range = 0..=5)]
    pub range_rate_sigma_mps: f64,
    /// Standard deviation of range.
    #[option(default = 0.1, range = 0..=5)]
    pub range_sigma_m: f64,
    /// Length of the interval a range rate is measured over. It ends at the scan's time stamp;
    /// each detection has the range rate of a random instant within.
    #[option(default = 0.04, range = 0..=0.07)]
    pub coherent_interval_s: f64,
    /// Share of detections of standing things that get a random range rate (multipath).
    #[option(default = 0.012, range = 0..=0.5)]
    pub ghost_share: f64,
    /// Mean number of false detections a scan.
    #[option(default = 0.5, range = 0..=50)]
    pub clutter: f64,
}

/// A drive to simulate.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct DriveOptions {
    /// Roads and traffic.
    pub scenario: Scenario,
    /// What the errors of radars and car are like.
    pub profile: DriveProfile,
    /// Everything random comes from it.
    pub seed: u64,
    /// The car, by which drives of the profile "radarscenes" share azimuth biases and slip.
    pub car: u64,
    /// Length of the drive; four radars for an hour at most, or as much by fewer; in the profile
    /// "radarscenes" for twenty minutes.
    #[option(default = 60.0, range = 1.0..=MAX_DURATION_S)]
    pub duration_s: f64,
    /// The radars by number, where they truly sit and look; those of RadarScenes if absent.
    #[option(default = RADARSCENES_SENSORS.to_vec(), described_as = Vec<wire::PlacedRadar>)]
    #[serde(with = "wire::sensors")]
    pub sensors: Vec<(u8, Mounting)>,
    /// By how much a radar's true yaw exceeds the one the log states, by its number; zero for
    /// radars not named.
    #[option(described_as = wire::Misalignments)]
    #[serde(with = "wire::misalignments")]
    pub misalignment_rad: Vec<(u8, f64)>,
    /// Share of moving detections over the scans taken at more than 1 m/s, by leaving out whole
    /// movers or detections of standing things. If absent, what the scenario's traffic gives; in the
    /// profile "radarscenes", where front radars see more of it than the sides, as scenes have it.
    #[option(range = 0.0..=MAX_MOVING_SHARE)]
    pub moving_share: Option<f64>,
    /// How well radars measure; the profile "radarscenes" has numbers of its own.
    pub noise: RadarNoise,
    /// What measures the yaw rate, where scale, bias and noise are not given. If absent, a series
    /// sensor of constant bias, and in the profile "radarscenes" navigation.
    pub yaw_rate_sensor: Option<YawRateSensor>,
    /// Measured over true yaw rate; drawn as the sensor has it if absent, from 0.98 to 1.02 in series.
    #[option(range = 0.5..=2.0)]
    pub yaw_rate_scale: Option<f64>,
    /// Yaw rate measured at standstill; drawn as the sensor has it if absent, from -0.2 to 0.2 deg/s
    /// in series.
    #[option(range = -50..=50)]
    pub yaw_rate_bias_radps: Option<f64>,
    /// Standard deviation of a sample's white noise; if absent 0.03 deg/s of navigation, and drawn from
    /// 0.07 to 0.13 deg/s in series.
    #[option(range = 0..=50)]
    pub yaw_rate_sigma_radps: Option<f64>,
    /// Measured over true speed; if absent 1, and drawn in the profile "radarscenes".
    #[option(range = 0.5..=2.0)]
    pub speed_scale: Option<f64>,
    /// Standard deviation of a sample of speed; 0.03 m/s if absent. At standstill the speed reads
    /// zero.
    #[option(range = 0..=5)]
    pub speed_sigma_mps: Option<f64>,
    /// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees;
    /// outwards, as tyres slip. If absent 0, and drawn in the profile "radarscenes".
    #[option(range = -1..=1)]
    pub slip_gradient_rad: Option<f64>,
}

impl DriveOptions {
    /// Checks every number.
    ///
    /// # Errors
    /// [`InputError::Empty`] without radars, [`InputError::OutOfRange`] for a number out of range,
    /// a radar named twice, or a misaligned radar that is not there.
    pub fn check(&self) -> Result<(), InputError> {
        check(self, Naming::Rust)?;
        if self.profile == DriveProfile::Radarscenes && self.noise != RadarNoise::default() {
            return Err(InputError::Incompatible {
                what: "noise".into(),
                expected: "the default, because the profile radarscenes has its own noise".into(),
                given: "other than the default".into(),
            });
        }
        if self.sensors.is_empty() {
            return Err(InputError::Empty {
                what: "sensors".into(),
                expected: "at least one radar".into(),
            });
        }
        let sensor_seconds = self.sensors.len() as f64 * self.duration_s;
        let most = match self.profile {
            DriveProfile::Clean => MAX_SENSOR_SECONDS,
            DriveProfile::Radarscenes => MAX_DENSE_SENSOR_SECONDS,
        };
        check_range("sensors times duration_s", sensor_seconds, 0.0, most)?;
        for (i, (id, mounting)) in self.sensors.iter().enumerate() {
            check_range("x_m of a sensor", mounting.x_m, -20.0, 20.0)?;
            check_range("y_m of a sensor", mounting.y_m, -20.0, 20.0)?;
            check_range("yaw_rad of a sensor", mounting.yaw_rad, -10.0, 10.0)?;
            if self.sensors[..i].iter().any(|(other, _)| other == id) {
                return Err(wrong_sensor("sensors", "each number once", *id));
            }
        }
        for (id, angle) in &self.misalignment_rad {
            check_range("misalignment_rad", *angle, -1.6, 1.6)?;
            if self.sensors.iter().all(|(known, _)| known != id) {
                return Err(wrong_sensor("misalignment_rad", "numbers of the sensors", *id));
            }
        }
        Ok(())
    }

    /// What measures the yaw rate; nothing for the clean profile's own.
    pub(crate) fn yaw_rate_sensor(&self) -> Option<YawRateSensor> {
        self.yaw_rate_sensor.or(match self.profile {
            DriveProfile::Clean => None,
            DriveProfile::Radarscenes => Some(YawRateSensor::Navigation),
        })
    }

    /// The misalignment of a radar, rad.
    pub(crate) fn misalignment(&self, id: u8) -> f64 {
        self.misalignment_rad.iter().find(|(known, _)| *known == id).map_or(0.0, |(_, a)| *a)
    }
}

fn wrong_sensor(what: &str, expected: &str, id: u8) -> InputError {
    InputError::OutOfRange { what: what.into(), expected: expected.into(), given: f64::from(id) }
}
