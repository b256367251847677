//! Ego-motion led by the frames before: one unknown is searched for, the speed.

use crate::intake;
use boresight_core::Detection;

/// Widest change of speed a car is believed to make, m/s^2.
const MAX_ACCELERATION: f64 = 8.0;
/// Most speeds tried in a frame.
const MAX_CANDIDATES: usize = 64;
/// Range of range rates over which moving detections are taken as spread, m/s.
const MOVING_SPREAD_MPS: f64 = 20.0;
/// What a speed is worth that the car's own sensors rule out: found only where nothing else is, so that it can be told.
const DOUBT: f64 = 0.02;
/// Standard deviations that the car's own speed is granted.
const GATE: f64 = 4.0;
/// Half the width of the band about a motion in which detections count as static, in standard deviations.
const BAND: f64 = 2.0;
/// Least of how likely a detection is to be static, whatever a network says of it.
const LEAST_TRUST: f64 = 0.05;
/// Rounds of expectation and maximisation.
const ROUNDS: usize = 8;

/// Noise of detections and limits of a frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) range_rate_sigma_mps: f64,
    pub(crate) azimuth_sigma_rad: f64,
    pub(crate) inlier_threshold: f64,
    pub(crate) min_inliers: usize,
}

/// Speed of the car by its own sensors, m/s, and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpeedEvidence {
    pub(crate) mps: f64,
    pub(crate) sigma_mps: f64,
}

impl SpeedEvidence {
    /// Half the width of what it allows, m/s.
    pub(crate) fn gate_mps(&self) -> f64 {
        GATE * self.sigma_mps
    }

    /// Whether a speed is ruled out.
    pub(crate) fn rules_out(&self, speed_mps: f64) -> bool {
        (speed_mps - self.mps).abs() > self.gate_mps()
    }
}

/// What is known before a frame is looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prediction {
    pub(crate) angle_rad: f64,
    pub(crate) angle_variance: f64,
    /// Reading of the yaw rate at the time the radar measured, rad/s, and its rate of change there.
    pub(crate) reading_radps: f64,
    pub(crate) change: f64,
    /// True yaw rate, rad/s.
    pub(crate) yaw_rate_radps: f64,
    pub(crate) slip: f64,
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    /// Speed of the car one frame ago and how long that is ago.
    pub(crate) speed: Option<(f64, f64)>,
    /// Speed of the car as its own sensors have it now.
    pub(crate) measured_speed: Option<SpeedEvidence>,
}

impl Prediction {
    /// Distance of the radar ahead of the point that does not slip at a speed of the car, m.
    pub(crate) fn lever(&self, speed: f64) -> f64 {
        self.x_m - self.slip * speed * speed
    }

    /// Velocity of the radar across the car, m/s, at a speed of the car.
    pub(crate) fn lateral(&self, speed: f64) -> f64 {
        self.yaw_rate_radps * self.lever(speed)
    }
}

/// The radar's motion as a frame has it, with the numbers that go on to the angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fit {
    pub(crate) velocity: [f64; 2],
    /// Inverse of the normal matrix, times the residuals' variance where that exceeds 1 and times
    /// `missing`.
    pub(crate) covariance: [[f64; 2]; 2],
    /// Speed of the car, m/s.
    pub(crate) speed: f64,
    pub(crate) inliers: usize,
    /// Weighted squares of the residuals over their degrees of freedom.
    pub(crate) reduced_squares: f64,
    /// Logarithm of the mixture's likelihood.
    pub(crate) likelihood: f64,
}

/// Detections of a frame as the fits need them, and scratch space.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cloud {
    pub(crate) cos: Vec<f64>,
    pub(crate) sin: Vec<f64>,
    /// Closing rates (range rates with their sign turned), m/s.
    pub(crate) closing: Vec<f64>,
    /// Probability that a detection is static.
    pub(crate) weight: Vec<f64>,
    /// How likely a detection is to be static beside others, 1 where nothing is known.
    trust: Vec<f64>,
    /// Variance of a detection's residual at the last fit.
    pub(crate) variance: Vec<f64>,
    /// Position among the detections given.
    pub(crate) index: Vec<usize>,
    speeds: Vec<f64>,
    inverse_width: Vec<f64>,
    votes: Vec<f64>,
}

impl Cloud {
    /// Takes the valid detections of a frame.
    pub(crate) fn set(&mut self, detections: &[Detection]) {
        self.cos.clear();
        self.sin.clear();
        self.closing.clear();
        self.index.clear();
        for (index, detection) in detections.iter().enumerate() {
            let (azimuth, rate) =
                (f64::from(detection.azimuth_rad), f64::from(detection.range_rate_mps));
            if intake::is_valid(detection) {
                let (sin, cos) = azimuth.sin_cos();
                self.cos.push(cos);
                self.sin.push(sin);
                self.closing.push(-rate);
                self.index.push(index);
            }
        }
        self.weight.clear();
        self.weight.resize(self.closing.len(), 0.0);
        self.variance.clear();
        self.variance.resize(self.closing.len(), 1.0);
        self.trust.clear();
        self.trust.resize(self.closing.len(), 1.0);
    }

    /// Takes from elsewhere how likely the detections of the frame are to be static.
    pub(crate) fn trust(&mut self, weights: &[f32]) {
        for (trust, &index) in self.trust.iter_mut().zip(&self.index) {
            *trust = f64::from(weights[index]).max(LEAST_TRUST);
        }
    }

    /// Detections in use.
    pub(crate) fn len(&self) -> usize {
        self.closing.len()
    }

    /// Share of detections that stand still relative to the radar.
    pub(crate) fn share_at_rest(&self, limits: &Limits) -> f64 {
        let threshold = 3.0 * limits.range_rate_sigma_mps;
        let count = self.closing.iter().filter(|rate| rate.abs() < threshold).count();
        count as f64 / self.len().max(1) as f64
    }

    /// The car's speed that most detections agree on: with the yaw rate and the angle so far, each
    /// gives one; the kernel's width is each one's uncertainty.
    fn search(&mut self, prediction: &Prediction, limits: &Limits, scale: f64) -> Option<f64> {
        let (sin0, cos0) = prediction.angle_rad.sin_cos();
        let lateral = prediction.lateral(prediction.speed.map_or(0.0, |(speed, _)| speed));
        let offset = prediction.yaw_rate_radps * prediction.y_m;
        let along = limits.range_rate_sigma_mps.powi(2);
        let across = limits.azimuth_sigma_rad.powi(2) + prediction.angle_variance;
        self.speeds.clear();
        self.inverse_width.clear();
        self.votes.clear();
        for i in 0..self.len() {
            let cos = self.cos[i] * cos0 - self.sin[i] * sin0;
            let sin = self.sin[i] * cos0 + self.cos[i] * sin0;
            if cos.abs() < 0.05 {
                continue;
            }
            let speed = (self.closing[i] - lateral * sin) / cos;
            let variance = (along + (speed * sin).powi(2) * across) * scale;
            self.speeds.push(speed + offset);
            self.inverse_width.push(cos.abs() / (3.0 * variance.sqrt()));
            self.votes.push(self.trust[i]);
        }
        let stride = self.speeds.len().div_ceil(MAX_CANDIDATES).max(1);
        let mut best = (0.0, None);
        for j in (0..self.speeds.len()).step_by(stride) {
            let candidate = self.speeds[j];
            let mut score = 0.0;
            let places = self.speeds.iter().zip(&self.inverse_width);
            for ((speed, inverse_width), vote) in places.zip(&self.votes) {
                let distance = (candidate - speed) * inverse_width;
                let kernel = (1.0 - distance * distance).max(0.0);
                score += vote * kernel * kernel;
            }
            if let Some(speed) = &prediction.measured_speed {
                let distance = (candidate - speed.mps) / speed.gate_mps();
                score *= DOUBT + (1.0 - DOUBT) * (1.0 - distance * distance).max(0.0);
            } else if let Some((speed, age)) = prediction.speed {
                let width = 0.5 + MAX_ACCELERATION * age;
                let distance = (candidate - speed) / width;
                score *= (1.0 - distance * distance / 4.0).max(0.0);
            }
            if score > best.0 {
                best = (score, Some(candidate));
            }
        }
        best.1
    }

    /// The radar's motion in two dimensions by expectation and maximisation of a mixture: static
    /// detections scatter by their noise, moving ones over the range of speeds on the road. Only the
    /// start comes from the prediction, so that the angle found does not depend on the one so far; or
    /// from `start`, a velocity found without it.
    pub(crate) fn fit(
        &mut self,
        prediction: &Prediction,
        limits: &Limits,
        scale: f64,
        start: Option<[f64; 2]>,
    ) -> Option<Fit> {
        let needed = limits.min_inliers.max(3);
        if self.len() < needed {
            return None;
        }
        let (sin0, cos0) = prediction.angle_rad.sin_cos();
        // The car's own speed is one more observation of the motion along the car.
        let evidence = prediction.measured_speed.map(|speed| {
            let along = speed.mps - prediction.yaw_rate_radps * prediction.y_m;
            (along, 1.0 / (speed.sigma_mps * speed.sigma_mps))
        });
        let mut velocity = match start {
            Some(velocity) => velocity,
            None => {
                let speed = self.search(prediction, limits, scale)?;
                let along = speed - prediction.yaw_rate_radps * prediction.y_m;
                let across = prediction.lateral(speed);
                [along * cos0 + across * sin0, across * cos0 - along * sin0]
            }
        };
        let mut likelihood = 0.0;
        let mut share = 0.7;
        let trusted: f64 = self.trust.iter().sum();
        let mut covariance = [[0.0; 2]; 2];
        let (mut squares, mut sum) = (0.0, 0.0);
        for round in 0..=ROUNDS {
            let extra = if round == 0 { prediction.angle_variance } else { 0.0 };
            let mut normal = [0.0; 3];
            let mut right = [0.0; 2];
            (squares, sum, likelihood) = (0.0, 0.0, 0.0);
            for i in 0..self.len() {
                let (cos, sin) = (self.cos[i], self.sin[i]);
                let residual = self.closing[i] - velocity[0] * cos - velocity[1] * sin;
                let slope = velocity[1] * cos - velocity[0] * sin;
                let variance = (limits.range_rate_sigma_mps.powi(2)
                    + slope * slope * (limits.azimuth_sigma_rad.powi(2) + extra))
                    * scale;
                let prior = share * self.trust[i];
                let density = prior * (-0.5 * residual * residual / variance).exp()
                    / (std::f64::consts::TAU * variance).sqrt();
                let either = density + (1.0 - prior) / MOVING_SPREAD_MPS;
                let weight = density / either;
                likelihood += either.ln();
                let w = weight / variance;
                self.weight[i] = weight;
                self.variance[i] = variance;
                normal[0] += w * cos * cos;
                normal[1] += w * cos * sin;
                normal[2] += w * sin * sin;
                right[0] += w * cos * self.closing[i];
                right[1] += w * sin * self.closing[i];
                squares += w * residual * residual;
                sum += weight;
            }
            if let Some((along, w)) = evidence {
                normal[0] += w * cos0 * cos0;
                normal[1] -= w * cos0 * sin0;
                normal[2] += w * sin0 * sin0;
                right[0] += w * cos0 * along;
                right[1] -= w * sin0 * along;
            }
            let determinant = normal[0] * normal[2] - normal[1] * normal[1];
            let trace = normal[0] + normal[2];
            if determinant.is_nan() || determinant <= 1e-6 * trace * trace {
                return None;
            }
            covariance = [
                [normal[2] / determinant, -normal[1] / determinant],
                [-normal[1] / determinant, normal[0] / determinant],
            ];
            if round < ROUNDS {
                velocity = [
                    covariance[0][0] * right[0] + covariance[0][1] * right[1],
                    covariance[1][0] * right[0] + covariance[1][1] * right[1],
                ];
            }
            share = (sum / trusted).clamp(0.1, 0.95);
        }
        let (mut complete, mut missing) = (0.0, 0.0);
        for i in 0..self.len() {
            let residual = self.closing[i] - velocity[0] * self.cos[i] - velocity[1] * self.sin[i];
            let slope = velocity[1] * self.cos[i] - velocity[0] * self.sin[i];
            let weight = self.weight[i] / self.variance[i] * slope * slope;
            complete += weight;
            missing += weight * (1.0 - self.weight[i]) * residual * residual / self.variance[i];
        }
        let missing = 1.0 / (1.0 - missing / complete.max(f64::MIN_POSITIVE)).max(0.2);
        let inliers = self.weight.iter().filter(|&&w| w >= limits.inlier_threshold).count();
        let deviations: f64 = self.variance.iter().map(|variance| variance.sqrt()).sum();
        if inliers < needed || (inliers as f64) < by_chance(deviations) {
            return None;
        }
        let speed =
            velocity[0] * cos0 - velocity[1] * sin0 + prediction.yaw_rate_radps * prediction.y_m;
        if prediction.measured_speed.is_none()
            && start.is_none()
            && let Some((before, age)) = prediction.speed
            && (speed - before).abs() > 2.0 * (0.5 + MAX_ACCELERATION * age)
        {
            return None;
        }
        let reduced_squares = squares / (sum - 2.0).max(1.0);
        let inflation = reduced_squares.max(1.0) * missing;
        for entry in covariance.iter_mut().flatten() {
            *entry *= inflation;
        }
        Some(Fit { velocity, covariance, speed, inliers, reduced_squares, likelihood })
    }
}

/// More detections than this agree on no motion by chance: what moves falls into a motion's band at a rate
/// of the band's width over the spread of moving range rates, and the band searched for is the fullest of
/// as many as there are detections (Poisson counts, about once in a thousand frames).
fn by_chance(deviations: f64) -> f64 {
    let expected = 2.0 * BAND * deviations / MOVING_SPREAD_MPS;
    expected + 4.0 * expected.sqrt() + 3.0
}
