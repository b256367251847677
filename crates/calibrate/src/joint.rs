//! Several radars of one car: an angle each, one yaw-rate sensor.

use crate::recursive::information::{Matrix, UNKNOWNS, Vector};
use crate::small::{inverse, times};
use crate::{
    AngleEstimate, CalibrateError, CalibrationOptions, FrameInput, FrameOutcome, Recursive,
};
use boresight_core::CoreError;

/// Unknowns that belong to the car: inverse scale, bias, slip gradient, and the delay of its radars, taken to
/// be of one kind.
const SHARED: usize = UNKNOWNS - 1;

type SharedVector = [f64; SHARED];
type SharedMatrix = [[f64; SHARED]; SHARED];

/// Recursive estimates of several radars that share the scale and bias of the yaw rate, the slip of the
/// rear axle and the radars' delay, in constant memory.
///
/// Each radar keeps its own normal equations. Its angle is eliminated from them, the radars' equations
/// in the shared unknowns are added up, and each angle follows. Radars count as independent but for
/// these unknowns; what standstill tells of the bias is taken once, from the radar that knows most.
#[derive(Debug, Clone)]
pub struct Joint {
    radars: Vec<(u8, Recursive)>,
}

/// One radar's part of the joint normal equations, about its own estimate.
struct Part {
    x: Vector,
    /// Information on the angle, prior included.
    angle: f64,
    /// Prior's share of it.
    angle_prior: f64,
    score: Vector,
    /// Change of the angle with the shared unknowns, sign turned.
    gain: SharedVector,
    n: Matrix,
}

impl Joint {
    /// From the options of each radar by its number in the log; `method` is not looked at.
    ///
    /// # Errors
    /// Those of [`Recursive::new`]; [`CoreError::Empty`] without radars, [`CoreError::OutOfRange`] for
    /// a number given twice.
    pub fn new(radars: &[(u8, CalibrationOptions)]) -> Result<Self, CalibrateError> {
        if radars.is_empty() {
            return Err(CoreError::Empty {
                what: "radars".into(),
                expected: "at least one radar".into(),
            }
            .into());
        }
        let mut result = Vec::with_capacity(radars.len());
        for (index, (sensor, options)) in radars.iter().enumerate() {
            if radars[..index].iter().any(|(earlier, _)| earlier == sensor) {
                return Err(CoreError::OutOfRange {
                    what: "sensor".into(),
                    expected: "each radar once".into(),
                    given: f64::from(*sensor),
                }
                .into());
            }
            result.push((*sensor, Recursive::new(options)?));
        }
        Ok(Self { radars: result })
    }

    /// Takes one frame of a radar.
    ///
    /// # Errors
    /// Those of [`Recursive::add`]; [`CoreError::OutOfRange`] for a radar that was not named. The frame
    /// is then not counted.
    pub fn add(&mut self, sensor: u8, frame: FrameInput) -> Result<FrameOutcome, CalibrateError> {
        match self.radars.iter_mut().find(|(id, _)| *id == sensor) {
            Some((_, radar)) => radar.add(frame),
            None => Err(CoreError::OutOfRange {
                what: "sensor".into(),
                expected: "a radar of the calibration".into(),
                given: f64::from(sensor),
            }
            .into()),
        }
    }

    /// The angles as they stand, with one scale and one bias for all.
    pub fn estimate(&self) -> Vec<(u8, AngleEstimate)> {
        // The prior of the shared unknowns: the narrowest each, as standstill narrows the bias.
        let mut mean = [0.0; SHARED];
        let mut prior = [0.0; SHARED];
        for (_, radar) in &self.radars {
            let (means, inverse_variances) = radar.information().prior();
            for i in 0..SHARED {
                if inverse_variances[i + 1] > prior[i] {
                    prior[i] = inverse_variances[i + 1];
                    mean[i] = means[i + 1];
                }
            }
        }
        let mut parts: Vec<Part> = Vec::with_capacity(self.radars.len());
        let mut total: SharedMatrix = [[0.0; SHARED]; SHARED];
        let mut right = [0.0; SHARED];
        for i in 0..SHARED {
            total[i][i] = prior[i];
        }
        for (_, radar) in &self.radars {
            let part = Part::new(radar, &mean);
            for i in 0..SHARED {
                right[i] += part.score[i + 1] - part.gain[i] * part.score[0];
                for j in 0..SHARED {
                    total[i][j] += part.n[i + 1][j + 1] - part.gain[i] * part.n[0][j + 1];
                }
            }
            parts.push(part);
        }
        let Some(inverse) = inverse(&total) else {
            return self.radars.iter().map(|(id, radar)| (*id, radar.estimate())).collect();
        };
        let step = times(&inverse, &right);
        let shared: SharedVector = std::array::from_fn(|i| mean[i] + step[i]);
        for part in &mut parts {
            let moved: f64 = (0..SHARED).map(|i| part.gain[i] * step[i]).sum();
            part.x[0] += part.score[0] / part.angle - moved;
            part.x[1..].copy_from_slice(&shared);
        }
        let middles: Vec<Matrix> = parts
            .iter()
            .zip(&self.radars)
            .map(|(part, (_, radar))| radar.information().middle(&part.x))
            .collect();
        self.radars
            .iter()
            .enumerate()
            .map(|(index, (id, radar))| {
                let covariance = covariance(index, &parts, &middles, &inverse, &prior);
                (*id, radar.conclude(&parts[index].x, &covariance))
            })
            .collect()
    }
}

impl Part {
    /// The equations about the radar's own angle and the common prior's means.
    fn new(radar: &Recursive, mean: &SharedVector) -> Self {
        let information = radar.information();
        let mut x = information.mean();
        x[1..].copy_from_slice(mean);
        let (n, mut score) = information.score(&x);
        let (prior_mean, prior) = information.prior();
        score[0] += prior[0] * (prior_mean[0] - x[0]);
        let angle = n[0][0] + prior[0];
        let gain = std::array::from_fn(|i| n[0][i + 1] / angle);
        Self { x, angle, angle_prior: prior[0], score, gain, n }
    }
}

/// Covariance of one radar's angle and the shared unknowns: the estimate is linear in the radars'
/// scores, whose covariances are the middles.
fn covariance(
    radar: usize,
    parts: &[Part],
    middles: &[Matrix],
    inverse: &SharedMatrix,
    prior: &SharedVector,
) -> Matrix {
    let gain = parts[radar].gain;
    // Row 0 takes shared unknowns to the angle, the others to themselves.
    let outer: [SharedVector; UNKNOWNS] = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if i == 0 {
                -(0..SHARED).map(|k| gain[k] * inverse[k][j]).sum::<f64>()
            } else {
                inverse[i - 1][j]
            }
        })
    });
    let mut result = [[0.0; UNKNOWNS]; UNKNOWNS];
    for (index, (part, middle)) in parts.iter().zip(middles).enumerate() {
        let mut map: Matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| match j {
                0 => -(0..SHARED).map(|k| outer[i][k] * part.gain[k]).sum::<f64>(),
                _ => outer[i][j - 1],
            })
        });
        let mut middle = *middle;
        middle[0][0] += part.angle_prior;
        if index == radar {
            map[0][0] += 1.0 / part.angle;
        }
        let half: Matrix = std::array::from_fn(|i| times(&middle, &map[i]));
        for i in 0..UNKNOWNS {
            for j in 0..UNKNOWNS {
                result[i][j] += (0..UNKNOWNS).map(|k| map[i][k] * half[j][k]).sum::<f64>();
            }
        }
    }
    for i in 0..UNKNOWNS {
        for j in 0..UNKNOWNS {
            result[i][j] += (0..SHARED).map(|k| outer[i][k] * prior[k] * outer[j][k]).sum::<f64>();
        }
    }
    result
}
