//! How right points are that radars found, against the true places of targets.

use crate::error::ImageError;
use crate::gate::{self, Gate, PointGates};
use crate::sidelobes::share;
use crate::splat::Target;
use boresight_core::drive::Mounting;
use boresight_math::order::sort_descending;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Points that one radar found.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarPoints {
    /// The radar.
    pub mounting: Mounting,
    /// The points.
    pub points: Vec<Target>,
}

/// How right points are.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PointMeasure {
    /// Points in all.
    pub points: usize,
    /// Points in no gate.
    pub false_points: usize,
    /// Their power over that of all points.
    pub false_share: f64,
    /// Of these, points where their radar cannot see, behind a wall, say.
    pub hidden_points: usize,
    /// Their power over that of all points.
    pub hidden_share: f64,
    /// Share of the targets with a point in their gate.
    pub found_targets: f64,
    /// False and hidden points among the strongest points that are enough to find half of the
    /// targets, so that methods are compared where they see as much; none of points that find fewer.
    pub at_half: Option<PointsAtHalf>,
}

/// Among the strongest points that find half of the targets.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PointsAtHalf {
    /// These points.
    pub points: usize,
    /// Those of them in no gate.
    pub false_points: usize,
    /// Those of them in no gate where their radar cannot see.
    pub hidden_points: usize,
}

/// Measures points against the true places of targets (x and y in the car's frame, m). Gates of
/// [`Gate::Resolution`] hang on the radar that found the point. `is_hidden` says of a radar (its index)
/// whether it cannot see a place. A point's power is that of its image, with its confidence.
///
/// # Errors
/// As [`crate::sidelobe_measure`].
pub fn point_measure(
    radars: &[RadarPoints],
    targets_m: &[[f64; 2]],
    gate: Gate,
    is_hidden: impl Fn(usize, [f64; 2]) -> bool,
) -> Result<PointMeasure, ImageError> {
    gate::check(gate, targets_m)?;
    let mut judged = vec![];
    for (radar, RadarPoints { mounting, points }) in radars.iter().enumerate() {
        let gates = PointGates::new(gate, *mounting, targets_m);
        for point in points {
            let (sin, cos) = (mounting.yaw_rad + point.azimuth_rad).sin_cos();
            let place = [mounting.x_m + point.range_m * cos, mounting.y_m + point.range_m * sin];
            let targets: Vec<usize> = gates.of(place).collect();
            let is_hidden = targets.is_empty() && is_hidden(radar, place);
            judged.push(Judged { power: point.power * point.confidence, targets, is_hidden });
        }
    }
    sort_descending(&mut judged, |point| point.power);
    Ok(measure(&judged, targets_m.len()))
}

/// A point, the targets in whose gate it lies, and whether it is where its radar cannot see.
struct Judged {
    power: f64,
    targets: Vec<usize>,
    is_hidden: bool,
}

/// Of points, strongest first.
fn measure(judged: &[Judged], targets: usize) -> PointMeasure {
    let mut is_found = vec![false; targets];
    let (mut found, mut false_points, mut hidden_points) = (0, 0, 0);
    let (mut all, mut false_power, mut hidden_power) = (0.0, 0.0, 0.0);
    let mut at_half = None;
    for (before, point) in judged.iter().enumerate() {
        all += point.power;
        if point.targets.is_empty() {
            false_points += 1;
            false_power += point.power;
        }
        if point.is_hidden {
            hidden_points += 1;
            hidden_power += point.power;
        }
        for &target in &point.targets {
            found += usize::from(!is_found[target]);
            is_found[target] = true;
        }
        if at_half.is_none() && found > 0 && 2 * found >= targets {
            at_half = Some(PointsAtHalf { points: before + 1, false_points, hidden_points });
        }
    }
    PointMeasure {
        points: judged.len(),
        false_points,
        false_share: share(false_power, all),
        hidden_points,
        hidden_share: share(hidden_power, all),
        found_targets: share(found as f64, targets as f64),
        at_half,
    }
}
