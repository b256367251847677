//! Noise in the training cells of a cell under test: how independent they are.

use super::bin_noise::BinNoise;
use super::cell_averaging::Mean;
use super::stencil::Rectangle;
use super::training_cells::TrainingCells;
use crate::error::SignalError;
use boresight_core::Complex64;
use boresight_math::linalg::hermitian_eigen;
use ndarray::Array2;

/// Cells of a half in one line, up to which the mean's distribution follows from the eigenvalues of their correlation.
/// Of more cells, or of a ring, a gamma variable of the same variance stands for the mean.
const EXACT_CELLS: usize = 64;
/// Powers of squared correlations that an ordered statistic depends on.
pub const POWERS: usize = 64;

/// Correlations of cells along range and Doppler, by lag; one lag for independent cells.
#[derive(Debug, Clone)]
pub struct CellCorrelations([Vec<f64>; 2]);

impl CellCorrelations {
    /// Of cells at most `reach` from the cell under test along each axis.
    ///
    /// # Errors
    /// As [`BinNoise::correlations`].
    pub fn new(noise: [Option<BinNoise>; 2], reach: [usize; 2]) -> Result<Self, SignalError> {
        let along = |axis: usize| match &noise[axis] {
            Some(noise) => noise.correlations(2 * reach[axis]),
            None => Ok(vec![1.0]),
        };
        Ok(Self([along(0)?, along(1)?]))
    }

    /// Whether all cells are independent.
    fn are_none(&self) -> bool {
        self.0.iter().all(|lags| lags.len() <= 1)
    }
}

/// The training cells of a row.
#[derive(Debug, Clone)]
pub struct TrainingNoise {
    pub cells: TrainingCells,
    halves: [Half; 2],
    /// Sums over all pairs of different cells of the squared correlation to the powers 1, 2, ...; empty where there is
    /// none.
    pairs: Vec<f64>,
}

/// One half of them.
#[derive(Debug, Clone)]
struct Half {
    cells: usize,
    /// Eigenvalues of their correlation, where they are few and in a line.
    eigenvalues: Option<Vec<f64>>,
    /// Independent cells that so many stand for in the variance of their mean.
    effective: f64,
}

impl TrainingNoise {
    /// Of the halves of a stencil.
    pub fn new(halves: &[Vec<Rectangle>; 2], correlations: &CellCorrelations) -> Self {
        let all: Vec<&Rectangle> = halves.iter().flatten().collect();
        let half = |half: &Vec<Rectangle>| Half::new(half, correlations);
        let made = [half(&halves[0]), half(&halves[1])];
        let cells = TrainingCells { before: made[0].cells, after: made[1].cells };
        let pairs = if correlations.are_none() {
            vec![]
        } else {
            let of_power = |power: i32| pair_sum(&all, correlations, power);
            let first = of_power(1);
            // Those of high powers are negligible where no cells are much alike.
            (1..=POWERS as i32).map(of_power).take_while(|sum| *sum > 1e-4 * first).collect()
        };
        Self { cells, halves: made, pairs }
    }

    /// The mean of a half.
    pub fn half(&self, index: usize, looks: usize) -> Mean {
        self.halves[index].mean(looks)
    }

    /// The mean of all cells, the halves as independent.
    pub fn mean(&self, looks: usize) -> Mean {
        let [before, after] = &self.halves;
        if before.cells == 0 {
            return after.mean(looks);
        }
        if after.cells == 0 {
            return before.mean(looks);
        }
        let share = before.cells as f64 / self.cells.total() as f64;
        before.mean(looks).joined(&after.mean(looks), share)
    }

    /// See the field.
    pub fn pairs(&self) -> &[f64] {
        &self.pairs
    }
}

impl Half {
    fn new(rectangles: &[Rectangle], correlations: &CellCorrelations) -> Self {
        let cells: usize = rectangles.iter().map(Rectangle::cells).sum();
        let all: Vec<&Rectangle> = rectangles.iter().collect();
        let pairs =
            if correlations.are_none() { 0.0 } else { pair_sum(&all, correlations, 1).max(0.0) };
        let n = cells as f64;
        let effective = if cells == 0 { 0.0 } else { n * n / (n + pairs) };
        let axis = match rectangles {
            [one] if one.offsets.len() == 1 => Some(0),
            [one] if one.rows.len() == 1 => Some(1),
            _ => None,
        };
        let eigenvalues = axis
            .filter(|_| pairs > 0.0 && cells <= EXACT_CELLS)
            .and_then(|axis| eigenvalues(&correlations.0[axis], cells));
        Self { cells, eigenvalues, effective }
    }

    fn mean(&self, looks: usize) -> Mean {
        match &self.eigenvalues {
            Some(values) => Mean::weighted(values, looks as f64),
            None => Mean::gamma(looks as f64 * self.effective.max(1.0)),
        }
    }
}

/// Eigenvalues of the correlation of so many neighbours.
fn eigenvalues(correlations: &[f64], cells: usize) -> Option<Vec<f64>> {
    let at = |(i, k): (usize, usize)| {
        Complex64::new(correlations.get(i.abs_diff(k)).copied().unwrap_or(0.0), 0.0)
    };
    let matrix = Array2::from_shape_fn((cells, cells), at);
    let eigen = hermitian_eigen(matrix.view()).ok()?;
    Some(eigen.values.iter().map(|value| value.max(0.0)).collect())
}

/// Sum over all pairs of different cells of the squared correlation to a power.
fn pair_sum(rectangles: &[&Rectangle], correlations: &CellCorrelations, power: i32) -> f64 {
    let [range, doppler] = &correlations.0;
    let mut sum = 0.0;
    for one in rectangles {
        for other in rectangles {
            let rows = lag_sum([bounds(&one.rows), bounds(&other.rows)], range, power);
            let columns = lag_sum(
                [one.offsets.clone(), other.offsets.clone()].map(|o| [o.start, o.end]),
                doppler,
                power,
            );
            sum += rows * columns;
        }
    }
    let cells: usize = rectangles.iter().map(|rectangle| rectangle.cells()).sum();
    sum - cells as f64
}

fn bounds(rows: &std::ops::Range<usize>) -> [isize; 2] {
    [rows.start as isize, rows.end as isize]
}

/// Sum over pairs of numbers of two ranges of the squared correlation, by their distance, to a power.
fn lag_sum([a, b]: [[isize; 2]; 2], correlations: &[f64], power: i32) -> f64 {
    let lags = correlations.len() as isize;
    (1 - lags..lags)
        .map(|lag| {
            // Pairs i of a, i + lag of b.
            let count = (a[1].min(b[1] - lag) - a[0].max(b[0] - lag)).max(0);
            let correlation = correlations[lag.unsigned_abs()];
            count as f64 * (correlation * correlation).powi(power)
        })
        .sum()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Window;

    #[test]
    fn pairs_are_summed_as_one_by_one() {
        let noise = [
            Some(BinNoise::new(Window::Hann, 64, 1)),
            Some(BinNoise::new(Window::Blackman, 32, 2)),
        ];
        let correlations = CellCorrelations::new(noise, [6, 8]).unwrap();
        let halves = [
            vec![
                Rectangle { rows: 0..3, offsets: -5..6 },
                Rectangle { rows: 3..6, offsets: -5..-2 },
            ],
            vec![Rectangle { rows: 6..9, offsets: -5..6 }],
        ];
        let training = TrainingNoise::new(&halves, &correlations);
        let cells: Vec<(isize, isize)> = halves
            .iter()
            .flatten()
            .flat_map(|r| {
                r.rows.clone().flat_map(|row| r.offsets.clone().map(move |at| (row as isize, at)))
            })
            .collect();
        assert_eq!(training.cells.total(), cells.len());
        let along = |axis: usize, lag: isize| {
            correlations.0[axis].get(lag.unsigned_abs()).copied().unwrap_or(0.0)
        };
        for power in [1, 3] {
            let mut sum = -(cells.len() as f64);
            for a in &cells {
                for b in &cells {
                    sum += (along(0, a.0 - b.0) * along(1, a.1 - b.1)).powi(2 * power);
                }
            }
            let given = training.pairs()[power as usize - 1];
            assert!((given - sum).abs() < 1e-9 * sum, "{given} {sum}");
        }
    }

    #[test]
    fn the_mean_of_a_line_has_the_variance_of_its_cells() {
        let noise = [None, Some(BinNoise::new(Window::Hann, 64, 1))];
        let correlations = CellCorrelations::new(noise, [0, 8]).unwrap();
        let halves = [
            vec![Rectangle { rows: 0..1, offsets: -8..-2 }],
            vec![Rectangle { rows: 0..1, offsets: 3..9 }],
        ];
        let training = TrainingNoise::new(&halves, &correlations);
        let half = training.half(0, 1).shape();
        assert!((half - training.halves[0].effective).abs() < 1e-9, "{half}");
        assert!((training.mean(1).shape() - 2.0 * half).abs() < 1e-9);
        assert!((training.mean(3).shape() - 6.0 * half).abs() < 1e-9);
        assert!(half > 3.0 && half < 6.0 / 1.5);
    }
}
