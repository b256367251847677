//! How much of a bird's-eye view is not target.

use crate::axis::Axis;
use crate::error::ImageError;
use crate::view::{BirdsEyeView, NO_RADAR, Polar};
use boresight_core::describe::{Described, decibels};
use boresight_core::error::{check_finite, check_range};
use boresight_core::units::power_to_db;
use ndarray::Array2;
use serde::Serialize;

/// Cells less than this below the strongest of the view count as lit, dB.
pub const LIT_DB: f64 = 40.0;

/// What counts as the target itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gate {
    /// Everything within this distance, m.
    Circle {
        /// Radius, m.
        radius_m: f64,
    },
    /// What the radar that made a cell cannot resolve from the target.
    Resolution {
        /// Half width in range, m.
        range_m: f64,
        /// Half width in sine of azimuth.
        sine: f64,
    },
}

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
    match gate {
        Gate::Circle { radius_m } => check_range("gate_m", radius_m, 1e-6, 1e6)?,
        Gate::Resolution { range_m, sine } => {
            check_range("gate range_m", range_m, 1e-6, 1e6)?;
            check_range("gate sine", sine, 1e-6, 1.0)?;
        }
    }
    for target in targets_m {
        check_finite("targets", *target)?;
    }
    let strongest = view.power.iter().copied().fold(0.0_f32, f32::max);
    let lit = f64::from(strongest) * 10_f64.powf(-LIT_DB / 10.0);
    let is_lit = |power: f32| f64::from(power) >= lit && power > 0.0;
    let gates = Gates::new(view, gate);
    let mut inside = Array2::from_elem(view.power.dim(), false);
    let (mut in_view, mut lit_targets) = (0, 0);
    for &target in targets_m {
        let (mut cells, mut has_lit) = (0, false);
        gates.cells(target, |cell| {
            cells += 1;
            inside[cell] = true;
            has_lit |= is_lit(view.power[cell]);
        });
        in_view += usize::from(cells > 0);
        lit_targets += usize::from(has_lit);
    }
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
            lit_outside += usize::from(is_lit(power));
        }
    }
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    Ok(SidelobeMeasure {
        outside_share: share(outside, all),
        peak_outside: share(f64::from(peak), f64::from(strongest)),
        lit_outside: share(lit_outside as f64, (seen - gated) as f64),
        lit_targets: share(lit_targets as f64, in_view as f64),
        targets: in_view,
        gated: share(gated as f64, seen as f64),
    })
}

/// The gates of a view.
struct Gates<'a> {
    view: &'a BirdsEyeView,
    gate: Gate,
    radars: Vec<Polar>,
    /// From a cell's middle to its corner, m.
    corner_m: f64,
}

impl<'a> Gates<'a> {
    fn new(view: &'a BirdsEyeView, gate: Gate) -> Self {
        let radars = view.mountings.iter().map(|mounting| Polar::new(*mounting)).collect();
        Self { view, gate, radars, corner_m: view.grid.cell_m * std::f64::consts::FRAC_1_SQRT_2 }
    }

    /// Calls `take` with each seen cell that touches the gate of a target.
    fn cells(&self, [x, y]: [f64; 2], mut take: impl FnMut([usize; 2])) {
        let places: Vec<_> = self.radars.iter().map(|polar| polar.of(x, y)).collect();
        let half_m = self.half_width_m(&places);
        let (x_m, y_m) = (self.view.grid.x_m, self.view.grid.y_m);
        for i in around(x_m, x, half_m) {
            for k in around(y_m, y, half_m) {
                // What no radar sees has no entry in the table of radars.
                let radar = self.view.radar[[i, k]] as usize;
                let Some((polar, place)) = self.radars.get(radar).zip(places.get(radar)) else {
                    continue;
                };
                let (cell_x, cell_y) = (x_m.value(i), y_m.value(k));
                let touches = match self.gate {
                    Gate::Circle { radius_m } => {
                        let (dx, dy) = (cell_x - x, cell_y - y);
                        (dx * dx + dy * dy).sqrt() <= radius_m + self.corner_m
                    }
                    Gate::Resolution { range_m, sine } => match (polar.of(cell_x, cell_y), place) {
                        (Some(cell), Some(target)) => {
                            (cell.0 - target.0).abs() <= range_m + self.corner_m
                                && (cell.1 - target.1).abs() <= sine + self.corner_m / cell.0
                        }
                        _ => false,
                    },
                };
                if touches {
                    take([i, k]);
                }
            }
        }
    }

    /// Half width of a square that holds a target's gates of all radars, m.
    fn half_width_m(&self, places: &[Option<(f64, f64)>]) -> f64 {
        let gate_m = match self.gate {
            Gate::Circle { radius_m } => radius_m,
            Gate::Resolution { range_m, sine } => {
                let chord = |&(range, at): &(f64, f64)| {
                    let angle = |sine: f64| sine.clamp(-1.0, 1.0).asin();
                    let wide = (angle(at + sine) - angle(at)).max(angle(at) - angle(at - sine));
                    (range + range_m) * wide
                };
                range_m + places.iter().flatten().map(chord).fold(0.0, f64::max)
            }
        };
        gate_m + 4.0 * self.corner_m
    }
}

/// Indices of the points within `half` of a value.
fn around(axis: Axis, value: f64, half: f64) -> std::ops::Range<usize> {
    let end = axis.len() as f64;
    let from = axis.position(value - half).ceil().clamp(0.0, end);
    let to = (axis.position(value + half).floor() + 1.0).clamp(from, end);
    from as usize..to as usize
}
