//! Detection at a constant false-alarm rate (CFAR): a cell is a detection where its power exceeds
//! a multiple of the noise its training cells show, the multiple following from the probability of
//! false alarm.
//!
//! The map's cells are taken as means over `looks` channels of exponentially distributed powers
//! (square-law detection of complex normal noise, integrated without phase), for which every
//! factor is exact, at the edges too: Doppler wraps, and where the window leaves the map along
//! range the factor follows from the training cells that are left.

mod cell_averaging;
mod gamma;
mod greatest_of;
mod ordered_statistic;
mod smallest_of;
mod stencil;
mod sums;
mod threshold;

use crate::error::SignalError;
use boresight_core::CoreError;
use boresight_core::describe::{self, Described, Naming};
use boresight_core::error::check_range;
use boresight_core::limits::{check_bytes, check_operations};
use ndarray::{Array2, ArrayView2};
use serde::{Deserialize, Serialize};
use stencil::{Rectangle, Stencil};
use sums::CumulativeSums;
use threshold::factors;
pub use threshold::{Factors, TrainingCells};

/// Most bins along an axis.
const MAX_BINS: f64 = 67_108_864.0;

/// Memory of a cell: its power, and its place in the cumulative sums.
const CELL_BYTES: usize = 12;

/// Operations of a cell that is held against the mean of its training cells, and of one training cell where ranks are
/// counted.
const MEAN_OPERATIONS: f64 = 10.0;
const RANK_OPERATIONS: f64 = 0.25;

/// How noise is estimated from the training cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CfarKind {
    /// The mean of all (Finn and Johnson 1968): the least loss in even noise.
    #[default]
    CellAveraging,
    /// The larger of the means of the halves (Hansen and Sawyers 1980): keeps the rate at clutter
    /// edges.
    GreatestOf,
    /// The smaller of the means of the halves (Trunk 1978): keeps targets apart.
    SmallestOf,
    /// The cell of a rank (Rohling 1983): keeps targets apart and most of the rate.
    OrderedStatistic,
}

/// Along which axes training cells lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CfarAxes {
    /// Range only: in a scene that stands still all power lies at zero Doppler, and a window across
    /// it would see no noise like the cell's own.
    #[default]
    Range,
    /// Doppler only.
    Doppler,
    /// A ring around the cell in both.
    Both,
}

/// How detection works.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct CfarOptions {
    /// The detector of constant false-alarm rate: how it takes the noise from the training cells.
    pub kind: CfarKind,
    /// Axes along which training cells lie.
    pub axes: CfarAxes,
    /// Probability that a cell of noise becomes a detection.
    #[option(default = 1e-6, range = 1e-15..=0.5)]
    pub false_alarm: f64,
    /// Cells left out on each side of the cell under test, along range and Doppler, so that they
    /// cover the main lobe.
    #[option(default = [4, 2])]
    pub guard_cells: [usize; 2],
    /// Cells on each side beyond the guard cells that the noise level is estimated from, along range
    /// and Doppler.
    #[option(default = [8, 4])]
    pub training_cells: [usize; 2],
    /// Which of the ordered training cells stands for the noise, as a share of them.
    #[option(default = 0.75, range = 0..=1)]
    pub rank: f64,
    /// Channels averaged in each cell.
    #[option(default = 1)]
    #[serde(skip)]
    pub looks: usize,
    /// Neighbouring cells that count as one independent cell, along range and Doppler: 1 without
    /// window and padding, else [`crate::RangeDoppler::cell_correlation`].
    #[option(default = [1.0; 2])]
    #[serde(skip)]
    pub correlation: [f64; 2],
}

/// A cell above its threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// Power of the cell.
    pub power: f64,
    /// Noise power around it, without the bias of the kind's statistic. Zero in a map without
    /// noise.
    pub noise_power: f64,
    /// The threshold it exceeds.
    pub threshold: f64,
}

/// A plan for maps of one shape. It keeps its thresholds and scratch space.
pub struct Cfar {
    kind: CfarKind,
    /// Of the ordered statistic, as a share of the training cells.
    rank: f64,
    shape: (usize, usize),
    stencil: Stencil,
    /// Training cells and factors of each row.
    rows: Vec<(TrainingCells, Factors)>,
    sums: CumulativeSums,
    /// The map with its Doppler bins repeated on both sides, for ordered statistics.
    wrapped: Array2<f32>,
}

impl Cfar {
    /// Plans detection on maps of `ranges` x `dopplers`.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`] for an option out of range, [`SignalError::Window`] where the
    /// window is larger than the map, [`CoreError::TooLarge`] above the limits of the thread
    /// ([`boresight_core::limits`]).
    pub fn new(ranges: usize, dopplers: usize, options: &CfarOptions) -> Result<Self, SignalError> {
        describe::check(options, Naming::Rust)?;
        check_range("looks", options.looks as f64, 1.0, 1024.0)?;
        for (what, correlation) in
            ["range correlation", "Doppler correlation"].into_iter().zip(options.correlation)
        {
            check_range(what, correlation, 1.0, 1e3)?;
        }
        check_range("range bins", ranges as f64, 1.0, MAX_BINS)?;
        check_range("Doppler bins", dopplers as f64, 1.0, MAX_BINS)?;
        let map = check_bytes("the range-Doppler map", &[ranges, dopplers], CELL_BYTES)?;
        let stencil = Stencil::new(ranges, dopplers, options)?;
        let reach = stencil.doppler_reach();
        let ordered = matches!(options.kind, CfarKind::OrderedStatistic);
        let rows = row_factors(ranges, &stencil, options);
        let training = rows.iter().map(|(cells, _)| cells.total()).max().unwrap_or(0) as f64;
        let each = if ordered { RANK_OPERATIONS * training } else { MEAN_OPERATIONS };
        check_operations("the detection", map as f64 * each)?;
        Ok(Self {
            kind: options.kind,
            rank: options.rank,
            shape: (ranges, dopplers),
            rows,
            sums: CumulativeSums::new(if ordered { 0 } else { ranges }, dopplers, reach),
            wrapped: Array2::zeros((if ordered { ranges } else { 0 }, dopplers + 2 * reach)),
            stencil,
        })
    }

    /// Training cells and factors of each range bin.
    pub fn rows(&self) -> &[(TrainingCells, Factors)] {
        &self.rows
    }

    /// All cells of `power` (range x Doppler, linear) above their threshold, in the order of range
    /// and Doppler bins.
    ///
    /// # Errors
    /// [`CoreError::Shape`] if the map has another shape than planned, [`CoreError::NotFinite`] or
    /// [`CoreError::OutOfRange`] if it holds NaN, infinity or a negative power.
    pub fn detect(&mut self, power: ArrayView2<f32>) -> Result<Vec<Detection>, SignalError> {
        check_power(power, self.shape)?;
        let mut detections = Vec::new();
        if self.kind == CfarKind::OrderedStatistic {
            self.detect_by_rank(power, self.rank, &mut detections);
        } else {
            self.detect_by_mean(power, &mut detections);
        }
        Ok(detections)
    }

    fn detect_by_mean(&mut self, power: ArrayView2<f32>, detections: &mut Vec<Detection>) {
        self.sums.fill(power);
        let mut totals = [vec![0.0; self.shape.1], vec![0.0; self.shape.1]];
        for (range_bin, row) in power.outer_iter().enumerate() {
            let (cells, factors) = self.rows[range_bin];
            for (half, totals) in self.stencil.halves(range_bin).iter().zip(&mut totals) {
                totals.fill(0.0);
                for rectangle in half {
                    self.sums.add(rectangle, totals);
                }
            }
            let [before, after] = [cells.before, cells.after].map(|n| 1.0 / n.max(1) as f64);
            let all = 1.0 / cells.total() as f64;
            let one_sided = cells.before == 0 || cells.after == 0;
            let statistic = |b: f64, a: f64| match self.kind {
                CfarKind::GreatestOf if !one_sided => (b * before).max(a * after),
                CfarKind::SmallestOf if !one_sided => (b * before).min(a * after),
                _ => (b + a) * all,
            };
            let halves = totals[0].iter().zip(&totals[1]);
            for (doppler_bin, (&power, (&b, &a))) in row.iter().zip(halves).enumerate() {
                let power = f64::from(power);
                let statistic = statistic(b, a).max(0.0);
                let threshold = factors.threshold * statistic;
                if power > threshold {
                    let noise_power = statistic / factors.bias;
                    detections.push(Detection {
                        range_bin,
                        doppler_bin,
                        power,
                        noise_power,
                        threshold,
                    });
                }
            }
        }
    }

    /// A cell exceeds `factor` times the training cell of rank `k` exactly where at least `k`
    /// training cells lie below the cell over `factor`; counting needs no sorting.
    fn detect_by_rank(
        &mut self,
        power: ArrayView2<f32>,
        share: f64,
        detections: &mut Vec<Detection>,
    ) {
        let reach = self.stencil.doppler_reach();
        let dopplers = self.shape.1;
        for (row, mut wrapped) in power.outer_iter().zip(self.wrapped.outer_iter_mut()) {
            for (column, value) in wrapped.iter_mut().enumerate() {
                *value = row[(column + dopplers - reach) % dopplers];
            }
        }
        let mut limits = vec![0.0_f32; dopplers];
        let mut counts = vec![0_u32; dopplers];
        let mut training = Vec::new();
        for (range_bin, row) in power.outer_iter().enumerate() {
            let (cells, factors) = self.rows[range_bin];
            let rank = ordered_statistic::rank_of(share, cells.total());
            let inverse = (1.0 / factors.threshold) as f32;
            limits.iter_mut().zip(row).for_each(|(limit, &p)| *limit = p * inverse);
            counts.fill(0);
            let halves = self.stencil.halves(range_bin);
            for (r, column) in training_columns(&halves, reach) {
                let row = self.wrapped.row(r);
                let row = row.as_slice().unwrap_or(&[]);
                for ((count, limit), value) in
                    counts.iter_mut().zip(&limits).zip(&row[column..column + dopplers])
                {
                    *count += u32::from(value < limit);
                }
            }
            for (doppler_bin, &count) in counts.iter().enumerate() {
                if (count as usize) < rank {
                    continue;
                }
                training.clear();
                training.extend(
                    training_columns(&halves, reach)
                        .map(|(r, c)| self.wrapped[[r, c + doppler_bin]]),
                );
                let (_, statistic, _) = training.select_nth_unstable_by(rank - 1, f32::total_cmp);
                let statistic = f64::from(*statistic);
                detections.push(Detection {
                    range_bin,
                    doppler_bin,
                    power: f64::from(row[doppler_bin]),
                    noise_power: statistic / factors.bias,
                    threshold: factors.threshold * statistic,
                });
            }
        }
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

/// Rows with equal training cells share their factors.
fn row_factors(
    ranges: usize,
    stencil: &Stencil,
    options: &CfarOptions,
) -> Vec<(TrainingCells, Factors)> {
    let correlation = match options.axes {
        CfarAxes::Range => options.correlation[0],
        CfarAxes::Doppler => options.correlation[1],
        CfarAxes::Both => options.correlation[0] * options.correlation[1],
    };
    let mut known: Vec<(TrainingCells, Factors)> = Vec::new();
    (0..ranges)
        .map(|row| {
            let cells = stencil.training(row);
            // The two halves are alike, so that an edge and its mirror share factors as well.
            let mirrored = TrainingCells { before: cells.after, after: cells.before };
            if let Some((_, factors)) = known.iter().find(|(c, _)| *c == cells || *c == mirrored) {
                return (cells, *factors);
            }
            let new = factors(options, cells, correlation);
            known.push((cells, new));
            (cells, new)
        })
        .collect()
}

fn check_power(power: ArrayView2<f32>, shape: (usize, usize)) -> Result<(), SignalError> {
    if power.dim() != shape {
        return Err(SignalError::Argument(CoreError::Shape {
            what: "power map".into(),
            expected: format!("[{}, {}]", shape.0, shape.1),
            given: power.shape().to_vec(),
        }));
    }
    // One pass that vectorises; which cell it was is looked up only when there is one.
    if power.iter().all(|p| (0.0..=f32::MAX).contains(p)) {
        return Ok(());
    }
    boresight_core::error::check_finite("power map", power.iter().map(|&p| f64::from(p)))?;
    let given = power.iter().copied().fold(0.0, f32::min);
    Err(SignalError::Argument(CoreError::OutOfRange {
        what: "power map".into(),
        expected: "powers of at least 0".into(),
        given: given.into(),
    }))
}
