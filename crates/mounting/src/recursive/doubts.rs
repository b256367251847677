//! What a drive tells against its own data: signs and units that no car has.

use super::block::FreeScale;
use super::information::Information;
use crate::angle::wrap;
use crate::estimate::Remark;
use crate::frame::FrameInput;
use crate::frame::Verdict;
use crate::intake::azimuths_beyond;
use boresight_core::Detection;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A car that drives faster does not see a world at rest, m/s.
const DRIVING_MPS: f64 = 3.0;
/// Share of detections beyond half a turn from which azimuths are taken for degrees.
const WRONG_AZIMUTHS: f64 = 0.2;
/// Share of frames from which something is wrong with all.
const MOST: f64 = 0.5;
/// Share of a driving car's frames below which those used are exceptions.
const FEW: f64 = 0.2;
/// Standard deviations by which the yaw rate's part in the angle must be told.
const DEVIATIONS: f64 = 4.0;
/// Least standard deviation, rad (2 deg), of an angle that is in doubt.
const DOUBTED_RAD: f64 = 0.034_906_585_039_886_6;
/// Standard deviation, rad (5 deg), of an angle where most of what is seen moves and nothing tells the car's speed: it may be that of
/// the traffic.
const LED_ASTRAY_RAD: f64 = 0.087_266_462_599_716_5;
/// Frames from which shares are believed.
const ENOUGH: u64 = 50;

/// Counts over the drive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Doubts {
    detections: u64,
    beyond: u64,
    driving: u64,
    driving_still: u64,
    off_speed: u64,
    used: u64,
    tried: u64,
    with_speed: u64,
    pub(crate) free_scale: FreeScale,
}

impl std::ops::AddAssign for Doubts {
    fn add_assign(&mut self, other: Self) {
        self.detections += other.detections;
        self.beyond += other.beyond;
        self.driving += other.driving;
        self.driving_still += other.driving_still;
        self.off_speed += other.off_speed;
        self.used += other.used;
        self.tried += other.tried;
        self.with_speed += other.with_speed;
        self.free_scale += other.free_scale;
    }
}

impl Doubts {
    /// Looks at all azimuths of a frame, valid or not.
    pub(crate) fn look_at_azimuths(&mut self, detections: &[Detection]) {
        self.detections += detections.len() as u64;
        self.beyond += azimuths_beyond(detections) as u64;
    }

    /// Looks at a frame before anything is done with it.
    pub(crate) fn look(&mut self, frame: &FrameInput, share_at_rest: f64) {
        if frame.speed_mps.is_some_and(|speed| speed.abs() > DRIVING_MPS)
            && !frame.detections.is_empty()
        {
            self.driving += 1;
            self.driving_still += u64::from(share_at_rest >= MOST);
        }
    }

    /// What a frame of a driving car came to, and whether the car's speed was known.
    pub(crate) fn tried(&mut self, verdict: Verdict, with_speed: bool) {
        self.tried += 1;
        self.used += u64::from(verdict == Verdict::Used);
        self.off_speed += u64::from(verdict == Verdict::OffSpeed);
        self.with_speed += u64::from(with_speed);
    }

    /// What they come to, with the standard deviation that they add to the angle, rad.
    pub(crate) fn remarks(
        &self,
        known: &Information,
        nominal_rad: Option<f64>,
        inlier_share: f64,
    ) -> (Vec<Remark>, f64) {
        let mut remarks = Vec::new();
        let mut say = |holds: bool, remark| {
            if holds {
                remarks.push(remark);
            }
        };
        let share = |part: u64, whole: u64| part as f64 / whole.max(1) as f64;
        say(share(self.beyond, self.detections) > WRONG_AZIMUTHS, Remark::AzimuthUnit);
        let driven = self.driving >= ENOUGH;
        say(driven && share(self.driving_still, self.driving) > MOST, Remark::StillWhileDriving);
        let tried = self.tried >= ENOUGH;
        say(tried && share(self.off_speed, self.tried) > MOST, Remark::OffSpeed);
        say(tried && share(self.used, self.tried) < FEW, Remark::FewFrames);
        if let Some((inverse_scale, sigma)) = self.free_scale.estimate() {
            let near = |value: f64| (inverse_scale - value).abs() < (DEVIATIONS * sigma).max(0.3);
            if near(-1.0) && inverse_scale + DEVIATIONS * sigma < 0.0 {
                let angle = known.mean()[0];
                let mirrored = nominal_rad.is_some_and(|nominal| {
                    wrap(angle + nominal).abs() < wrap(angle - nominal).abs()
                });
                say(mirrored, Remark::AzimuthMirrored);
                say(!mirrored, Remark::YawRateReversed);
            }
            let degrees = PI / 180.0;
            say(
                (inverse_scale - degrees).abs() < 0.1 && DEVIATIONS * sigma < 0.3,
                Remark::YawRateUnit,
            );
        }
        say(implausible(known), Remark::Implausible);
        let mut doubt = if remarks.is_empty() { 0.0 } else { DOUBTED_RAD };
        if self.used > 0 && inlier_share < MOST {
            remarks.push(Remark::FewInliers);
            if 2 * self.with_speed < self.tried {
                doubt = LED_ASTRAY_RAD;
            }
        }
        (remarks, doubt)
    }
}

/// Whether an unknown ended where its prior has it once in 16,000 times.
fn implausible(known: &Information) -> bool {
    let (mean, inverse_variance) = known.prior();
    (1..mean.len()).any(|i| {
        (known.mean()[i] - mean[i]).powi(2) * inverse_variance[i] > DEVIATIONS * DEVIATIONS
    })
}
