//! The estimate of a mounting angle, with all that is needed to judge it.

use crate::angle::wrap;
use crate::frame::Verdict;
use crate::options::CalibrationOptions;
use boresight_options::remark::Coded;
use boresight_options::{Described, remark};
use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter};

/// Standard deviations that chance is granted before an angle counts as misaligned.
pub const CHANCE: f64 = 3.0;

/// How many frames became what; every frame given is counted once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[option(name = "CalibrationCounts")]
pub struct FrameCounts {
    /// Frames given.
    pub given: u64,
    /// In the angle.
    pub used: u64,
    /// The car stood.
    pub standing: u64,
    /// Slower than the gate.
    pub slow: u64,
    /// Turning faster than the gate.
    pub turning: u64,
    /// Too few detections or inliers.
    pub sparse: u64,
    /// What agrees is not the car's own measured speed.
    pub off_speed: u64,
    /// Without a yaw rate (or speed) at their time.
    pub without_motion: u64,
}

impl std::ops::AddAssign for FrameCounts {
    fn add_assign(&mut self, other: Self) {
        self.given += other.given;
        self.used += other.used;
        self.standing += other.standing;
        self.slow += other.slow;
        self.turning += other.turning;
        self.sparse += other.sparse;
        self.off_speed += other.off_speed;
        self.without_motion += other.without_motion;
    }
}

impl FrameCounts {
    /// Counts one more frame.
    pub(crate) fn add(&mut self, verdict: Verdict) {
        self.given += 1;
        *match verdict {
            Verdict::Used => &mut self.used,
            Verdict::Standing => &mut self.standing,
            Verdict::Slow => &mut self.slow,
            Verdict::Turning => &mut self.turning,
            Verdict::Sparse => &mut self.sparse,
            Verdict::OffSpeed => &mut self.off_speed,
            Verdict::WithoutMotion => &mut self.without_motion,
        } += 1;
    }
}

/// Something to know of an estimate; not an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remark {
    /// No frame could be used: there is no angle beyond the nominal one.
    NoFrames,
    /// The drive does not determine the angle to a degree.
    AngleUndetermined,
    /// The drive does not determine the scale of the yaw rate (no turns, or `x_s` near 0).
    ScaleUndetermined,
    /// The bias of the yaw rate rests on its prior: the car neither stood nor changed its speed enough.
    BiasUndetermined,
    /// Fewer than half of the detections of the frames used were static.
    FewInliers,
    /// So few of the frames of a driving car could be used that what they agree on may be traffic.
    FewFrames,
    /// Most frames do not agree with the car's measured speed.
    OffSpeed,
    /// Most detections stand relative to the radar while the car drives: range rates without the car's motion, or a queue.
    StillWhileDriving,
    /// The angle depends on the yaw rate with the wrong sign, and is nearer to the nominal one mirrored.
    AzimuthMirrored,
    /// The angle depends on the yaw rate with the wrong sign.
    YawRateReversed,
    /// The angle depends on the yaw rate as if it were in degrees per second.
    YawRateUnit,
    /// Azimuths beyond half a turn: degrees in place of radians.
    AzimuthUnit,
    /// Detections with an azimuth or a range rate that no sensor measures were left out.
    InvalidDetections,
    /// The clock of the frames was reset, and a new session started.
    ClockReset,
    /// The last frames were all rejected, so that the estimate says nothing of the present.
    Stale,
    /// Scale, bias, slip or delay come out as no car has them.
    Implausible,
    /// The angle changed during the drive; it is the one since then.
    Changed,
    /// The angle differs from the nominal one by more than the alarm's limit, beyond chance.
    Misaligned,
    /// The angle still changes by more than its standard deviation allows.
    NotConverged,
}

impl Coded for Remark {
    fn code(&self) -> &'static str {
        match self {
            Self::NoFrames => "no-frames",
            Self::AngleUndetermined => "angle-undetermined",
            Self::ScaleUndetermined => "scale-undetermined",
            Self::BiasUndetermined => "bias-undetermined",
            Self::FewInliers => "few-inliers",
            Self::FewFrames => "few-frames",
            Self::OffSpeed => "off-speed",
            Self::StillWhileDriving => "still-while-driving",
            Self::AzimuthMirrored => "azimuth-mirrored",
            Self::YawRateReversed => "yaw-rate-reversed",
            Self::YawRateUnit => "yaw-rate-unit",
            Self::AzimuthUnit => "azimuth-unit",
            Self::InvalidDetections => "invalid-detections",
            Self::ClockReset => "clock-reset",
            Self::Stale => "stale",
            Self::Implausible => "implausible",
            Self::Changed => "changed",
            Self::Misaligned => "misaligned",
            Self::NotConverged => "not-converged",
        }
    }
}

impl Display for Remark {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoFrames => "no frame could be used",
            Self::AngleUndetermined => "the drive does not determine the angle to a degree",
            Self::ScaleUndetermined => "the drive does not determine the scale of the yaw rate",
            Self::BiasUndetermined => "the bias of the yaw rate is only assumed to be small",
            Self::FewInliers => "fewer than half of the detections were static",
            Self::FewFrames => {
                "so few frames could be used that what they agree on may be traffic"
            }
            Self::OffSpeed => "most frames do not agree with the car's measured speed",
            Self::StillWhileDriving => {
                "most detections stand relative to the radar while the car drives: their range rates may have the \
                 car's motion taken out, or they are a queue of cars"
            }
            Self::AzimuthMirrored => {
                "the angle goes with the yaw rate the wrong way and near the mirrored nominal one: azimuths may be \
                 positive to the right"
            }
            Self::YawRateReversed => {
                "the angle goes with the yaw rate the wrong way: the yaw rate or the azimuths may be positive to the \
                 right"
            }
            Self::YawRateUnit => {
                "the angle goes with the yaw rate as if it were in degrees per second"
            }
            Self::AzimuthUnit => "azimuths lie beyond half a turn: they may be degrees taken for radians",
            Self::InvalidDetections => {
                "detections with an azimuth beyond half a turn or a range rate beyond 300 m/s were left out"
            }
            Self::ClockReset => {
                "times of the frames jumped back, so that a new session was started"
            }
            Self::Stale => "the last frames were rejected, so this estimate is of the time before",
            Self::Implausible => {
                "scale, bias, slip or delay come out as no car has them, so the angle may be wrong"
            }
            Self::Changed => "the angle changed during the drive; this is the one since then",
            Self::Misaligned => {
                "the angle differs from the nominal one beyond the limit and chance"
            }
            Self::NotConverged => "the angle has not settled yet",
        })
    }
}

/// Whether a radar is where it should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alignment {
    /// The angle lies within the alarm's limit of the nominal one, and three standard deviations more still do.
    Aligned,
    /// The angle lies beyond the alarm's limit by more than three standard deviations.
    Misaligned,
    /// The drive does not tell yet.
    Undecided,
}

impl Alignment {
    /// Of an angle and its standard deviation; none without a nominal angle.
    pub fn of(angle_rad: f64, sigma_rad: f64, options: &CalibrationOptions) -> Option<Self> {
        let off = drift_rad(angle_rad, options)?.abs();
        Some(match (off - options.alarm_rad, CHANCE * sigma_rad) {
            (beyond, chance) if beyond > chance => Self::Misaligned,
            (beyond, chance) if beyond <= -chance => Self::Aligned,
            _ => Self::Undecided,
        })
    }
}

/// How far an angle is from the nominal one, within half a turn; none without a nominal angle.
fn drift_rad(angle_rad: f64, options: &CalibrationOptions) -> Option<f64> {
    options.nominal_rad.map(|nominal_rad| wrap(angle_rad - nominal_rad))
}

/// A mounting angle and what it rests on. Standard deviations are infinite where the drive says nothing.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "CalibrationResult")]
pub struct AngleEstimate {
    /// Mounting angle (yaw of boresight in the car's frame), within half a turn.
    pub angle_rad: f64,
    /// Its standard deviation.
    pub sigma_rad: f64,
    /// Scale factor of the yaw rate (measured over true).
    pub scale: f64,
    /// Its standard deviation; 0 where it was not estimated.
    pub scale_sigma: f64,
    /// Covariance of angle (rad) and inverse scale `s'`: `[[tt, ts], [ts, ss]]`.
    #[serde(skip)]
    pub covariance: [[f64; 2]; 2],
    /// Bias of the yaw rate.
    pub bias_radps: f64,
    /// Its standard deviation; infinite where nothing is known of it.
    pub bias_sigma_radps: f64,
    /// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees; 0 where it was not estimated.
    pub slip_gradient_rad: f64,
    /// Its standard deviation; 0 where it was not estimated.
    pub slip_gradient_sigma_rad: f64,
    /// How long before its time stamp a scan was measured; 0 where it was not estimated.
    pub delay_s: f64,
    /// Its standard deviation; 0 where it was not estimated.
    pub delay_sigma_s: f64,
    /// Scale factor of the car's measured speed (measured over the radar's); 1 where it was not estimated.
    pub speed_scale: f64,
    /// Its standard deviation; 0 where it was not estimated.
    pub speed_scale_sigma: f64,
    /// When the angle last changed by a knock, on the clock of the frames then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changed_s: Option<f64>,
    /// Static detections over all, of the frames used; 0 without any.
    pub inlier_share: f64,
    /// What became of the frames.
    pub frames: FrameCounts,
    /// Time of the last accepted frame, on the clock of the frames; absent before the first frame of a session.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_frame_s: Option<f64>,
    /// Whether the last five frames or more were rejected, so that the estimate says nothing of the present.
    pub stale: bool,
    /// Frames rejected for their time; they are not among those given.
    pub rejected_frames: u64,
    /// Detections left out because no sensor measures their azimuth or range rate.
    pub rejected_detections: u64,
    /// Sessions started because times jumped back.
    pub clock_resets: u64,
    /// The angle has settled: its standard deviation is below the limit of the options and it moved
    /// by no more than that lately.
    pub converged: bool,
    /// Whether the angle differs from the nominal one beyond limit and chance; none without a
    /// nominal angle.
    pub misaligned: Option<bool>,
    /// Whether the radar is where it should be; none without a nominal angle.
    pub alignment: Option<Alignment>,
    /// What to know of it.
    #[option(described_as = Vec<boresight_core::Remark>)]
    #[serde(rename = "warnings", serialize_with = "remark::serialize")]
    pub remarks: Vec<Remark>,
}

impl AngleEstimate {
    /// How far the angle is from the nominal one of the options, within half a turn; none without a nominal angle.
    #[must_use]
    pub fn drift_rad(&self, options: &CalibrationOptions) -> Option<f64> {
        drift_rad(self.angle_rad, options)
    }
}
