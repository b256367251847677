//! Which way azimuths and range rates of a log count, as it says itself.
//!
//! Formats and drivers disagree: azimuths are positive to the left or to the right, range rates positive when
//! receding or when approaching. A drive tells both where it is driven in a telling way:
//!
//! - Things that stand move from scan to scan by what the radar moves, and turn by what the car turns (`passing`).
//!   That they come nearer where the range rates say so tells the sign of range rates, that they turn against the yaw
//!   rate tells that of azimuths. It needs ranges, and for azimuths a yaw rate, but no mounting.
//! - A radar ahead of the rear axle moves sideways as the car turns (`lever`): the direction of its velocity
//!   changes with yaw rate times lever arm over speed, with slope 1 if azimuths are positive to the left and -1 if not.
//! - Where the radar's nominal direction is known, a car that drives forward approaches what lies ahead of it (`lever` too).
//!
//! A sign is told where its evidence is [`CERTAIN`] deviations strong and nothing speaks against it.

mod finding;
mod lever;
mod passing;
mod tally;

pub use finding::{Evidence, SignFinding, SignFindings, Untold};

use crate::error::MountingError;
use crate::statistics::frames::frames;
use boresight_core::{DriveLog, Remark, Scan};
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Deviations from which a sign counts as found.
pub const CERTAIN: f64 = 5.0;

/// Which side azimuths are positive on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AzimuthSign {
    /// Positive to the left, counter-clockwise seen from above: nothing is changed.
    #[default]
    Left,
    /// Positive to the right: all are turned round.
    Right,
    /// As the drive tells: turned round where it is certain that they are positive to the right.
    Auto,
}

/// When range rates are positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RangeRateSign {
    /// Positive when receding: nothing is changed.
    #[default]
    Receding,
    /// Positive when approaching, as a Doppler frequency: all are turned round.
    Approaching,
    /// As the drive tells: turned round where it is certain that they are positive when approaching.
    Auto,
}

/// What the signs of a drive's detections are taken to mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct SignOptions {
    /// The side on which azimuths are positive.
    pub azimuth_sign: AzimuthSign,
    /// When range rates are positive.
    pub range_rate_sign: RangeRateSign,
}

/// Finds out which signs a log has, its motion interpolated over gaps of at most `max_gap_s`.
///
/// # Errors
/// [`boresight_core::InputError::OutOfRange`] for a gap that is no positive number.
pub fn find_signs(log: &DriveLog, max_gap_s: f64) -> Result<SignFindings, MountingError> {
    boresight_math::error::check_range("max_gap_s", max_gap_s, f64::MIN_POSITIVE, f64::MAX)?;
    let mut azimuth = Vec::new();
    let mut range_rate = Vec::new();
    for sensor in &log.sensors {
        let scans: Vec<&Scan> = log.scans.iter().filter(|scan| scan.sensor == sensor.id).collect();
        let frames = frames(&scans)?;
        let passing = passing::passing(log, &scans, &frames, max_gap_s);
        let lever = lever::lever(log, &frames, sensor.mounting, max_gap_s);
        let found = finding::azimuth(&passing, &lever, !log.motion.is_empty());
        range_rate.push(finding::range_rate(&passing, &lever, &found));
        azimuth.push(found);
    }
    Ok(SignFindings {
        azimuth: finding::of_all(&azimuth),
        range_rate: finding::of_all(&range_rate),
    })
}

/// Gives a log the signs of [`DriveLog`], and says what was found out and turned round; signs are found out only
/// where an option asks for it.
///
/// # Errors
/// Those of [`find_signs`].
pub fn apply(
    log: &mut DriveLog,
    options: SignOptions,
    max_gap_s: f64,
) -> Result<Vec<Remark>, MountingError> {
    let SignOptions { azimuth_sign, range_rate_sign } = options;
    let mut turned =
        [azimuth_sign == AzimuthSign::Right, range_rate_sign == RangeRateSign::Approaching];
    let auto = [azimuth_sign == AzimuthSign::Auto, range_rate_sign == RangeRateSign::Auto];
    let mut remarks = Vec::new();
    if auto.contains(&true) {
        let found = find_signs(log, max_gap_s)?;
        let told = [
            (found.azimuth, found.azimuth_remark()),
            (found.range_rate, found.range_rate_remark()),
        ];
        for (i, (finding, remark)) in told.into_iter().enumerate().filter(|(i, _)| auto[*i]) {
            turned[i] = finding.usual == Some(false);
            let done = if turned[i] { "; all were turned round" } else { "; nothing was changed" };
            remarks.push(Remark::new(remark.code, remark.message + done));
        }
    }
    let [azimuth, range_rate] = turned.map(|turned| if turned { -1.0 } else { 1.0 });
    for detection in log.scans.iter_mut().flat_map(|scan| &mut scan.detections) {
        detection.azimuth_rad *= azimuth;
        detection.range_rate_mps *= range_rate;
    }
    Ok(remarks)
}
