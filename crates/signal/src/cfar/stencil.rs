//! Which cells train the threshold of a cell: a cross section, a ring, and what is left of them at
//! the edges of the map.

use super::training_cells::TrainingCells;
use super::{CfarAxes, CfarOptions};
use crate::error::SignalError;
use boresight_math::error::check_range;
use std::ops::Range;

/// Most cells a window may reach from the cell under test, along either axis.
const MAX_REACH: usize = 4096;

/// A rectangle of training cells: rows of the map, and Doppler bins relative to the cell under
/// test, which wrap.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rectangle {
    pub rows: Range<usize>,
    pub offsets: Range<isize>,
}

impl Rectangle {
    pub fn cells(&self) -> usize {
        self.rows.len() * self.offsets.len()
    }
}

/// Shape of the training window over a map of `ranges` x `dopplers`.
#[derive(Debug, Clone, Copy)]
pub struct Stencil {
    guard: [usize; 2],
    reach: [usize; 2],
    ranges: usize,
}

impl Stencil {
    pub fn new(ranges: usize, dopplers: usize, options: &CfarOptions) -> Result<Self, SignalError> {
        let mut guard = options.guard_cells;
        let mut training = options.training_cells;
        for (what, cells) in [
            ("range guard cells", guard[0]),
            ("Doppler guard cells", guard[1]),
            ("range training cells", training[0]),
            ("Doppler training cells", training[1]),
        ] {
            check_range(what, cells as f64, 0.0, MAX_REACH as f64 / 2.0)?;
        }
        let unused = match options.axes {
            CfarAxes::Range => Some(1),
            CfarAxes::Doppler => Some(0),
            CfarAxes::Both => None,
        };
        if let Some(axis) = unused {
            (guard[axis], training[axis]) = (0, 0);
        }
        check_range("training cells", (training[0] + training[1]) as f64, 1.0, MAX_REACH as f64)?;
        let reach = [guard[0] + training[0], guard[1] + training[1]];
        let width = 2 * reach[1] + 1;
        if width > dopplers {
            return Err(SignalError::Window { axis: "Doppler", cells: dopplers, given: width });
        }
        let stencil = Self { guard, reach, ranges };
        // At the worst place one side must hold a training cell, unless rows beside it do.
        if training[1] == 0 && (0..ranges).any(|row| stencil.training(row).total() == 0) {
            let given = 2 * (guard[0] + 1);
            return Err(SignalError::Window { axis: "range", cells: ranges, given });
        }
        Ok(stencil)
    }

    /// Cells the window reaches to either side, along range and Doppler.
    pub fn reach(&self) -> [usize; 2] {
        self.reach
    }

    /// Doppler bins the window reaches to either side.
    pub fn doppler_reach(&self) -> usize {
        self.reach[1]
    }

    /// The halves before and after the cells of a row, point-symmetric where the row is far from
    /// the edges: the bands of smaller and greater range, each with one side of the guard rows.
    pub fn halves(&self, row: usize) -> [Vec<Rectangle>; 2] {
        let [guard, doppler_guard] = self.guard.map(|g| g as isize);
        let [reach, doppler_reach] = self.reach.map(|r| r as isize);
        let rows = |first: isize, last: isize| {
            let clip = |r: isize| (row as isize + r).clamp(0, self.ranges as isize) as usize;
            clip(first)..clip(last + 1)
        };
        let beside = rows(-guard, guard);
        let across = -doppler_reach..doppler_reach + 1;
        let half = |rows: Range<usize>, offsets: Range<isize>| {
            let both = [
                Rectangle { rows, offsets: across.clone() },
                Rectangle { rows: beside.clone(), offsets },
            ];
            both.into_iter().filter(|rectangle| rectangle.cells() > 0).collect()
        };
        [
            half(rows(-reach, -guard - 1), -doppler_reach..-doppler_guard),
            half(rows(guard + 1, reach), doppler_guard + 1..doppler_reach + 1),
        ]
    }

    /// Numbers of training cells of the cells of a row.
    pub fn training(&self, row: usize) -> TrainingCells {
        let [before, after] = self.halves(row).map(|half| half.iter().map(Rectangle::cells).sum());
        TrainingCells { before, after }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;

    fn stencil(axes: CfarAxes) -> Stencil {
        let options = CfarOptions {
            axes,
            guard_cells: [1, 2],
            training_cells: [3, 4],
            ..CfarOptions::default()
        };
        Stencil::new(20, 16, &options).unwrap()
    }

    #[test]
    fn halves_are_equal_inside_and_one_sided_at_the_edges() {
        let range = stencil(CfarAxes::Range);
        assert_eq!(range.training(10), TrainingCells { before: 3, after: 3 });
        assert_eq!(range.training(0), TrainingCells { before: 0, after: 3 });
        assert_eq!(range.training(3), TrainingCells { before: 2, after: 3 });
        assert_eq!(range.training(18), TrainingCells { before: 3, after: 0 });
        let doppler = stencil(CfarAxes::Doppler);
        assert_eq!(doppler.training(0), TrainingCells { before: 4, after: 4 });
        let both = stencil(CfarAxes::Both);
        assert_eq!(both.training(10), TrainingCells { before: 3 * 13 + 12, after: 3 * 13 + 12 });
        assert_eq!(both.training(0), TrainingCells { before: 2 * 4, after: 3 * 13 + 2 * 4 });
    }

    #[test]
    fn training_cells_avoid_the_guard_and_each_other() {
        let [before, after] = stencil(CfarAxes::Both).halves(10);
        let mut seen = std::collections::HashSet::new();
        for rectangle in before.iter().chain(&after) {
            for row in rectangle.rows.clone() {
                for offset in rectangle.offsets.clone() {
                    assert!(row.abs_diff(10) > 1 || offset.unsigned_abs() > 2);
                    assert!(seen.insert((row, offset)), "{row} {offset} twice");
                }
            }
        }
        assert_eq!(seen.len(), 9 * 13 - 3 * 5);
    }

    #[test]
    fn windows_that_do_not_fit_are_refused() {
        let base = CfarOptions {
            axes: CfarAxes::Both,
            guard_cells: [2, 2],
            training_cells: [4, 4],
            ..CfarOptions::default()
        };
        let narrow = CfarOptions { axes: CfarAxes::Doppler, ..base };
        assert!(matches!(Stencil::new(64, 12, &narrow), Err(SignalError::Window { .. })));
        assert!(Stencil::new(64, 13, &narrow).is_ok());
        let range = CfarOptions { axes: CfarAxes::Range, ..base };
        assert!(matches!(Stencil::new(5, 1, &range), Err(SignalError::Window { .. })));
        assert!(Stencil::new(6, 1, &range).is_ok());
        let none = CfarOptions { training_cells: [0, 0], ..base };
        assert_eq!(Stencil::new(64, 64, &none).unwrap_err().details().what, "training cells");
        let huge = CfarOptions { guard_cells: [usize::MAX, 0], ..base };
        assert_eq!(Stencil::new(64, 64, &huge).unwrap_err().details().what, "range guard cells");
    }
}
