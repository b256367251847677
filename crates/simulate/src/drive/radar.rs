//! What a radar makes of the things around it.

use super::motion::{TrueMotion, motion_at};
use super::options::{DriveOptions, RadarNoise};
use super::realistic::{self, Realism};
use super::traffic::{Mover, Traffic};
use super::view::{BINS, Echo, FIELD_OF_VIEW_RAD, RANGE_M, View, received, strength_db, within};
use super::world::World;
use boresight_core::Random;
pub use boresight_core::drive::STATIC_LABEL as STATIC_CLASS;
use boresight_core::drive::{Detection, Mounting};

/// Most detections a scan; the weakest beyond are left out, as a radar with a full list does.
pub const MAX_DETECTIONS: usize = 200;

/// Shortest and longest cycle, s.
pub const CYCLE_S: [f64; 2] = [0.073, 0.075];

/// Slower road users count as standing, m/s.
pub(crate) const MOVING_MPS: f64 = 0.1;

/// Loss by the antenna's pattern at 60 deg, dB; it grows with the square of azimuth.
const EDGE_LOSS_DB: f64 = 8.0;

/// A detection and where it comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Labelled {
    pub(crate) detection: Detection,
    pub(crate) class: u8,
    pub(crate) moving: bool,
    pub(crate) track: u32,
    pub(crate) strength_db: f64,
}

/// Times of a radar's scans in a clean drive: its own phase, cycles that jitter around its own mean.
pub(crate) fn scan_times(duration_s: f64, random: &mut Random) -> Vec<f64> {
    let mean = random.uniform(0.0736, 0.0744);
    let mut time = 0.08 + random.uniform(0.0, mean);
    let mut times = vec![];
    while time <= duration_s {
        times.push(time);
        time += (mean + 0.0002 * random.normal()).clamp(CYCLE_S[0], CYCLE_S[1]);
    }
    times
}

/// A radar on the car.
pub(crate) struct Radar<'a> {
    pub(crate) mounting: Mounting,
    pub(crate) options: &'a DriveOptions,
    pub(crate) motion: &'a [TrueMotion],
    pub(crate) random: Random,
    /// By how much range rates lag their time stamp, s.
    pub(crate) delay_s: f64,
    /// What the profile "radarscenes" adds.
    pub(crate) realism: Option<Realism>,
}

impl Radar<'_> {
    /// The scan with the given time stamp. Everything stands where it was the delay before.
    pub(crate) fn scan(&mut self, time_s: f64, world: &World, traffic: &Traffic) -> Vec<Labelled> {
        let mut view = self.view(time_s - self.delay_s);
        let mut echoes = vec![];
        self.echoes_of_world(world, &mut view, &mut echoes);
        for mover in &traffic.movers {
            if !mover.vulnerable() {
                view.shade(&mover.corners(), 14.0);
            }
            self.echoes_of(mover, &view, &mut echoes);
        }
        let mut detections = vec![];
        let limit = if let Some(mut realism) = self.realism.take() {
            for echo in &echoes {
                detections.extend(realism.detect(self, echo, &view, time_s));
            }
            realism.ghosts(self, &view, traffic, time_s, &mut detections);
            self.realism = Some(realism);
            realistic::MAX_DETECTIONS
        } else {
            detections.extend(echoes.iter().filter_map(|echo| self.detect(echo, &view, time_s)));
            self.clutter(time_s, &mut detections);
            MAX_DETECTIONS
        };
        if detections.len() > limit {
            boresight_math::order::sort_descending(&mut detections, |one| one.strength_db);
            detections.truncate(limit);
        }
        detections
    }

    /// Echoes of what stands, each from a random point of its extent; it throws shadows.
    fn echoes_of_world(&mut self, world: &World, view: &mut View, echoes: &mut Vec<Echo>) {
        for r in world.near(view.x_m, view.y_m, RANGE_M[1]) {
            let ends = [-1.0, 1.0].map(|e| [r.x_m + e * r.half_m[0], r.y_m + e * r.half_m[1]]);
            if r.shadow_db > 0.0 {
                view.shade(&ends, r.shadow_db);
            }
            let along = self.random.uniform(-1.0, 1.0);
            let (x, y) = (r.x_m + along * r.half_m[0], r.y_m + along * r.half_m[1]);
            let (range_m, azimuth_rad) = view.polar(x, y);
            if !view.holds(range_m, azimuth_rad) {
                continue;
            }
            let elevation_cos = if self.realism.is_some() {
                let Some(cos) = realistic::elevation_cos(r.height_m, range_m) else { continue };
                cos
            } else {
                1.0
            };
            let mut rcs_dbsm = r.rcs_dbsm;
            if r.flat {
                // Loss away from the normal, for walls that are rough in parts.
                let half = (r.half_m[0] * r.half_m[0] + r.half_m[1] * r.half_m[1]).sqrt();
                let (dx, dy) = ((x - view.x_m) / range_m, (y - view.y_m) / range_m);
                let off = ((dx * r.half_m[0] + dy * r.half_m[1]) / half.max(1e-6)).abs();
                rcs_dbsm += 6.0 - 14.0 * off;
            }
            echoes.push(Echo {
                range_m,
                azimuth_rad,
                rcs_dbsm,
                velocity_mps: [0.0; 2],
                class: STATIC_CLASS,
                track: 0,
                depth_m: 2.5,
                elevation_cos,
            });
        }
    }

    /// Mean strengths, dB over the threshold, of the echoes of what stands at a time.
    pub(crate) fn mean_strengths_db(&mut self, time_s: f64, world: &World) -> Vec<f64> {
        let mut view = self.view(time_s);
        let mut echoes = vec![];
        self.echoes_of_world(world, &mut view, &mut echoes);
        echoes.iter().map(|echo| strength_db(echo, &view, echo.rcs_dbsm)).collect()
    }

    pub(crate) fn view(&self, time_s: f64) -> View {
        let car = motion_at(self.motion, time_s).pose;
        let (sin, cos) = libm::sincos(car.yaw_rad);
        let at = &self.mounting;
        let (boresight_sin, boresight_cos) = libm::sincos(car.yaw_rad + at.yaw_rad);
        let [field_of_view_rad, edge_loss_db] = match &self.realism {
            Some(_) => [realistic::FIELD_OF_VIEW_RAD, realistic::model::EDGE_LOSS_DB],
            None => [FIELD_OF_VIEW_RAD, EDGE_LOSS_DB],
        };
        View {
            x_m: car.x_m + at.x_m * cos - at.y_m * sin,
            y_m: car.y_m + at.x_m * sin + at.y_m * cos,
            sin: boresight_sin,
            cos: boresight_cos,
            field_of_view_rad,
            edge_loss_db,
            shadows: [(f64::INFINITY, 0.0); BINS],
        }
    }

    /// Points on the sides of a road user that face the radar, more of them the nearer it is.
    fn echoes_of(&mut self, mover: &Mover, view: &View, echoes: &mut Vec<Echo>) {
        let (centre_m, azimuth) = view.polar(mover.pose.x_m, mover.pose.y_m);
        let reach = 0.5 * mover.length_m;
        if centre_m > RANGE_M[1] + reach || (azimuth.abs() > 1.6 && centre_m > 15.0) {
            return;
        }
        let random = &mut self.random;
        let vulnerable = mover.vulnerable();
        let points = if vulnerable {
            random.integer(1, 3)
        } else {
            let most = (2.0 + 70.0 / centre_m.max(4.0)) * (0.6 + 0.09 * mover.length_m);
            let more = self.realism.as_ref().map_or(1.0, |_| realistic::MOVER_FACTOR);
            (most * more * random.uniform(0.6, 1.1)) as u64
        };
        let (sin, cos) = libm::sincos(mover.pose.yaw_rad);
        let (to_x, to_y) = (view.x_m - mover.pose.x_m, view.y_m - mover.pose.y_m);
        let (seen_along, seen_left) = (to_x * cos + to_y * sin, to_y * cos - to_x * sin);
        let (half_long, half_wide) = (0.5 * mover.length_m, 0.5 * mover.width_m);
        let end_seen = seen_along.abs() > half_long;
        let flank_seen = seen_left.abs() > half_wide;
        let velocity = mover.velocity();
        let (class, track) = if mover.speed_mps > MOVING_MPS {
            (mover.class, mover.track)
        } else {
            (STATIC_CLASS, mover.track)
        };
        let mean_dbsm = match (vulnerable, mover.length_m > 6.0) {
            (true, _) => -9.0,
            (false, false) => 0.0,
            (false, true) => 4.0,
        };
        for _ in 0..points {
            let on_end = end_seen && (!flank_seen || random.unit() < 0.5);
            let (mut along, mut left) = if on_end {
                (seen_along.signum() * half_long, random.uniform(-half_wide, half_wide))
            } else {
                (random.uniform(-half_long, half_long), seen_left.signum() * half_wide)
            };
            along -= 0.15 * random.normal().abs() * along.signum();
            left -= 0.1 * random.normal().abs() * left.signum();
            let x = mover.pose.x_m + along * cos - left * sin;
            let y = mover.pose.y_m + along * sin + left * cos;
            let (range_m, azimuth_rad) = view.polar(x, y);
            // Limbs swing, and wheels turn between standstill and twice the speed.
            let factor = if vulnerable {
                1.0 + 0.35 * random.normal()
            } else if !on_end && random.unit() < 0.15 {
                random.uniform(0.0, 2.0)
            } else {
                1.0
            };
            let rcs_dbsm = mean_dbsm + 3.5 * random.normal();
            if view.holds(range_m, azimuth_rad) {
                echoes.push(Echo {
                    range_m,
                    azimuth_rad,
                    rcs_dbsm,
                    velocity_mps: [velocity[0] * factor, velocity[1] * factor],
                    class,
                    track,
                    depth_m: 1.0 + mover.length_m,
                    elevation_cos: 1.0,
                });
            }
        }
    }

    /// Detects an echo or not, and measures it with white noise.
    fn detect(&mut self, echo: &Echo, view: &View, time_s: f64) -> Option<Labelled> {
        let noise: RadarNoise = self.options.noise;
        let received = received(echo, view, 0.0, &mut self.random)?;
        let instant = time_s - noise.coherent_interval_s * self.random.unit();
        let edge = echo.azimuth_rad / FIELD_OF_VIEW_RAD;
        let sigma = noise.azimuth_sigma_rad * (1.0 + noise.azimuth_growth * edge * edge);
        let azimuth = echo.azimuth_rad + sigma * self.random.normal();
        let range_m = echo.range_m + noise.range_sigma_m * self.random.normal();
        if !view.holds(range_m, azimuth) {
            return None;
        }
        let motion = motion_at(self.motion, instant);
        let mut range_rate = self.range_rate(echo, view, &motion)
            + noise.range_rate_sigma_mps * self.random.normal();
        let moving = echo.class != STATIC_CLASS;
        if !moving && self.random.unit() < noise.ghost_share {
            range_rate = self.random_range_rate(motion.speed_mps);
        }
        Some(Labelled {
            detection: Detection {
                azimuth_rad: view.within(azimuth),
                range_rate_mps: range_rate as f32,
                range_m: range_m as f32,
                rcs_dbsm: received.observed_dbsm as f32,
            },
            class: echo.class,
            moving,
            track: echo.track,
            strength_db: received.strength_db,
        })
    }

    /// Range rate of an echo without errors, m/s.
    pub(crate) fn range_rate(&self, echo: &Echo, view: &View, motion: &TrueMotion) -> f64 {
        let [vx, vy] = motion.radar_velocity(&self.mounting);
        let (sin, cos) = libm::sincos(echo.azimuth_rad);
        // The line of sight on the ground, for velocities there.
        let sight = [view.cos * cos - view.sin * sin, view.sin * cos + view.cos * sin];
        let own = echo.velocity_mps[0] * sight[0] + echo.velocity_mps[1] * sight[1];
        (own - (vx * cos + vy * sin)) * echo.elevation_cos
    }

    fn random_range_rate(&mut self, speed_mps: f64) -> f64 {
        let most = speed_mps.abs() + 6.0;
        self.random.uniform(-most, most)
    }

    /// False detections anywhere, labelled static as nobody has annotated them.
    fn clutter(&mut self, time_s: f64, detections: &mut Vec<Labelled>) {
        let speed = motion_at(self.motion, time_s).speed_mps;
        // Poisson by Knuth's product of uniforms.
        let limit = libm::exp(-self.options.noise.clutter);
        let mut product = self.random.unit();
        while product > limit {
            product *= self.random.unit();
            let azimuth = self.random.uniform(-FIELD_OF_VIEW_RAD, FIELD_OF_VIEW_RAD);
            let range = self.random.uniform(RANGE_M[0], RANGE_M[1]);
            let range_rate = self.random_range_rate(speed);
            let rcs = -15.0 + 5.0 * self.random.normal();
            detections.push(Labelled {
                detection: Detection {
                    azimuth_rad: within(azimuth, FIELD_OF_VIEW_RAD),
                    range_rate_mps: range_rate as f32,
                    range_m: range as f32,
                    rcs_dbsm: rcs as f32,
                },
                class: STATIC_CLASS,
                moving: false,
                track: 0,
                strength_db: 0.0,
            });
        }
    }
}
