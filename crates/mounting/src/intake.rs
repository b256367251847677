//! What is accepted of the frames given: times that do not run backwards, detections that a sensor can have measured.

use crate::error::MountingError;
use boresight_core::{Detection, InputError};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::f64::consts::PI;

/// Consecutive frames on a new time base after which the clock counts as reset.
pub(crate) const RESET_FRAMES: u32 = 10;
/// Frames on a new time base are at most this far apart, s.
const RESET_GAP_S: f64 = 5.0;
/// Frames at most this late never count as a reset, s: the clock catches up with the last accepted frame by itself.
const LATE_S: f64 = 10.0;
/// Consecutive rejected frames after which an estimate counts as stale.
const STALE_FRAMES: u64 = 5;

/// Largest azimuth of a detection, rad: half a turn, and what single precision adds to it.
const MAX_AZIMUTH_RAD: f64 = PI * (1.0 + 1e-6);
/// Largest range rate of a detection, m/s: more than two cars approach each other with. Invalid values of 16 bits in cm/s lie beyond.
const MAX_RANGE_RATE_MPS: f64 = 300.0;
/// Different azimuths beyond half a turn that are taken for special values rather than for degrees.
const SPECIAL_VALUES: usize = 3;

/// What becomes of a frame by its time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Admission {
    /// It continues the session.
    Continues,
    /// The clock was reset: a new session starts with it.
    NewSession,
}

/// Counts of what was rejected, and the frames that may turn out to be on a new time base.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Intake {
    /// Sessions that began because the clock was found to be reset.
    pub(crate) clock_resets: u64,
    pub(crate) rejected_frames: u64,
    pub(crate) rejected_detections: u64,
    /// Frames rejected since the last one accepted.
    rejected_in_a_row: u64,
    /// Number of consistent frames on a new time base, and the time of the last of them.
    candidate: Option<(u32, f64)>,
}

impl Intake {
    /// Decides on a frame at a time, s, after one at `previous_s`.
    ///
    /// # Errors
    /// [`MountingError::TimeBackwards`] and [`InputError::NotFinite`]; the frame then counts as rejected.
    pub(crate) fn admit(
        &mut self,
        previous_s: Option<f64>,
        given_s: f64,
    ) -> Result<Admission, MountingError> {
        let admission = self.judge(previous_s, given_s);
        match admission {
            Ok(admission) => {
                self.clock_resets += u64::from(admission == Admission::NewSession);
                self.rejected_in_a_row = 0;
                self.candidate = None;
            }
            Err(_) => {
                self.rejected_frames += 1;
                self.rejected_in_a_row += 1;
            }
        }
        admission
    }

    fn judge(&mut self, previous_s: Option<f64>, given_s: f64) -> Result<Admission, MountingError> {
        if !given_s.is_finite() {
            self.candidate = None;
            let (what, index) = ("time_s".into(), 0);
            return Err(InputError::NotFinite { what, index, given: given_s }.into());
        }
        let Some(previous) = previous_s.filter(|previous| given_s < *previous) else {
            return Ok(Admission::Continues);
        };
        let continued = self.candidate.filter(|(_, last_s)| {
            let step_s = given_s - last_s;
            step_s > 0.0 && step_s <= RESET_GAP_S
        });
        let frames = continued.map_or(1, |(frames, _)| frames + 1);
        self.candidate = (given_s < previous - LATE_S).then_some((frames, given_s));
        if self.candidate.is_some() && frames >= RESET_FRAMES {
            return Ok(Admission::NewSession);
        }
        Err(MountingError::TimeBackwards { previous, given: given_s })
    }

    /// Whether frames keep being rejected, so that the estimate says nothing of the present.
    pub(crate) fn is_stale(&self) -> bool {
        self.rejected_in_a_row >= STALE_FRAMES
    }

    /// Starts a session that the caller asked for.
    pub(crate) fn restart(&mut self) {
        self.rejected_in_a_row = 0;
        self.candidate = None;
    }

    /// Adds the counts of another drive.
    pub(crate) fn absorb(&mut self, other: &Self) {
        self.restart();
        self.clock_resets += other.clock_resets;
        self.rejected_frames += other.rejected_frames;
        self.rejected_detections += other.rejected_detections;
    }

    /// The detections of a frame that can be used; the others are counted.
    pub(crate) fn screen<'a>(&mut self, detections: &'a [Detection]) -> Screened<'a> {
        let screened = Screened::new(detections);
        self.rejected_detections += screened.rejected() as u64;
        screened
    }
}

/// Whether a sensor can have measured a detection; special values for "not measured" lie beyond.
pub(crate) fn is_valid(detection: &Detection) -> bool {
    f64::from(detection.azimuth_rad.abs()) <= MAX_AZIMUTH_RAD
        && f64::from(detection.range_rate_mps.abs()) <= MAX_RANGE_RATE_MPS
}

/// Number of different finite azimuths beyond half a turn, less the special values for "not measured" that there may be.
pub(crate) fn azimuths_beyond(detections: &[Detection]) -> usize {
    let azimuths = detections.iter().map(|detection| detection.azimuth_rad);
    let mut beyond: Vec<f32> = azimuths
        .filter(|azimuth| azimuth.is_finite() && f64::from(azimuth.abs()) > MAX_AZIMUTH_RAD)
        .collect();
    beyond.sort_unstable_by(f32::total_cmp);
    beyond.dedup();
    beyond.len().saturating_sub(SPECIAL_VALUES)
}

/// The valid detections of a frame.
#[derive(Debug)]
pub(crate) struct Screened<'a> {
    pub(crate) detections: Cow<'a, [Detection]>,
    /// Number of detections given.
    given: usize,
    /// Places of the valid ones among those given, where some are not.
    places: Vec<usize>,
}

impl<'a> Screened<'a> {
    pub(crate) fn new(detections: &'a [Detection]) -> Self {
        let given = detections.len();
        if detections.iter().all(is_valid) {
            return Self { detections: Cow::Borrowed(detections), given, places: vec![] };
        }
        let places: Vec<usize> = (0..given).filter(|i| is_valid(&detections[*i])).collect();
        let valid = places.iter().map(|i| detections[*i]).collect();
        Self { detections: Cow::Owned(valid), given, places }
    }

    pub(crate) fn rejected(&self) -> usize {
        self.given - self.detections.len()
    }

    /// Weights of the valid detections as weights of those given, 0 for the others.
    pub(crate) fn spread(&self, weights: &mut Vec<f32>) {
        if self.rejected() == 0 {
            return;
        }
        let mut all = vec![0.0; self.given];
        for (place, weight) in self.places.iter().zip(weights.iter()) {
            all[*place] = *weight;
        }
        *weights = all;
    }
}
