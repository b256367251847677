//! How much of a bird's-eye view is where its radar cannot see.

use crate::error::ImageError;
use crate::gate::{self, Gate, Gates};
use crate::sidelobes::{Lit, share};
use crate::view::{BirdsEyeView, NO_RADAR};
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// How much of a view is where the radar that shows it cannot see, behind a wall, say.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct HiddenMeasure {
    /// Energy (the sum of powers) of the hidden cells over all energy.
    pub share: f64,
    /// Ground of the lit ones among them (less than [`crate::LIT_DB`] below the strongest cell of the
    /// view), m^2.
    pub lit_m2: f64,
    /// Ground of all of them, m^2.
    pub hidden_m2: f64,
}

/// Measures what of a view is hidden from the radar whose power it shows: the cells outside all
/// gates for whose radar (index) and middle (x and y in the car's frame, m) `is_hidden` holds. Cells
/// in gates are left out, since a radar cannot tell a wall from what is right behind it.
///
/// # Errors
/// As [`crate::sidelobe_measure`].
pub fn hidden_measure(
    view: &BirdsEyeView,
    targets_m: &[[f64; 2]],
    gate: Gate,
    is_hidden: impl Fn(usize, [f64; 2]) -> bool,
) -> Result<HiddenMeasure, ImageError> {
    gate::check(gate, targets_m)?;
    let lit = Lit::of(view);
    let inside = Gates::new(view, gate).inside(targets_m, |_| {});
    let (mut all, mut power_hidden, mut hidden, mut lit_hidden) = (0.0, 0.0, 0_usize, 0_usize);
    for ((cell, &power), &radar) in view.power.indexed_iter().zip(&view.radar) {
        if radar == NO_RADAR {
            continue;
        }
        all += f64::from(power);
        let place = [view.grid.x_m.value(cell.0), view.grid.y_m.value(cell.1)];
        if !inside[cell] && is_hidden(radar as usize, place) {
            power_hidden += f64::from(power);
            hidden += 1;
            lit_hidden += usize::from(lit.is(power));
        }
    }
    let cell_m2 = view.grid.cell_m * view.grid.cell_m;
    Ok(HiddenMeasure {
        share: share(power_hidden, all),
        lit_m2: lit_hidden as f64 * cell_m2,
        hidden_m2: hidden as f64 * cell_m2,
    })
}
