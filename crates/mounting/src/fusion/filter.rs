//! A Kalman filter of the car's motion with errors of direction and scale for each radar.

use boresight_math::linalg::small;

/// Speed, yaw rate and their changes.
const MOTION: usize = 4;
/// Spectral densities of the changes of acceleration, (m/s^3)^2/Hz, and of yaw acceleration, (rad/s^3)^2/Hz.
const JERK: f64 = 1.0;
const YAW_JERK: f64 = 0.02;
/// Largest deviations of speed, m/s, and yaw rate, rad/s, and of their changes, of which nothing is known.
const OPEN: [f64; MOTION] = [30.0, 1.0, 2.0, 0.3];
/// A motion is not believed to be more exact than this, m/s.
const LEAST_MPS: f64 = 0.02;
/// Deviations of a radar's direction, rad, and of the scale of its speed, and how long they last, s: what neighbouring frames
/// err alike by, and what the mounting angle is off by.
const ERRORS: [f64; 2] = [0.0035, 0.003];
const LASTING_S: f64 = 3.0;

/// What a radar's motion should be, in the car's frame, and how it changes with the filter's state.
pub(super) struct Seen {
    /// Velocity, m/s.
    pub(super) velocity: [f64; 2],
    /// By speed and yaw rate, row by row.
    pub(super) by_motion: [[f64; 2]; 2],
}

/// A radar's motion in the car's frame: velocity, m/s, and its covariance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    pub(super) velocity: [f64; 2],
    pub(super) covariance: [[f64; 2]; 2],
}

/// State, covariance and time.
#[derive(Debug, Clone)]
pub(super) struct Filter {
    pub(super) time_s: f64,
    x: Vec<f64>,
    /// Row by row.
    p: Vec<f64>,
}

impl Filter {
    /// Of a car of which a motion is known to be near, and nothing else.
    pub(super) fn new(radars: usize, time_s: f64, speed_mps: f64, yaw_rate_radps: f64) -> Self {
        let size = MOTION + ERRORS.len() * radars;
        let mut x = vec![0.0; size];
        (x[0], x[1]) = (speed_mps, yaw_rate_radps);
        let mut p = vec![0.0; size * size];
        for i in 0..size {
            let deviation = OPEN.get(i).copied().unwrap_or_else(|| error(i));
            p[i * size + i] = deviation * deviation;
        }
        Self { time_s, x, p }
    }

    pub(super) fn speed_mps(&self) -> f64 {
        self.x[0]
    }

    pub(super) fn yaw_rate_radps(&self) -> f64 {
        self.x[1]
    }

    /// Of speed and yaw rate.
    pub(super) fn covariance(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|i| [0, 1].map(|j| self.p[i * self.x.len() + j]))
    }

    /// Moves on to a time that is not earlier.
    pub(super) fn advance(&mut self, time_s: f64) {
        let dt = time_s - self.time_s;
        self.time_s = time_s;
        if dt.is_nan() || dt <= 0.0 {
            return;
        }
        let size = self.x.len();
        let keeps = (-dt / LASTING_S).exp();
        for i in 0..2 {
            self.x[i] += dt * self.x[i + 2];
            for j in 0..size {
                self.p[i * size + j] += dt * self.p[(i + 2) * size + j];
            }
        }
        for i in 0..2 {
            for j in 0..size {
                self.p[j * size + i] += dt * self.p[j * size + i + 2];
            }
        }
        for i in MOTION..size {
            self.x[i] *= keeps;
            for j in 0..size {
                self.p[i * size + j] *= keeps;
                self.p[j * size + i] *= keeps;
            }
            self.p[i * size + i] += error(i).powi(2) * (1.0 - keeps * keeps);
        }
        for (i, density) in [JERK, YAW_JERK].into_iter().enumerate() {
            self.p[i * size + i] += density * dt.powi(3) / 3.0;
            self.p[i * size + i + 2] += density * dt.powi(2) / 2.0;
            self.p[(i + 2) * size + i] += density * dt.powi(2) / 2.0;
            self.p[(i + 2) * size + i + 2] += density * dt;
        }
        for i in 0..MOTION {
            self.p[i * size + i] = self.p[i * size + i].min(OPEN[i] * OPEN[i]);
        }
    }

    /// How far a motion of a radar lies from what is expected, squared and whitened, and the same as a step of the state.
    fn innovation(&self, radar: usize, seen: &Seen, told: Told) -> Option<Innovation> {
        let size = self.x.len();
        let [vx, vy] = seen.velocity;
        // A radar that points further to the left sees the car move further to the right.
        let turned = [vy, -vx];
        let own = MOTION + ERRORS.len() * radar;
        let row = |i: usize| {
            let [speed, yaw] = seen.by_motion[i];
            [(0, speed), (1, yaw), (own, turned[i]), (own + 1, seen.velocity[i])]
        };
        let cross: [Vec<f64>; 2] = [0, 1].map(|i| {
            (0..size).map(|k| row(i).iter().map(|(j, h)| self.p[k * size + j] * h).sum()).collect()
        });
        let mut spread = told.covariance;
        for (i, line) in spread.iter_mut().enumerate() {
            for (j, value) in line.iter_mut().enumerate() {
                *value += row(i).iter().map(|(k, h)| h * cross[j][*k]).sum::<f64>();
            }
            line[i] += LEAST_MPS * LEAST_MPS;
        }
        let off: [f64; 2] = std::array::from_fn(|i| {
            let errors = turned[i] * self.x[own] + seen.velocity[i] * self.x[own + 1];
            told.velocity[i] - seen.velocity[i] - errors
        });
        let inverse = small::inverse(&spread)?;
        let step = small::times(&inverse, &off);
        Some(Innovation { squared: step[0] * off[0] + step[1] * off[1], step, inverse, cross })
    }

    /// How far a motion lies from what is expected, squared and whitened; infinite where that is not a number.
    pub(super) fn distance(&self, radar: usize, seen: &Seen, told: Told) -> f64 {
        self.innovation(radar, seen, told).map_or(f64::INFINITY, |innovation| innovation.squared)
    }

    /// Takes a motion of a radar, in the car's frame.
    pub(super) fn take(&mut self, radar: usize, seen: &Seen, told: Told) {
        let Some(innovation) = self.innovation(radar, seen, told) else { return };
        let Innovation { step, inverse, cross, .. } = innovation;
        let size = self.x.len();
        for k in 0..size {
            self.x[k] += cross[0][k] * step[0] + cross[1][k] * step[1];
            let gain = small::times(&inverse, &[cross[0][k], cross[1][k]]);
            for l in 0..size {
                self.p[k * size + l] -= gain[0] * cross[0][l] + gain[1] * cross[1][l];
            }
        }
    }
}

/// Deviation of a number of the state after those of the motion.
fn error(place: usize) -> f64 {
    ERRORS[(place - MOTION) % ERRORS.len()]
}

struct Innovation {
    squared: f64,
    step: [f64; 2],
    inverse: [[f64; 2]; 2],
    /// Covariance of the state with each of the two numbers.
    cross: [Vec<f64>; 2],
}
