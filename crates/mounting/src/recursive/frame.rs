//! One frame: from its detections to the radar's motion, and to an equation in the shared unknowns.

use super::equation::Equation;
use super::tracked::{Fit, Prediction};
use super::{CarSpeed, Reading, Recursive};
use crate::frame::{FrameInput, FrameOutcome, Motion, Verdict};
use boresight_core::Detection;

/// Readings further apart than this do not say how fast the yaw rate changes, s, nor do changes of a car
/// exceed this, rad/s^2.
const CHANGE_GAP_S: f64 = 0.25;
const MAX_CHANGE: f64 = 1.0;
/// Share of a new frame in the scale of the detections' noise, which is learnt on the way.
const LEARNING_RATE: f64 = 0.01;
/// A frame whose angle lies further off all before is of something else, rad (20 deg).
const GATE_RAD: f64 = 0.35;
/// Frames used before which the motion is looked for without the prediction, too.
const START_FRAMES: u64 = 40;
/// A speed older than this is forgotten, s.
const SPEED_LIFE_S: f64 = 2.0;

impl Recursive {
    /// What a frame tells, and what becomes of it.
    pub(super) fn take(&mut self, frame: &FrameInput, outcome: &mut FrameOutcome) -> Verdict {
        self.cloud.set(frame.detections);
        if let Some(network) = &self.network {
            self.cloud.trust(&network.single().motion(frame.detections).weights);
        }
        let at_rest = self.cloud.share_at_rest(&self.limits);
        self.state.doubts.look(frame, at_rest);
        let Some(measured) = frame.yaw_rate_radps.filter(|rate| rate.is_finite()) else {
            return Verdict::WithoutMotion;
        };
        if measured.abs() > self.options.max_yaw_rate_radps {
            return Verdict::Turning;
        }
        let change = self.change(frame.time_s, measured);
        let evidence = frame
            .speed_mps
            .filter(|speed| speed.is_finite())
            .map(|speed| self.state.speed_scale.evidence(frame.time_s, speed));
        let age = self.state.speed.map(|speed| frame.time_s - speed.time_s);
        if age.is_some_and(|age| age > SPEED_LIFE_S) {
            self.state.speed = None;
        }
        if self.stands(measured, at_rest, evidence.as_ref()) {
            self.state.speed = Some(CarSpeed { mps: 0.0, time_s: frame.time_s });
            self.learn_bias(measured);
            outcome.motion = Some(self.at_rest(frame.detections.len(), at_rest));
            return Verdict::Standing;
        }
        if self.state.vote.is_some() {
            return self.begin(frame, measured, evidence.as_ref(), outcome);
        }
        let x = self.state.now.mean();
        let reading = measured - x[4] * change;
        let prediction = Prediction {
            angle_rad: x[0],
            angle_variance: self.state.now.covariance()[0][0],
            reading_radps: reading,
            change,
            yaw_rate_radps: x[1] * reading - x[2],
            slip: x[3],
            x_m: self.options.x_m,
            y_m: self.options.y_m,
            speed: self.state.speed.map(|speed| (speed.mps, frame.time_s - speed.time_s)),
            measured_speed: evidence,
        };
        let Some(fit) = self.fit(&prediction, frame.detections) else {
            self.miss();
            return Verdict::Sparse;
        };
        for (&index, &weight) in self.cloud.index.iter().zip(&self.cloud.weight) {
            outcome.weights[index] = weight as f32;
        }
        let motion = Motion {
            velocity_mps: fit.velocity,
            covariance: fit.covariance,
            inliers: fit.inliers,
            detections: frame.detections.len(),
        };
        if let Some(evidence) = evidence {
            if evidence.rules_out(fit.speed) {
                self.miss();
                outcome.weights.fill(0.0);
                return Verdict::OffSpeed;
            }
            self.state.speed_scale.add(fit.speed, &evidence);
        }
        outcome.motion = Some(motion);
        self.state.speed = Some(CarSpeed { mps: fit.speed, time_s: frame.time_s });
        let polar = motion.polar();
        if polar.speed_mps < self.options.min_speed_mps {
            return Verdict::Slow;
        }
        let step = LEARNING_RATE * (fit.reduced_squares.clamp(0.2, 5.0) - 1.0);
        self.state.noise_scale = (self.state.noise_scale * step.exp()).clamp(1e-4, 1e4);
        let reference = *self.state.now.reference();
        let Some(equation) = Equation::new(&polar, fit.speed, &prediction, &x, &reference) else {
            return Verdict::Turning;
        };
        if equation.innovation.abs() > GATE_RAD {
            self.miss();
            outcome.weights.fill(0.0);
            return Verdict::Sparse;
        }
        self.inform(frame.time_s, fit.speed, &equation, outcome);
        self.state.inliers += fit.inliers as f64;
        self.state.detections += frame.detections.len() as f64;
        Verdict::Used
    }

    /// The frame's motion. While the angle is new and nothing tells the car's speed, a queue of cars may fit
    /// the prediction better than the standing world does, so that RANSAC's motion is tried as well and
    /// the more likely one taken.
    fn fit(&mut self, prediction: &Prediction, detections: &[Detection]) -> Option<Fit> {
        let noise_scale = self.state.noise_scale;
        let predicted = self.cloud.fit(prediction, &self.limits, noise_scale, None);
        if self.state.counts.used >= START_FRAMES || prediction.measured_speed.is_some() {
            return predicted;
        }
        let start = self.motion_alone(detections).map(|motion| motion.velocity_mps);
        let found = start.and_then(|velocity| {
            self.cloud.fit(prediction, &self.limits, noise_scale, Some(velocity))
        });
        match (&predicted, &found) {
            (Some(a), Some(b)) if b.likelihood > a.likelihood => found,
            (None, _) => found,
            _ => self.cloud.fit(prediction, &self.limits, noise_scale, None),
        }
    }

    /// RANSAC's motion, by draws that depend on the number of frames so far alone, so that a restored calibration goes on as if it
    /// had not stopped.
    pub(super) fn motion_alone(&mut self, detections: &[Detection]) -> Option<Motion> {
        self.alone.draw_for(self.state.counts.given);
        self.alone.motion(detections, &mut self.alone_weights)
    }

    /// How fast the yaw rate changes, rad/s^2, from this reading and the one before.
    fn change(&mut self, time_s: f64, measured: f64) -> f64 {
        let before = self.state.reading.replace(Reading { time_s, value: measured });
        let apart = before.map(|before| (time_s - before.time_s, measured - before.value));
        match apart {
            Some((gap, change)) if gap > 0.0 && gap <= CHANGE_GAP_S => {
                (change / gap).clamp(-MAX_CHANGE, MAX_CHANGE)
            }
            _ => 0.0,
        }
    }
}
