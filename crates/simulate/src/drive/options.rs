//! What to simulate.

use super::scenario::Scenario;
use boresight_core::CoreError;
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_core::error::check_range;

/// Longest drive, s.
pub const MAX_DURATION_S: f64 = 7200.0;

/// Most radars times seconds of one drive: four radars for an hour.
pub const MAX_SENSOR_SECONDS: f64 = 14_400.0;

/// Highest share of moving detections that can be asked for.
pub const MAX_MOVING_SHARE: f64 = 0.8;

/// How well a radar measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadarNoise {
    /// Standard deviation of azimuth at boresight, rad.
    pub azimuth_sigma_rad: f64,
    /// Growth of it: `sigma (1 + growth (azimuth / 60 deg)^2)`.
    pub azimuth_growth: f64,
    /// Standard deviation of range rate, m/s.
    pub range_rate_sigma_mps: f64,
    /// Standard deviation of range, m.
    pub range_sigma_m: f64,
    /// Length of the interval a range rate is measured over, s. It ends at the scan's time stamp;
    /// each detection has the range rate of a random instant within.
    pub coherent_interval_s: f64,
    /// Share of detections of standing things that get a random range rate (multipath).
    pub ghost_share: f64,
    /// Mean number of false detections a scan.
    pub clutter: f64,
}

impl Default for RadarNoise {
    /// 0.35 deg, thrice that at the edge; 0.05 m/s, 0.1 m, 40 ms; 1.2 % and 0.5 a scan.
    fn default() -> Self {
        Self {
            azimuth_sigma_rad: 0.35_f64.to_radians(),
            azimuth_growth: 2.0,
            range_rate_sigma_mps: 0.05,
            range_sigma_m: 0.1,
            coherent_interval_s: 0.04,
            ghost_share: 0.012,
            clutter: 0.5,
        }
    }
}

/// A drive to simulate.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveOptions {
    /// Roads and traffic.
    pub scenario: Scenario,
    /// Everything random comes from it.
    pub seed: u64,
    /// Length, s.
    pub duration_s: f64,
    /// The radars by number, where they truly sit and look.
    pub sensors: Vec<(u8, Mounting)>,
    /// By how much a radar's true yaw exceeds the one the log states, by its number; zero for
    /// radars not named.
    pub misalignment_rad: Vec<(u8, f64)>,
    /// Share of moving detections over the scans taken at more than 1 m/s, by leaving out whole
    /// movers or detections of standing things; what the scenario's traffic gives if absent.
    pub moving_share: Option<f64>,
    /// How well radars measure.
    pub noise: RadarNoise,
    /// Measured over true yaw rate; drawn from 0.98 to 1.02 if absent.
    pub yaw_rate_scale: Option<f64>,
    /// Yaw rate measured at standstill, rad/s; drawn from -0.2 to 0.2 deg/s if absent.
    pub yaw_rate_bias_radps: Option<f64>,
    /// Standard deviation of a sample's white noise, rad/s; drawn from 0.07 to 0.13 deg/s if
    /// absent.
    pub yaw_rate_sigma_radps: Option<f64>,
    /// Measured over true speed.
    pub speed_scale: f64,
    /// Standard deviation of a sample of speed, m/s. At standstill the speed reads zero.
    pub speed_sigma_mps: f64,
    /// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2).
    pub slip_gradient: f64,
}

impl Default for DriveOptions {
    /// A minute of city with the radars of `RadarScenes`.
    fn default() -> Self {
        Self {
            scenario: Scenario::City,
            seed: 0,
            duration_s: 60.0,
            sensors: RADARSCENES_SENSORS.to_vec(),
            misalignment_rad: Vec::new(),
            moving_share: None,
            noise: RadarNoise::default(),
            yaw_rate_scale: None,
            yaw_rate_bias_radps: None,
            yaw_rate_sigma_radps: None,
            speed_scale: 1.0,
            speed_sigma_mps: 0.03,
            slip_gradient: 0.0,
        }
    }
}

impl DriveOptions {
    /// Checks every number.
    ///
    /// # Errors
    /// [`CoreError::Empty`] without radars, [`CoreError::OutOfRange`] for a number out of range,
    /// a radar named twice, or a misaligned radar that is not there.
    pub fn check(&self) -> Result<(), CoreError> {
        check_range("duration_s", self.duration_s, 1.0, MAX_DURATION_S)?;
        if self.sensors.is_empty() {
            return Err(CoreError::Empty {
                what: "sensors".into(),
                expected: "at least one radar".into(),
            });
        }
        let sensor_seconds = self.sensors.len() as f64 * self.duration_s;
        check_range("sensors times duration_s", sensor_seconds, 0.0, MAX_SENSOR_SECONDS)?;
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
        check_range("moving_share", self.moving_share.unwrap_or(0.0), 0.0, MAX_MOVING_SHARE)?;
        let noise = &self.noise;
        check_range("azimuth_sigma_rad", noise.azimuth_sigma_rad, 0.0, 0.2)?;
        check_range("azimuth_growth", noise.azimuth_growth, 0.0, 20.0)?;
        check_range("range_rate_sigma_mps", noise.range_rate_sigma_mps, 0.0, 5.0)?;
        check_range("range_sigma_m", noise.range_sigma_m, 0.0, 5.0)?;
        check_range("coherent_interval_s", noise.coherent_interval_s, 0.0, 0.07)?;
        check_range("ghost_share", noise.ghost_share, 0.0, 0.5)?;
        check_range("clutter", noise.clutter, 0.0, 50.0)?;
        check_range("yaw_rate_scale", self.yaw_rate_scale.unwrap_or(1.0), 0.5, 2.0)?;
        check_range("yaw_rate_bias_radps", self.yaw_rate_bias_radps.unwrap_or(0.0), -1.0, 1.0)?;
        check_range("yaw_rate_sigma_radps", self.yaw_rate_sigma_radps.unwrap_or(0.0), 0.0, 1.0)?;
        check_range("speed_scale", self.speed_scale, 0.5, 2.0)?;
        check_range("speed_sigma_mps", self.speed_sigma_mps, 0.0, 5.0)?;
        check_range("slip_gradient", self.slip_gradient, -0.02, 0.02)
    }

    /// The misalignment of a radar, rad.
    pub(crate) fn misalignment(&self, id: u8) -> f64 {
        self.misalignment_rad.iter().find(|(known, _)| *known == id).map_or(0.0, |(_, a)| *a)
    }
}

fn wrong_sensor(what: &str, expected: &str, id: u8) -> CoreError {
    CoreError::OutOfRange { what: what.into(), expected: expected.into(), given: f64::from(id) }
}
