//! Detection at a constant false-alarm rate (CFAR): a cell is a detection where its power exceeds
//! a multiple of the noise its training cells show, the multiple following from the probability of
//! false alarm.
//!
//! The map's cells are taken as means over `looks` channels of exponentially distributed powers
//! (square-law detection of complex normal noise, integrated without phase), for which every
//! factor is exact, at the edges too: Doppler wraps, and where the window leaves the map along
//! range the factor follows from the training cells that are left.

mod bin_noise;
mod cell_averaging;
mod excision;
mod gamma;
mod greatest_of;
mod options;
mod ordered_statistic;
mod ranks;
mod smallest_of;
mod stencil;
mod sums;
mod threshold;
mod training_cells;
mod training_noise;

use crate::error::SignalError;
pub use bin_noise::BinNoise;
use boresight_core::InputError;
use boresight_core::limits::{check_bytes, check_operations};
use boresight_math::error::check_range;
use boresight_options::{Naming, check};
use excision::LeftFactors;
pub use gamma::ln_incomplete as ln_incomplete_gamma;
use ndarray::{Array2, ArrayView2};
pub use options::{CfarAxes, CfarKind, CfarOptions};
use ranks::Ranks;
use stencil::{Rectangle, Stencil};
use sums::CumulativeSums;
pub use threshold::Factors;
use threshold::factors;
pub use training_cells::TrainingCells;
use training_noise::{CellCorrelations, TrainingNoise};

/// Most bins along an axis.
const MAX_BINS: f64 = 67_108_864.0;

/// Memory of a cell: its power, and its place in the cumulative sums; with excision also what is left of it, whether it is
/// left, and the sums of that.
const CELL_BYTES: usize = 12;
const SCREENED_CELL_BYTES: usize = 32;

/// Operations of a cell that is held against the mean of its training cells, and of one training cell where ranks are
/// counted.
const MEAN_OPERATIONS: f64 = 10.0;
const RANK_OPERATIONS: f64 = 0.25;

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

/// What a cell is held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellThreshold {
    /// Power of the cell.
    pub power: f64,
    /// Noise power around it, without the bias of the kind's statistic.
    pub noise_power: f64,
    /// The threshold: the cell is a detection above it.
    pub threshold: f64,
    /// Training cells around the cell.
    pub training_cells: usize,
    /// Of these, cells that were left out as targets.
    pub excised_cells: usize,
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
    /// For ordered statistics, that of the screen among them.
    ranks: Ranks,
    screening: Option<Screening>,
}

/// What excision needs beside.
struct Screening {
    /// Thresholds of each row's cells over their statistic.
    screens: Vec<f64>,
    /// The map without the cells that were left out, and where those are.
    left: Array2<f32>,
    gone: Array2<f32>,
    gone_sums: CumulativeSums,
    factors: LeftFactors,
}

impl Cfar {
    /// Plans detection on maps of `ranges` x `dopplers`.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for an option out of range, [`SignalError::Window`] where the
    /// window is larger than the map, [`InputError::TooLarge`] above the limits of the thread
    /// ([`boresight_core::limits`]).
    pub fn new(ranges: usize, dopplers: usize, options: &CfarOptions) -> Result<Self, SignalError> {
        check(options, Naming::Rust)?;
        check_range("looks", options.looks as f64, 1.0, 1024.0)?;
        check_range("range bins", ranges as f64, 1.0, MAX_BINS)?;
        check_range("Doppler bins", dopplers as f64, 1.0, MAX_BINS)?;
        let excises = options.kind == CfarKind::Excision;
        let ordered = options.kind == CfarKind::OrderedStatistic;
        let bytes = if excises { SCREENED_CELL_BYTES } else { CELL_BYTES };
        let map = check_bytes("the range-Doppler map", &[ranges, dopplers], bytes)?;
        let stencil = Stencil::new(ranges, dopplers, options)?;
        let reach = stencil.doppler_reach();
        let correlations = CellCorrelations::new(options.noise, stencil.reach())?;
        let noise = |row| TrainingNoise::new(&stencil.halves(row), &correlations);
        let screens = if excises {
            of_rows(ranges, &stencil, |row| excision::screen(options, &noise(row)))
        } else {
            vec![]
        };
        let mut rows = of_rows(ranges, &stencil, |row| factors(options, &noise(row)));
        for ((_, factors), (_, screen)) in rows.iter_mut().zip(&screens) {
            factors.bias = screen.bias;
            factors.threshold /= screen.bias;
        }
        let fullest = (0..ranges).max_by_key(|&row| rows[row].0.total()).unwrap_or(0);
        let ranks = RANK_OPERATIONS * rows[fullest].0.total() as f64;
        let each = match options.kind {
            CfarKind::OrderedStatistic => ranks,
            CfarKind::Excision => ranks + 2.0 * MEAN_OPERATIONS,
            _ => MEAN_OPERATIONS,
        };
        check_operations("the detection", map as f64 * each)?;
        let screening = excises.then(|| Screening {
            screens: screens.iter().map(|(_, screen)| screen.threshold).collect(),
            left: Array2::zeros((ranges, dopplers)),
            gone: Array2::zeros((ranges, dopplers)),
            gone_sums: CumulativeSums::new(ranges, dopplers, reach),
            factors: LeftFactors::new(options, noise(fullest)),
        });
        Ok(Self {
            kind: options.kind,
            rank: options.rank,
            shape: (ranges, dopplers),
            rows,
            sums: CumulativeSums::new(if ordered { 0 } else { ranges }, dopplers, reach),
            ranks: Ranks::new(if ordered || excises { ranges } else { 0 }, dopplers, reach),
            screening,
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
    /// [`InputError::Shape`] if the map has another shape than planned, [`InputError::NotFinite`] or
    /// [`InputError::OutOfRange`] if it holds NaN, infinity or a negative power.
    pub fn detect(&mut self, power: ArrayView2<f32>) -> Result<Vec<Detection>, SignalError> {
        check_power(power, self.shape)?;
        let mut detections = Vec::new();
        let keep = |range_bin, doppler_bin, cell: CellThreshold| {
            let CellThreshold { power, noise_power, threshold, .. } = cell;
            if power > threshold {
                detections.push(Detection {
                    range_bin,
                    doppler_bin,
                    power,
                    noise_power,
                    threshold,
                });
            }
        };
        if self.kind == CfarKind::OrderedStatistic {
            self.by_rank(power, keep);
        } else {
            self.by_mean(power, keep);
        }
        Ok(detections)
    }

    /// What each range bin is held against at one Doppler bin of `power`.
    ///
    /// # Errors
    /// As [`Cfar::detect`]; [`InputError::OutOfRange`] for a bin outside the map.
    pub fn thresholds(
        &mut self,
        power: ArrayView2<f32>,
        doppler_bin: usize,
    ) -> Result<Vec<CellThreshold>, SignalError> {
        check_power(power, self.shape)?;
        check_range("Doppler bin", doppler_bin as f64, 0.0, self.shape.1 as f64 - 1.0)?;
        if self.kind == CfarKind::OrderedStatistic {
            self.ranks.fill(power);
            let rows = power.outer_iter().enumerate();
            return Ok(rows
                .map(|(r, row)| self.ranked(r, doppler_bin, row[doppler_bin]))
                .collect());
        }
        let mut cells = Vec::with_capacity(self.shape.0);
        self.by_mean(power, |_, at, cell| {
            if at == doppler_bin {
                cells.push(cell);
            }
        });
        Ok(cells)
    }

    /// Hands every cell with what it is held against to `each`.
    fn by_mean(
        &mut self,
        power: ArrayView2<f32>,
        mut each: impl FnMut(usize, usize, CellThreshold),
    ) {
        let excised = self.excise(power);
        if !excised {
            self.sums.fill(power);
        }
        let dopplers = self.shape.1;
        let mut totals = [vec![0.0; dopplers], vec![0.0; dopplers]];
        let mut gone = vec![0.0; dopplers];
        for (range_bin, row) in power.outer_iter().enumerate() {
            let (cells, factors) = self.rows[range_bin];
            let halves = self.stencil.halves(range_bin);
            gone.fill(0.0);
            for (half, totals) in halves.iter().zip(&mut totals) {
                totals.fill(0.0);
                for rectangle in half {
                    self.sums.add(rectangle, totals);
                    if let (true, Some(screening)) = (excised, &self.screening) {
                        screening.gone_sums.add(rectangle, &mut gone);
                    }
                }
            }
            let [before, after] = [cells.before, cells.after].map(|n| 1.0 / n.max(1) as f64);
            let all = 1.0 / cells.total() as f64;
            let one_sided = cells.before == 0 || cells.after == 0;
            let kind = self.kind;
            let statistic = |b: f64, a: f64| match kind {
                CfarKind::GreatestOf if !one_sided => (b * before).max(a * after),
                CfarKind::SmallestOf if !one_sided => (b * before).min(a * after),
                _ => (b + a) * all,
            };
            for (doppler_bin, &power) in row.iter().enumerate() {
                let (b, a) = (totals[0][doppler_bin], totals[1][doppler_bin]);
                let excised_cells = gone[doppler_bin] as usize;
                let (noise_power, threshold) = if excised_cells == 0 {
                    let statistic = statistic(b, a).max(0.0);
                    (statistic / factors.bias, factors.threshold * statistic)
                } else {
                    let sum = (b + a).max(0.0);
                    self.without(&halves, [range_bin, doppler_bin], cells, excised_cells, sum)
                };
                let power = f64::from(power);
                let training_cells = cells.total();
                let cell =
                    CellThreshold { power, noise_power, threshold, training_cells, excised_cells };
                each(range_bin, doppler_bin, cell);
            }
        }
    }

    /// Noise power and threshold of a cell some of whose training cells are gone; `sum` is the power of the others.
    fn without(
        &mut self,
        halves: &[Vec<Rectangle>; 2],
        [range_bin, doppler_bin]: [usize; 2],
        cells: TrainingCells,
        gone: usize,
        sum: f64,
    ) -> (f64, f64) {
        let Some(screening) = &mut self.screening else { return (0.0, 0.0) };
        let left = cells.total().saturating_sub(gone);
        if left == 0 {
            let factors = screening.factors.of_rank();
            let statistic = self.ranks.nth(halves, doppler_bin, excision::screen_rank(cells));
            return (statistic / factors.bias, factors.threshold * statistic);
        }
        let noise_power = sum / left as f64 / self.rows[range_bin].1.bias;
        (noise_power, screening.factors.of_mean(left) * noise_power)
    }

    /// Screens the map: cumulative sums of what is left, and of where something is gone. Whether anything is.
    fn excise(&mut self, power: ArrayView2<f32>) -> bool {
        let Some(screening) = &mut self.screening else { return false };
        let Screening { screens, left, gone, gone_sums, .. } = screening;
        self.ranks.fill(power);
        left.assign(&power);
        gone.fill(0.0);
        let mut any = false;
        for (range_bin, row) in power.outer_iter().enumerate() {
            let rank = excision::screen_rank(self.rows[range_bin].0) as u32;
            let halves = self.stencil.halves(range_bin);
            let below = self.ranks.below(&halves, row, screens[range_bin]);
            let places = left.row_mut(range_bin).into_iter().zip(gone.row_mut(range_bin));
            for (&below, (left, gone)) in below.iter().zip(places) {
                if below >= rank {
                    (*left, *gone) = (0.0, 1.0);
                    any = true;
                }
            }
        }
        if any {
            self.sums.fill(left.view());
            gone_sums.fill(gone.view());
        }
        any
    }

    /// Hands the cells over their threshold with it to `each`.
    fn by_rank(
        &mut self,
        power: ArrayView2<f32>,
        mut each: impl FnMut(usize, usize, CellThreshold),
    ) {
        self.ranks.fill(power);
        let mut over = Vec::new();
        for (range_bin, row) in power.outer_iter().enumerate() {
            let (cells, factors) = self.rows[range_bin];
            let rank = ordered_statistic::rank_of(self.rank, cells.total());
            let halves = self.stencil.halves(range_bin);
            let below = self.ranks.below(&halves, row, factors.threshold);
            over.clear();
            over.extend((0..below.len()).filter(|&at| below[at] as usize >= rank));
            for &doppler_bin in &over {
                each(range_bin, doppler_bin, self.ranked(range_bin, doppler_bin, row[doppler_bin]));
            }
        }
    }

    /// What a cell is held against by rank.
    fn ranked(&mut self, range_bin: usize, doppler_bin: usize, power: f32) -> CellThreshold {
        let (cells, factors) = self.rows[range_bin];
        let rank = ordered_statistic::rank_of(self.rank, cells.total());
        let statistic = self.ranks.nth(&self.stencil.halves(range_bin), doppler_bin, rank);
        CellThreshold {
            power: f64::from(power),
            noise_power: statistic / factors.bias,
            threshold: factors.threshold * statistic,
            training_cells: cells.total(),
            excised_cells: 0,
        }
    }
}

/// Training cells of each row with what follows from the row. Rows with equal training cells share that.
fn of_rows<T: Copy>(
    ranges: usize,
    stencil: &Stencil,
    follows: impl Fn(usize) -> T,
) -> Vec<(TrainingCells, T)> {
    let mut known: Vec<(TrainingCells, T)> = Vec::new();
    (0..ranges)
        .map(|row| {
            let cells = stencil.training(row);
            // The two halves are alike, so that an edge and its mirror share it as well.
            let mirrored = TrainingCells { before: cells.after, after: cells.before };
            if let Some((_, same)) = known.iter().find(|(c, _)| *c == cells || *c == mirrored) {
                return (cells, *same);
            }
            let new = follows(row);
            known.push((cells, new));
            (cells, new)
        })
        .collect()
}

fn check_power(power: ArrayView2<f32>, shape: (usize, usize)) -> Result<(), SignalError> {
    if power.dim() != shape {
        return Err(SignalError::Argument(InputError::Shape {
            what: "power map".into(),
            expected: format!("[{}, {}]", shape.0, shape.1),
            given: power.shape().to_vec(),
        }));
    }
    // One pass that vectorises; which cell it was is looked up only when there is one.
    if power.iter().all(|p| (0.0..=f32::MAX).contains(p)) {
        return Ok(());
    }
    boresight_math::error::check_finite("power map", power.iter().map(|&p| f64::from(p)))?;
    let given = power.iter().copied().fold(0.0, f32::min);
    Err(SignalError::Argument(InputError::OutOfRange {
        what: "power map".into(),
        expected: "powers of at least 0".into(),
        given: given.into(),
    }))
}
