//! Ranks among training cells, on a map that wraps along Doppler.

use super::stencil::Rectangle;
use ndarray::{Array2, ArrayView1, ArrayView2};

/// A map with its Doppler bins repeated on both sides.
pub struct Ranks {
    wrapped: Array2<f32>,
    reach: usize,
    limits: Vec<f32>,
    counts: Vec<u32>,
    training: Vec<f32>,
}

impl Ranks {
    /// Space for a map of `ranges` x `dopplers` and windows that reach `reach` to either side.
    pub fn new(ranges: usize, dopplers: usize, reach: usize) -> Self {
        let columns = if ranges == 0 { 0 } else { dopplers };
        Self {
            wrapped: Array2::zeros((ranges, columns + 2 * reach)),
            reach,
            limits: vec![0.0; columns],
            counts: vec![0; columns],
            training: vec![],
        }
    }

    /// Takes a map in.
    pub fn fill(&mut self, power: ArrayView2<f32>) {
        let (reach, dopplers) = (self.reach, power.ncols());
        for (row, mut wrapped) in power.outer_iter().zip(self.wrapped.outer_iter_mut()) {
            for (column, value) in wrapped.iter_mut().enumerate() {
                *value = row[(column + dopplers - reach) % dopplers];
            }
        }
    }

    /// Of each cell of a row with training cells in `halves`, how many of those lie below the cell over `factor`. A cell
    /// exceeds `factor` times the training cell of rank `k` exactly where they are at least `k`; counting needs no
    /// sorting.
    pub fn below(
        &mut self,
        halves: &[Vec<Rectangle>; 2],
        row: ArrayView1<f32>,
        factor: f64,
    ) -> &[u32] {
        let inverse = (1.0 / factor) as f32;
        self.limits.iter_mut().zip(row).for_each(|(limit, &p)| *limit = p * inverse);
        self.counts.fill(0);
        for (r, column) in training_columns(halves, self.reach) {
            let cells = self.wrapped.row(r);
            let cells = cells.as_slice().unwrap_or(&[]);
            for ((count, limit), value) in
                self.counts.iter_mut().zip(&self.limits).zip(&cells[column..])
            {
                *count += u32::from(value < limit);
            }
        }
        &self.counts
    }

    /// The training cell of a rank, from 1, of a cell at `doppler_bin`.
    pub fn nth(&mut self, halves: &[Vec<Rectangle>; 2], doppler_bin: usize, rank: usize) -> f64 {
        self.training.clear();
        let columns = training_columns(halves, self.reach);
        self.training.extend(columns.map(|(r, c)| self.wrapped[[r, c + doppler_bin]]));
        let (_, value, _) = self.training.select_nth_unstable_by(rank - 1, f32::total_cmp);
        f64::from(*value)
    }
}

/// Row and first column in the wrapped map of each training cell.
fn training_columns(
    halves: &[Vec<Rectangle>; 2],
    reach: usize,
) -> impl Iterator<Item = (usize, usize)> {
    halves.iter().flatten().flat_map(move |rectangle| {
        let offsets = rectangle.offsets.clone();
        rectangle.rows.clone().flat_map(move |r| {
            offsets.clone().map(move |offset| (r, (reach as isize + offset) as usize))
        })
    })
}
