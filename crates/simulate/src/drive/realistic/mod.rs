//! The profile "radarscenes": what real radars and cars do to a drive. [`model`] holds its numbers.

mod azimuth_bias;
pub(crate) mod car;
pub(crate) mod clock;
mod gain;
mod ghosts;
pub(crate) mod model;
pub(crate) mod moving;
mod patches;
pub(crate) mod world;

#[cfg(test)]
mod tests;

pub use car::CarErrors;
pub(crate) use model::{FIELD_OF_VIEW_RAD, MAX_DETECTIONS, MOVER_FACTOR};

use super::motion::motion_at;
use super::radar::{Labelled, Radar, STATIC_CLASS};
use super::scenario::sign;
use super::traffic::Traffic;
use super::view::{Echo, View, received};
use super::world::World;
use azimuth_bias::AzimuthBias;
use boresight_core::Random;
use boresight_core::drive::Detection;
use ghosts::Ghosts;
use patches::Patches;

/// Cosine of the elevation of something at a height and a range, where the radar sees that high.
pub(crate) fn elevation_cos(height_m: f64, range_m: f64) -> Option<f64> {
    let sine = (height_m - model::RADAR_HEIGHT_M) / range_m;
    (sine.abs() <= libm::sin(model::ELEVATION_RAD)).then(|| (1.0 - sine * sine).sqrt())
}

/// What one radar adds to a drive.
#[derive(Debug)]
pub(crate) struct Realism {
    bias: AzimuthBias,
    patches: Patches,
    ghosts: Ghosts,
    /// Mean detections a scan.
    count: f64,
    soft_share: f64,
    gain_db: f64,
}

/// How a scene differs from the mean of scenes.
pub(crate) struct SceneFactors {
    /// Detections.
    count: f64,
    /// Share of ghosts.
    ghosts: f64,
}

impl SceneFactors {
    pub(crate) fn new(random: &mut Random) -> Self {
        let [from, to] = model::GHOST_FACTOR;
        Self {
            count: (1.0 + model::COUNT_SPREAD * random.normal()).clamp(0.5, 1.5),
            ghosts: random.uniform(from, to),
        }
    }
}

impl Realism {
    /// That of a radar that looks `yaw_rad` to the left: its bias from the car, the rest from the
    /// drive.
    pub(crate) fn new(
        yaw_rad: f64,
        scene: &SceneFactors,
        car: &mut Random,
        drive: &mut Random,
    ) -> Self {
        let own = (1.0 + model::COUNT_SPREAD_OF_RADAR * drive.normal()).max(0.5);
        let count = own * scene.count * model::by_direction(&model::MEAN_COUNT, yaw_rad);
        let share = scene.ghosts * model::by_direction(&model::GHOST_SHARE, yaw_rad);
        Self {
            count,
            bias: AzimuthBias::new(car),
            patches: Patches::new(yaw_rad, drive),
            ghosts: Ghosts::new(share * count),
            soft_share: model::by_direction(&model::SOFT_SHARE, yaw_rad),
            gain_db: 0.0,
        }
    }

    /// Root mean square of the azimuth bias within 55 deg, rad.
    pub(crate) fn bias_rms_rad(&self) -> f64 {
        self.bias.rms_rad()
    }

    /// Detects an echo or not, and measures it.
    pub(crate) fn detect(
        &self,
        radar: &mut Radar,
        echo: &Echo,
        view: &View,
        time_s: f64,
    ) -> Option<Labelled> {
        let received = received(echo, view, self.gain_db, &mut radar.random)?;
        let instant =
            time_s - radar.delay_s + model::COHERENT_INTERVAL_S * (radar.random.unit() - 0.5);
        let motion = motion_at(radar.motion, instant);
        let mut range_rate = radar.range_rate(echo, view, &motion);
        let moving = echo.class != STATIC_CLASS;
        if !moving && radar.random.unit() < self.soft_share {
            let [from, to] = model::SOFT_MPS;
            range_rate += sign(&mut radar.random) * radar.random.uniform(from, to);
        }
        let mut azimuth_rad = echo.azimuth_rad;
        if !moving {
            let [x, y] = view.place(echo.range_m, echo.azimuth_rad);
            azimuth_rad += self.patches.offset(x, y);
        }
        let detection = self.measure(
            radar,
            view,
            [echo.range_m, azimuth_rad, range_rate, received.observed_dbsm],
            motion.speed_mps,
        )?;
        Some(Labelled {
            detection,
            class: echo.class,
            moving,
            track: echo.track,
            strength_db: received.strength_db,
        })
    }

    /// Adds bias and noise to range, azimuth, range rate and cross-section.
    fn measure(
        &self,
        radar: &mut Radar,
        view: &View,
        [range_m, azimuth_rad, range_rate_mps, rcs_dbsm]: [f64; 4],
        speed_mps: f64,
    ) -> Option<Detection> {
        let random = &mut radar.random;
        let edge = azimuth_rad / model::AZIMUTH_GROWTH_AT_RAD;
        let sigma = model::AZIMUTH_SIGMA_RAD * (1.0 + model::AZIMUTH_GROWTH * edge * edge);
        let azimuth = azimuth_rad + self.bias.at(azimuth_rad) + sigma * random.normal();
        let sigma =
            model::RANGE_RATE_SIGMA_MPS + model::RANGE_RATE_SIGMA_PER_SPEED * speed_mps.abs();
        let range_rate = range_rate_mps + sigma * random.normal();
        let range = range_m + model::RANGE_SIGMA_M * random.normal();
        view.holds(range, azimuth).then(|| Detection {
            azimuth_rad: view.within(azimuth),
            range_rate_mps: range_rate as f32,
            range_m: range as f32,
            rcs_dbsm: rcs_dbsm as f32,
        })
    }

    /// Adds the detections of ghosts.
    pub(crate) fn ghosts(
        &mut self,
        radar: &mut Radar,
        view: &View,
        traffic: &Traffic,
        time_s: f64,
        detections: &mut Vec<Labelled>,
    ) {
        let motion = motion_at(radar.motion, time_s - radar.delay_s);
        let mut random = radar.random.clone();
        let echoes = self.ghosts.advance(radar, view, &motion, traffic, time_s, &mut random);
        radar.random = random;
        for echo in echoes {
            let rcs = -6.0 + model::GHOST_GAIN_DB + 5.0 * radar.random.normal();
            let given = [echo.range_m, echo.azimuth_rad, echo.range_rate_mps, rcs];
            if let Some(detection) = self.measure(radar, view, given, motion.speed_mps) {
                detections.push(Labelled {
                    detection,
                    class: STATIC_CLASS,
                    moving: false,
                    track: 0,
                    strength_db: 10.0,
                });
            }
        }
    }
}

/// Sets the gain of a radar by what it will see of the world each second, so that it gives as many
/// detections as its kind does, more or less by scene.
pub(crate) fn set_gain(radar: &mut Radar, world: &World, duration_s: f64, moving_share: f64) {
    let mut strengths_db = vec![];
    // At most ten minutes' worth of seconds, evenly over the drive.
    let scans = (duration_s.ceil().max(1.0) as usize).min(600);
    for i in 0..scans {
        let time_s = duration_s * (i as f64 + 0.5) / scans as f64;
        strengths_db.extend(radar.mean_strengths_db(time_s, world));
    }
    if let Some(realism) = &mut radar.realism {
        let moving = moving::share_of(moving_share, radar.mounting.yaw_rad);
        let standing = realism.count * (1.0 - moving) - realism.ghosts.wanted();
        realism.gain_db = gain::gain_db(&strengths_db, scans, standing);
    }
}
