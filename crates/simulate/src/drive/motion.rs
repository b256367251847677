//! How the car moves along its route.

use super::realistic::car::CarErrors;
use super::scenario::{Route, Scenario};
use boresight_core::Random;
use boresight_core::drive::{Mounting, Pose};

/// Interval between samples of the car's motion, s.
pub const MOTION_STEP_S: f64 = 0.01;

/// The car's true motion at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueMotion {
    /// Time, s.
    pub time_s: f64,
    /// Rear axle and heading on the ground.
    pub pose: Pose,
    /// Forward speed of the rear axle, m/s, negative in reverse.
    pub speed_mps: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: f64,
    /// Rate of change of the forward speed, m/s^2.
    pub acceleration_mps2: f64,
    /// Slip angle of the rear axle: the car's velocity to the left is `speed sin slip`.
    pub slip_rad: f64,
    /// Distance travelled, m, growing in reverse too.
    pub travelled_m: f64,
}

impl TrueMotion {
    /// Velocity of a radar in its own frame: forward along boresight and to its left, m/s.
    pub fn radar_velocity(&self, mounting: &Mounting) -> [f64; 2] {
        let forward = self.speed_mps - self.yaw_rate_radps * mounting.y_m;
        let left = self.speed_mps * libm::sin(self.slip_rad) + self.yaw_rate_radps * mounting.x_m;
        let (sin, cos) = libm::sincos(mounting.yaw_rad);
        [forward * cos + left * sin, left * cos - forward * sin]
    }
}

/// Drives the route: a driver who looks at the allowed speed, with lagging, bounded acceleration.
pub(crate) fn drive(
    route: &Route,
    scenario: Scenario,
    duration_s: f64,
    slips: &CarErrors,
    random: &mut Random,
) -> Vec<TrueMotion> {
    let count = (duration_s / MOTION_STEP_S).floor() as usize + 1;
    let strongest = match scenario {
        Scenario::CarPark => 1.2,
        Scenario::Motorway => 1.4,
        _ => 2.6,
    };
    let mut stops = route.stops.iter().copied().peekable();
    let mut samples = Vec::with_capacity(count);
    let (mut travelled, mut speed, mut acceleration) = (0.0, 0.0_f64, 0.0_f64);
    // Faster roads are entered at speed.
    if matches!(scenario, Scenario::Motorway | Scenario::CountryRoad) {
        speed = 0.8 * route.speed(0.0);
    }
    let mut pose = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: random.phase() };
    let (mut waiting_s, mut passed_m, mut mood) = (0.0, -1.0, 0.0);
    for i in 0..count {
        // The driver's pace wanders by a few percent over some seconds.
        mood += -mood * MOTION_STEP_S / 6.0 + 0.0012 * random.normal();
        let direction = route.direction(travelled);
        let signed = direction * speed;
        let yaw_rate = route.curvature(travelled) * signed;
        let slip = slips.crab_rad - slips.slip_gradient_rad * signed * yaw_rate;
        samples.push(TrueMotion {
            time_s: i as f64 * MOTION_STEP_S,
            pose,
            speed_mps: signed,
            yaw_rate_radps: yaw_rate,
            acceleration_mps2: direction * acceleration,
            slip_rad: slip,
            travelled_m: travelled,
        });

        let before = speed;
        if waiting_s > 0.0 {
            waiting_s -= MOTION_STEP_S;
            acceleration = 0.0;
        } else {
            let next_stop = stops.peek().copied();
            let ahead = travelled.max(passed_m + 0.75);
            let allowed = route.speed(ahead).min(route.speed(ahead + 0.5 * speed))
                * (1.0 + mood.clamp(-0.1, 0.03));
            let wanted = match next_stop {
                Some((at, _)) if at - travelled < 1.2 + 0.3 * speed => {
                    -speed * speed / (2.0 * (at - travelled - 0.1).max(0.15)) - 0.4
                }
                _ => 1.6 * (allowed - speed),
            };
            let wanted = wanted.clamp(-3.0, strongest * (1.0 - 0.6 * (speed / 40.0)));
            acceleration += (wanted - acceleration) * MOTION_STEP_S / 0.22;
            speed += acceleration * MOTION_STEP_S;
            if let Some((at, wait_s)) = next_stop
                && at - travelled < 2.0
                && speed < 0.03
            {
                stops.next();
                (speed, acceleration) = (0.0, 0.0);
                waiting_s = wait_s;
                passed_m = at;
            }
            speed = speed.max(0.0);
        }
        // Trapezoid: exact for constant acceleration.
        let step = (before + speed) * 0.5 * MOTION_STEP_S;
        let middle = travelled + 0.5 * step;
        let turned = route.curvature(middle) * step * direction;
        let (sin, cos) = libm::sincos(pose.yaw_rad + 0.5 * turned + slip);
        pose.x_m += direction * step * cos;
        pose.y_m += direction * step * sin;
        pose.yaw_rad += turned;
        travelled += step;
        // Beyond the stop the route may lead the other way.
        if waiting_s > 0.0 {
            travelled = travelled.max(passed_m + 0.5);
        }
    }
    samples
}

/// Motion at a time, linear between samples; the first or last beyond them.
pub(crate) fn motion_at(samples: &[TrueMotion], time_s: f64) -> TrueMotion {
    let place = (time_s / MOTION_STEP_S).max(0.0);
    let i = (place as usize).min(samples.len() - 1);
    let next = &samples[(i + 1).min(samples.len() - 1)];
    let (a, share) = (&samples[i], (place - i as f64).clamp(0.0, 1.0));
    let mix = |p: f64, q: f64| p + (q - p) * share;
    TrueMotion {
        time_s,
        pose: Pose {
            x_m: mix(a.pose.x_m, next.pose.x_m),
            y_m: mix(a.pose.y_m, next.pose.y_m),
            yaw_rad: mix(a.pose.yaw_rad, next.pose.yaw_rad),
        },
        speed_mps: mix(a.speed_mps, next.speed_mps),
        yaw_rate_radps: mix(a.yaw_rate_radps, next.yaw_rate_radps),
        acceleration_mps2: mix(a.acceleration_mps2, next.acceleration_mps2),
        slip_rad: mix(a.slip_rad, next.slip_rad),
        travelled_m: mix(a.travelled_m, next.travelled_m),
    }
}

/// Distance between the points of a path, m.
const PATH_STEP_M: f64 = 0.5;

/// Where the car goes, by distance travelled: the road as others on it see it.
#[derive(Debug, Clone)]
pub(crate) struct Path {
    points: Vec<Pose>,
}

impl Path {
    pub(crate) fn new(samples: &[TrueMotion]) -> Self {
        let mut points = vec![];
        for pair in samples.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            while points.len() as f64 * PATH_STEP_M < b.travelled_m {
                let span = (b.travelled_m - a.travelled_m).max(1e-12);
                let share = (points.len() as f64 * PATH_STEP_M - a.travelled_m) / span;
                let share = share.clamp(0.0, 1.0);
                points.push(Pose {
                    x_m: a.pose.x_m + (b.pose.x_m - a.pose.x_m) * share,
                    y_m: a.pose.y_m + (b.pose.y_m - a.pose.y_m) * share,
                    yaw_rad: a.pose.yaw_rad + (b.pose.yaw_rad - a.pose.yaw_rad) * share,
                });
            }
        }
        if points.is_empty() {
            points.extend(samples.first().map(|s| s.pose));
        }
        Self { points }
    }

    pub(crate) fn length_m(&self) -> f64 {
        (self.points.len() - 1) as f64 * PATH_STEP_M
    }

    /// The point `left_m` to the left of the path after `along_m`, with the path's heading; beyond
    /// its ends the road goes straight on.
    pub(crate) fn at(&self, along_m: f64, left_m: f64) -> Pose {
        let place = along_m / PATH_STEP_M;
        let i = (place.max(0.0) as usize).min(self.points.len() - 1);
        let (a, b) = (&self.points[i], &self.points[(i + 1).min(self.points.len() - 1)]);
        let share = place - i as f64;
        let yaw = a.yaw_rad + (b.yaw_rad - a.yaw_rad) * share.clamp(0.0, 1.0);
        let (sin, cos) = libm::sincos(yaw);
        let beyond = (along_m - self.length_m()).max(0.0) + along_m.min(0.0);
        let share = share.clamp(0.0, 1.0);
        Pose {
            x_m: a.x_m + (b.x_m - a.x_m) * share + beyond * cos - left_m * sin,
            y_m: a.y_m + (b.y_m - a.y_m) * share + beyond * sin + left_m * cos,
            yaw_rad: yaw,
        }
    }

    /// Curvature around a distance, 1/m.
    pub(crate) fn curvature(&self, along_m: f64) -> f64 {
        (self.at(along_m + 2.0, 0.0).yaw_rad - self.at(along_m - 2.0, 0.0).yaw_rad) / 4.0
    }

    pub(crate) fn points(&self) -> &[Pose] {
        &self.points
    }
}
