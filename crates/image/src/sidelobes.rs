//! How much of a bird's-eye view is not target.

use crate::error::ImageError;
use crate::gate::{self, Gate, Gates};
use crate::view::{BirdsEyeView, NO_RADAR};
use boresight_math::decibels::{db_to_power, power_to_db};
use boresight_options::{Described, decibels};
use serde::Serialize;

/// Cells less than this below the strongest of the view count as lit, dB.
pub const LIT_DB: f64 = 40.0;

/// How much of a view is not where targets are.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct SidelobeMeasure {
    /// Energy (the sum of powers) outside the gates over all energy; minus infinity if there is none
    /// outside.
    #[serde(rename = "outside_db", serialize_with = "decibels::serialize_share")]
    pub outside_share: f64,
    /// Strongest cell outside the gates over the strongest of all.
    #[serde(rename = "peak_outside_db", serialize_with = "decibels::serialize_share")]
    pub peak_outside: f64,
    /// Share of the cells outside the gates that are lit: less than 40 dB below the strongest of all.
    pub lit_outside: f64,
    /// Share of the targets in view with a lit cell in their gate.
    pub lit_targets: f64,
    /// Targets in view.
    pub targets: usize,
    /// Share of the cells seen that lie in gates.
    pub gated: f64,
}

impl SidelobeMeasure {
    /// [`SidelobeMeasure::outside_share`] in dB.
    pub fn outside_db(&self) -> f64 {
        power_to_db(self.outside_share)
    }

    /// [`SidelobeMeasure::peak_outside`] in dB.
    pub fn peak_outside_db(&self) -> f64 {
        power_to_db(self.peak_outside)
    }
}

/// Measures a view against the true places of targets (x and y in the car's frame, m).
///
/// A cell that touches the gate of any target is inside. Gates of [`Gate::Resolution`] hang on the
/// radar that made the cell, so that they are as wide as what it cannot resolve there.
///
/// # Errors
/// Gates that are not positive, places that are not finite.
pub fn sidelobe_measure(
    view: &BirdsEyeView,
    targets_m: &[[f64; 2]],
    gate: Gate,
) -> Result<SidelobeMeasure, ImageError> {
    gate::check(gate, targets_m)?;
    let lit = Lit::of(view);
    let (mut in_view, mut lit_targets) = (0, 0);
    let inside = Gates::new(view, gate).inside(targets_m, |cells| {
        in_view += usize::from(!cells.is_empty());
        lit_targets += usize::from(cells.iter().any(|&cell| lit.is(view.power[cell])));
    });
    let (mut all, mut outside, mut peak) = (0.0, 0.0, 0.0_f32);
    let (mut seen, mut gated, mut lit_outside) = (0, 0, 0);
    for ((&power, &radar), &inside) in view.power.iter().zip(&view.radar).zip(&inside) {
        if radar == NO_RADAR {
            continue;
        }
        seen += 1;
        all += f64::from(power);
        if inside {
            gated += 1;
        } else {
            outside += f64::from(power);
            peak = peak.max(power);
            lit_outside += usize::from(lit.is(power));
        }
    }
    Ok(SidelobeMeasure {
        outside_share: share(outside, all),
        peak_outside: share(f64::from(peak), f64::from(lit.strongest)),
        lit_outside: share(lit_outside as f64, (seen - gated) as f64),
        lit_targets: share(lit_targets as f64, in_view as f64),
        targets: in_view,
        gated: share(gated as f64, seen as f64),
    })
}

/// Which cells of a view are lit.
pub(crate) struct Lit {
    strongest: f32,
    least: f64,
}

impl Lit {
    pub fn of(view: &BirdsEyeView) -> Self {
        let strongest = view.power.iter().copied().fold(0.0_f32, f32::max);
        Self { strongest, least: f64::from(strongest) * db_to_power(-LIT_DB) }
    }

    pub fn is(&self, power: f32) -> bool {
        f64::from(power) >= self.least && power > 0.0
    }
}

/// A part of a whole; 0 of nothing.
pub(crate) fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
