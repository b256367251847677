//! The methods of mounting angles that are compared, and what they are compared by.

use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{CalibrationOptions, FrameInput, FrameWeights, Method, MotionMethod};
use std::sync::{Arc, LazyLock};

/// Driving times of Figure 6, s.
pub const DRIVING_TIMES_S: [f64; 8] = [2.0, 5.0, 10.0, 15.0, 25.0, 40.0, 60.0, 90.0];
/// Lengths of the segments of relative trajectory errors, m: that of the paper's example, two between, and the one that its
/// Tables II and III together imply.
pub const SEGMENTS_M: [f64; 4] = [50.0, 100.0, 200.0, 233.0];

/// A method of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// Name in records and tables.
    pub name: &'static str,
    /// How the angle is estimated.
    pub method: Method,
    /// What frames weigh in a mean.
    pub weights: FrameWeights,
    /// How the radar's motion is.
    pub motion: MotionMethod,
    /// Whether it is told the car's speed.
    pub speed: bool,
    /// Whether all radars share scale, bias and slip.
    pub joint: bool,
    /// Whether Figure 5 shows it.
    pub angles: bool,
    /// Whether Figure 6 shows it.
    pub convergence: bool,
}

impl Candidate {
    /// The options of a radar with this method.
    pub(crate) fn options(&self, radar: &CalibrationOptions) -> CalibrationOptions {
        CalibrationOptions {
            method: self.method,
            motion: Some(self.motion),
            frame_weights: self.weights,
            ..*radar
        }
    }

    /// A frame as the method may see it.
    pub(crate) fn seen<'a>(&self, frame: &FrameInput<'a>) -> FrameInput<'a> {
        FrameInput { speed_mps: frame.speed_mps.filter(|_| self.speed), ..*frame }
    }

    const fn new(name: &'static str, method: Method, motion: MotionMethod) -> Self {
        Self {
            name,
            method,
            weights: FrameWeights::Direction,
            motion,
            speed: matches!(method, Method::Kabsch) || matches!(motion, MotionMethod::Tracked),
            joint: false,
            angles: false,
            convergence: false,
        }
    }

    /// With other weights of frames.
    const fn weighted(self, weights: FrameWeights) -> Self {
        Self { weights, ..self }
    }

    /// Shown in Figure 6, and in Figure 5 too.
    const fn drawn(self, angles: bool) -> Self {
        Self { angles, convergence: true, ..self }
    }
}

/// The networks of motion that the methods named after them use: those of models/.
pub fn network() -> Arc<MotionNetwork> {
    static NETWORK: LazyLock<Arc<MotionNetwork>> = LazyLock::new(|| {
        let read = MotionNetwork::read(include_bytes!("../../../models/motion/deepego-plus.bin"));
        Arc::new(
            read.unwrap_or_else(|error| unreachable!("models/motion/deepego-plus.bin: {error}")),
        )
    });
    NETWORK.clone()
}

/// The methods compared: the mean of equation 8, those of Table II (DeepEgo's networks with the mean, and with the regression that
/// the paper proposes), the regressions on RANSAC's motion, ours, with and without the network,
/// then the formulations of Table IV on our motion, weighted by equation 13 (orthogonal distances by the variances of both coordinates).
pub const CANDIDATES: [Candidate; 16] = [
    Candidate::new("unweighted mean (equation 8)", Method::WeightedMean, MotionMethod::Ransac)
        .weighted(FrameWeights::Equal),
    Candidate::new("weighted mean (Kellner et al.)", Method::WeightedMean, MotionMethod::Ransac)
        .drawn(true),
    Candidate::new("Kabsch (Bao et al.)", Method::Kabsch, MotionMethod::Ransac).drawn(true),
    Candidate::new("weighted mean, DeepEgo", Method::WeightedMean, MotionMethod::Deepego),
    Candidate::new("weighted mean, DeepEgo+", Method::WeightedMean, MotionMethod::DeepegoPlus),
    Candidate::new("least squares, DeepEgo+", Method::LeastSquares, MotionMethod::DeepegoPlus)
        .drawn(true),
    Candidate::new(
        "least squares on RANSAC",
        Method::LeastSquares,
        MotionMethod::WeightedLeastSquares,
    )
    .drawn(false),
    Candidate::new(
        "orthogonal distance on RANSAC",
        Method::OrthogonalDistance,
        MotionMethod::OrthogonalDistance,
    ),
    Candidate {
        speed: false,
        ..Candidate::new("recursive, without speed", Method::Recursive, MotionMethod::Tracked)
            .drawn(false)
    },
    Candidate::new("recursive", Method::Recursive, MotionMethod::Tracked).drawn(true),
    Candidate {
        speed: true,
        ..Candidate::new("recursive, DeepEgo", Method::Recursive, MotionMethod::Deepego)
    },
    Candidate {
        joint: true,
        ..Candidate::new("recursive, four radars", Method::Recursive, MotionMethod::Tracked)
    },
    Candidate::new("least squares, tracked", Method::LeastSquares, MotionMethod::Tracked),
    Candidate::new("Kabsch, tracked", Method::Kabsch, MotionMethod::Tracked),
    Candidate::new("weighted mean, tracked", Method::WeightedMean, MotionMethod::Tracked)
        .weighted(FrameWeights::Motion),
    Candidate::new(
        "orthogonal distance, tracked",
        Method::OrthogonalDistance,
        MotionMethod::Tracked,
    ),
];
