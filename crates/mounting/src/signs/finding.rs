//! What was found out of a sign, and why nothing was.

use super::CERTAIN;
use super::lever::Lever;
use super::passing::Passing;
use boresight_core::Remark;
use boresight_options::{Described, Named};
use serde::Serialize;
use std::fmt::{Display, Formatter};

/// Deviations from which evidence for one sign speaks against the other.
const AGAINST: f64 = 2.5;

/// What a sign was told by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Evidence {
    /// How standing things move and turn from scan to scan.
    Passing,
    /// How the direction of the radar's velocity goes with the yaw rate, by its lever arm.
    LeverArm,
    /// Where the radar looks, and that the car drives forward or how its speed says.
    Direction,
}

/// Why a sign was not told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Untold {
    /// The log has no yaw rate where there are scans.
    NoYawRate,
    /// It has neither ranges nor places of its radars.
    NoRanges,
    /// It drives or turns too little.
    TooLittle,
    /// What tells it disagrees, within a radar or between them.
    Contradiction,
    /// Yaw rate and azimuths count to different sides, and the mounting says that it is the yaw rate that counts to the right.
    YawRateReversed,
}

impl Display for Untold {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoYawRate => "the log has no yaw rate for its scans",
            Self::NoRanges => "the log has neither ranges nor places of its radars",
            Self::TooLittle => "the car moves or turns too little in it",
            Self::Contradiction => "what tells it disagrees",
            Self::YawRateReversed => {
                "azimuths and yaw rate count to different sides, and by the mounting it is the yaw rate that is \
                 positive to the right"
            }
        })
    }
}

/// What was found out of one sign.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct SignFinding {
    /// Whether it is the usual one (left, receding); `None` where the drive does not tell.
    pub usual: Option<bool>,
    /// How many deviations speak for the likelier sign.
    pub deviations: f64,
    /// What tells it most.
    pub evidence: Option<Evidence>,
    /// Why it is not told.
    pub untold: Option<Untold>,
}

/// What was found out of the signs of a log.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct SignFindings {
    /// Of azimuths: usual is positive to the left.
    pub azimuth: SignFinding,
    /// Of range rates: usual is positive when receding.
    pub range_rate: SignFinding,
}

impl SignFindings {
    /// What was found out of azimuths.
    pub fn azimuth_remark(&self) -> Remark {
        remark("azimuth-sign", "azimuths", ["to the left", "to the right"], &self.azimuth)
    }

    /// What was found out of range rates.
    pub fn range_rate_remark(&self) -> Remark {
        remark(
            "range-rate-sign",
            "range rates",
            ["when receding", "when approaching"],
            &self.range_rate,
        )
    }
}

fn remark(code: &'static str, what: &str, signs: [&str; 2], finding: &SignFinding) -> Remark {
    let message = match (finding.usual, finding.untold) {
        (Some(usual), _) => {
            let sign = signs[usize::from(!usual)];
            let by = finding.evidence.map_or("", Named::name);
            format!("{what} are positive {sign} ({by}, {:.0} deviations)", finding.deviations.abs())
        }
        (None, untold) => {
            let why = untold.unwrap_or(Untold::TooLittle);
            format!(
                "the drive does not tell whether {what} are positive {} or {}: {why}",
                signs[0], signs[1]
            )
        }
    };
    Remark::new(code, message)
}

/// Of one radar's azimuths.
pub(super) fn azimuth(passing: &Passing, lever: &Lever, has_yaw_rate: bool) -> SignFinding {
    let untold = match (has_yaw_rate, passing.has_ranges || lever.has_lever) {
        (false, _) => Untold::NoYawRate,
        (_, false) => Untold::NoRanges,
        _ => Untold::TooLittle,
    };
    let found =
        decide([(Evidence::Passing, passing.azimuth), (Evidence::LeverArm, lever.azimuth)], untold);
    if found.usual == Some(false) && lever.yaw_rate_reversed {
        return SignFinding { usual: None, untold: Some(Untold::YawRateReversed), ..found };
    }
    found
}

/// Of one radar's range rates, once its azimuths are known as far as they are.
pub(super) fn range_rate(passing: &Passing, lever: &Lever, azimuth: &SignFinding) -> SignFinding {
    let direction = match (azimuth.usual, lever.range_rate) {
        (Some(true), [usual, _]) => usual,
        (Some(false), [_, mirrored]) => mirrored,
        // Either must say the same.
        (None, [Some(a), Some(b)]) if a * b > 0.0 => Some(if a.abs() < b.abs() { a } else { b }),
        _ => None,
    };
    let untold =
        if passing.has_ranges || lever.has_lever { Untold::TooLittle } else { Untold::NoRanges };
    decide([(Evidence::Passing, passing.range_rate), (Evidence::Direction, direction)], untold)
}

/// The sign that one piece of evidence tells for certain and none speaks against.
fn decide(given: [(Evidence, Option<f64>); 2], untold: Untold) -> SignFinding {
    let known =
        given.into_iter().filter_map(|(evidence, deviations)| Some((evidence, deviations?)));
    let Some((evidence, deviations)) = known.clone().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    else {
        return SignFinding { usual: None, deviations: 0.0, evidence: None, untold: Some(untold) };
    };
    let against =
        known.clone().any(|(_, other)| other * deviations < 0.0 && other.abs() >= AGAINST);
    let untold = match (deviations.abs() >= CERTAIN, against) {
        (false, _) => Some(Untold::TooLittle),
        (true, true) => Some(Untold::Contradiction),
        (true, false) => None,
    };
    let usual = untold.is_none().then_some(deviations > 0.0);
    SignFinding { usual, deviations, evidence: Some(evidence), untold }
}

/// Of a whole log: radars of a car count alike, so those that tell must agree.
pub(super) fn of_all(radars: &[SignFinding]) -> SignFinding {
    let strongest = radars.iter().max_by(|a, b| a.deviations.abs().total_cmp(&b.deviations.abs()));
    let told = |usual| radars.iter().find(|radar| radar.usual == Some(usual));
    let reversed = radars.iter().find(|radar| radar.untold == Some(Untold::YawRateReversed));
    match (told(true), told(false), reversed, strongest) {
        (Some(_), Some(_), _, Some(first)) => {
            SignFinding { usual: None, untold: Some(Untold::Contradiction), ..*first }
        }
        (_, _, Some(reversed), _) => *reversed,
        (Some(usual), None, ..) | (None, Some(usual), ..) => radars
            .iter()
            .filter(|radar| radar.usual == usual.usual)
            .max_by(|a, b| a.deviations.abs().total_cmp(&b.deviations.abs()))
            .copied()
            .unwrap_or(*usual),
        (.., Some(first)) => *first,
        (.., None) => SignFinding {
            usual: None,
            deviations: 0.0,
            evidence: None,
            untold: Some(Untold::NoRanges),
        },
    }
}
