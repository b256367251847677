//! What counts as a target itself.

use crate::axis::Axis;
use crate::error::ImageError;
use crate::view::{BirdsEyeView, Polar};
use boresight_core::drive::Mounting;
use boresight_math::error::{check_finite, check_range};
use ndarray::Array2;

/// What counts as the target itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gate {
    /// Everything within this distance, m.
    Circle {
        /// Radius, m.
        radius_m: f64,
    },
    /// What the radar that made a cell or point cannot resolve from the target.
    Resolution {
        /// Half width in range, m.
        range_m: f64,
        /// Half width in sine of azimuth.
        sine: f64,
    },
}

impl Gate {
    /// Whether a cell whose corners lie `corner_m` from its middle touches the gate of a target, as a
    /// radar sees both; of a point, whether it lies in it.
    fn touches(self, polar: &Polar, cell: [f64; 2], corner_m: f64, target: &Seen) -> bool {
        match self {
            Self::Circle { radius_m } => {
                let (dx, dy) = (cell[0] - target.place[0], cell[1] - target.place[1]);
                (dx * dx + dy * dy).sqrt() <= radius_m + corner_m
            }
            Self::Resolution { range_m, sine } => {
                match (polar.of(cell[0], cell[1]), target.polar) {
                    (Some(cell), Some(target)) => {
                        (cell.0 - target.0).abs() <= range_m + corner_m
                            && (cell.1 - target.1).abs() <= sine + corner_m / cell.0
                    }
                    _ => false,
                }
            }
        }
    }
}

/// A target, and where a radar sees it.
struct Seen {
    place: [f64; 2],
    polar: Option<(f64, f64)>,
}

/// Checks a gate and the places of targets.
///
/// # Errors
/// Gates that are not positive, places that are not finite.
pub(crate) fn check(gate: Gate, targets_m: &[[f64; 2]]) -> Result<(), ImageError> {
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
    Ok(())
}

/// The gates of targets around the points that one radar found.
pub(crate) struct PointGates {
    gate: Gate,
    polar: Polar,
    targets: Vec<Seen>,
}

impl PointGates {
    pub fn new(gate: Gate, mounting: Mounting, targets_m: &[[f64; 2]]) -> Self {
        let polar = Polar::new(mounting);
        let seen = |&place: &[f64; 2]| Seen { place, polar: polar.of(place[0], place[1]) };
        Self { gate, targets: targets_m.iter().map(seen).collect(), polar }
    }

    /// Indices of the targets in whose gate a place lies.
    pub fn of(&self, place: [f64; 2]) -> impl Iterator<Item = usize> {
        let is_in = move |target: &Seen| self.gate.touches(&self.polar, place, 0.0, target);
        self.targets.iter().enumerate().filter(move |(_, target)| is_in(target)).map(|(k, _)| k)
    }
}

/// The gates of a view.
pub(crate) struct Gates<'a> {
    view: &'a BirdsEyeView,
    gate: Gate,
    radars: Vec<Polar>,
    /// From a cell's middle to its corner, m.
    corner_m: f64,
}

impl<'a> Gates<'a> {
    pub fn new(view: &'a BirdsEyeView, gate: Gate) -> Self {
        let radars = view.mountings.iter().map(|mounting| Polar::new(*mounting)).collect();
        Self { view, gate, radars, corner_m: view.grid.cell_m * std::f64::consts::FRAC_1_SQRT_2 }
    }

    /// Which cells lie in gates. `each` takes the cells of one target after the other.
    pub fn inside(
        &self,
        targets_m: &[[f64; 2]],
        mut each: impl FnMut(&[[usize; 2]]),
    ) -> Array2<bool> {
        let mut inside = Array2::from_elem(self.view.power.dim(), false);
        let mut cells = vec![];
        for &target in targets_m {
            cells.clear();
            self.cells(target, |cell| cells.push(cell));
            cells.iter().for_each(|&cell| inside[cell] = true);
            each(&cells);
        }
        inside
    }

    /// Calls `take` with each seen cell that touches the gate of a target.
    fn cells(&self, [x, y]: [f64; 2], mut take: impl FnMut([usize; 2])) {
        let seen = |polar: &Polar| Seen { place: [x, y], polar: polar.of(x, y) };
        let targets: Vec<Seen> = self.radars.iter().map(seen).collect();
        let half_m = self.half_width_m(&targets);
        let (x_m, y_m) = (self.view.grid.x_m, self.view.grid.y_m);
        for i in around(x_m, x, half_m) {
            for k in around(y_m, y, half_m) {
                // What no radar sees has no entry in the table of radars.
                let radar = self.view.radar[[i, k]] as usize;
                let Some((polar, target)) = self.radars.get(radar).zip(targets.get(radar)) else {
                    continue;
                };
                let cell = [x_m.value(i), y_m.value(k)];
                if self.gate.touches(polar, cell, self.corner_m, target) {
                    take([i, k]);
                }
            }
        }
    }

    /// Half width of a square that holds a target's gates of all radars, m.
    fn half_width_m(&self, targets: &[Seen]) -> f64 {
        let gate_m = match self.gate {
            Gate::Circle { radius_m } => radius_m,
            Gate::Resolution { range_m, sine } => {
                let chord = |&(range, at): &(f64, f64)| {
                    let angle = |sine: f64| sine.clamp(-1.0, 1.0).asin();
                    let wide = (angle(at + sine) - angle(at)).max(angle(at) - angle(at - sine));
                    (range + range_m) * wide
                };
                let seen = targets.iter().filter_map(|target| target.polar.as_ref());
                range_m + seen.map(chord).fold(0.0, f64::max)
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
