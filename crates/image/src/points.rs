//! How right points are that radars found, against the true places of targets.

use crate::error::ImageError;
use crate::gate::{self, Gate, PointGates};
use crate::sidelobes::share;
use crate::splat::Target;
use boresight_core::drive::Mounting;
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    let mut found = vec![false; targets_m.len()];
    let (mut points, mut false_points, mut hidden_points) = (0, 0, 0);
    let (mut all, mut false_power, mut hidden_power) = (0.0, 0.0, 0.0);
    for (radar, RadarPoints { mounting, points: of_radar }) in radars.iter().enumerate() {
        let gates = PointGates::new(gate, *mounting, targets_m);
        for point in of_radar {
            let power = point.power * point.confidence;
            let (sin, cos) = (mounting.yaw_rad + point.azimuth_rad).sin_cos();
            let place = [mounting.x_m + point.range_m * cos, mounting.y_m + point.range_m * sin];
            points += 1;
            all += power;
            let mut is_true = false;
            for target in gates.of(place) {
                (found[target], is_true) = (true, true);
            }
            if is_true {
                continue;
            }
            false_points += 1;
            false_power += power;
            if is_hidden(radar, place) {
                hidden_points += 1;
                hidden_power += power;
            }
        }
    }
    let found = found.iter().filter(|found| **found).count();
    Ok(PointMeasure {
        points,
        false_points,
        false_share: share(false_power, all),
        hidden_points,
        hidden_share: share(hidden_power, all),
        found_targets: share(found as f64, targets_m.len() as f64),
    })
}
