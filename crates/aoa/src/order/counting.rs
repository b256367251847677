//! Counting sources by the eigenvalues of the covariance: by the largest-root test (Kritchman and Nadler 2009), or by
//! information criteria (Wax and Kailath 1985), which need many more vectors than elements.

use crate::cost;
use crate::data::Data;
use crate::error::AoaError;
use crate::options::{EstimatorOptions, SourceCount, mismatch_of};
use crate::order::largest_root::{Freedom, level};
use boresight_core::limits::check_operations;
use boresight_math::linalg::hermitian_eigen;
use boresight_options::{Described, Naming, check};
use boresight_signal::{forward_backward, sample_covariance};
use serde::{Deserialize, Serialize};

/// How sources are counted by eigenvalues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Test by test whether the largest eigenvalue left is more than noise makes, at a false-alarm probability. Valid from
    /// two vectors on.
    #[default]
    LargestRoot,
    /// Akaike's information criterion: `2 L(k) + 2 p(k)`. Counts too many, with few vectors by far.
    Aic,
    /// Rissanen's and Schwarz's minimum description length: `L(k) + p(k) ln(N) / 2`. Consistent, but counts far too many
    /// where there are about as many vectors as elements.
    Mdl,
}

/// How sources are counted.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct CountOptions {
    /// How sources are counted.
    pub criterion: Criterion,
    /// Probability that the largest-root test takes noise for a source.
    #[option(default = 1e-2, range = 1e-12..=0.5)]
    pub false_alarm: f64,
    /// Average the covariance with its reversal, for evenly spaced arrays.
    pub forward_backward: bool,
    /// Power of the array's unknown error over that of each source: further eigenvalues that it explains are no
    /// sources. None if absent.
    #[option(range = -100..=0)]
    pub mismatch_db: Option<f64>,
}

/// What the eigenvalues come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CountSizes {
    /// Vectors averaged: snapshots, times subarrays under spatial smoothing. Backward copies are
    /// not counted, since they are no new data.
    pub vectors: usize,
    /// Subarrays of spatial smoothing, which overlap; 1 without.
    pub subarrays: usize,
    /// Whether the covariance was averaged with its reversal. It then is determined by real
    /// numbers only, and `k` sources have `k (2 K - k + 1) / 2` free parameters in place of
    /// `k (2 K - k)` (Xu, Pierre and Kaveh 1994).
    pub forward_backward: bool,
}

/// Outcome of a count.
#[derive(Debug, Clone, PartialEq)]
pub struct Count {
    /// Number of sources, without those that an array error explains.
    pub sources: usize,
    /// For 0, 1, 2, ... sources: an information criterion, which is smallest at their number, or the largest eigenvalue
    /// left over the level of the largest-root test, which is not above 1 from there on. Empty where nothing can be tested.
    pub values: Vec<f64>,
}

/// Overlapping subarrays count as independent vectors times their number to this power, at which white noise
/// exceeds the level about as often as stated (4 to 44 subarrays of 5 to 43 elements, by simulation).
const OVERLAP: f64 = -0.2;
/// Eigenvalues this far below the largest are rounding errors.
const ROUNDING: f64 = 1e-12;

impl CountSizes {
    /// What noise in the eigenvalues that `sources` leave has of freedom.
    fn freedom(self, dimension: usize, sources: usize) -> Freedom {
        let overlapping = self.subarrays.clamp(1, dimension.max(1)) as f64;
        let vectors = self.vectors as f64 * overlapping.powf(OVERLAP);
        // Of real vectors, of which there are twice as many, a source takes one.
        let taken = if self.forward_backward { 0.5 } else { 1.0 } * sources as f64;
        Freedom { vectors: vectors - taken, forward_backward: self.forward_backward }
    }
}

/// Counts sources by the largest-root test from the eigenvalues of a covariance, largest first: the number of
/// sources from which on no eigenvalue is larger than noise makes with probability `false_alarm`.
///
/// Several sources of equal power hide each other, since none holds most of the power, so that the tests go on beyond the
/// first that finds nothing. Those share half the probability of a false alarm.
fn count_by_largest_root(eigenvalues: &[f64], sizes: CountSizes, false_alarm: f64) -> Count {
    let largest = eigenvalues.first().copied().unwrap_or(0.0);
    let mut values = Vec::new();
    if largest.is_nan() || largest <= 0.0 {
        return Count { sources: 0, values };
    }
    let dimension = eigenvalues.len();
    let mut left: f64 = eigenvalues.iter().map(|value| (value / largest).max(0.0)).sum();
    let mut probability = false_alarm;
    for (sources, value) in eigenvalues.iter().map(|value| value / largest).enumerate() {
        let level = level(dimension - sources, sizes.freedom(dimension, sources), probability);
        let Some(level) = level.filter(|_| value > ROUNDING) else { break };
        let ratio = value / (left * level);
        values.push(ratio);
        left -= value;
        if ratio <= 1.0 {
            probability = 0.5 * false_alarm / dimension as f64;
        }
    }
    let sources = values.iter().rposition(|ratio| *ratio > 1.0).map_or(0, |last| last + 1);
    Count { sources, values }
}

/// Counts sources from the eigenvalues of a covariance, largest first, by an information criterion.
///
/// With `K` eigenvalues `l`, `N` vectors and `k` sources, `L(k) = N (K - k) ln(A / G)` where `A`
/// and `G` are arithmetic and geometric mean of the `K - k` smallest. With fewer vectors than
/// elements the covariance has rank `N` and only the `N` largest eigenvalues are judged. Rounding
/// errors of data without noise are levelled at 1e-12 of the largest eigenvalue. No eigenvalue,
/// or none above zero, makes no source.
fn count_by_information(eigenvalues: &[f64], sizes: CountSizes, penalty: Penalty) -> Count {
    let largest = eigenvalues.first().copied().unwrap_or(0.0);
    let judged = eigenvalues.len().min(sizes.vectors);
    if largest.is_nan() || largest <= 0.0 || judged == 0 {
        return Count { sources: 0, values: vec![0.0] };
    }
    let logs: Vec<f64> =
        eigenvalues[..judged].iter().map(|l| (l / largest).max(ROUNDING).ln()).collect();
    let n = sizes.vectors as f64;
    let mut values = vec![0.0; judged];
    let (mut sum, mut log_sum) = (0.0, 0.0);
    for k in (0..judged).rev() {
        sum += logs[k].exp();
        log_sum += logs[k];
        let left = (judged - k) as f64;
        let misfit = n * (left * (sum / left).ln() - log_sum);
        let sources = k as f64;
        let parameters = if sizes.forward_backward {
            0.5 * sources * (2.0 * judged as f64 - sources + 1.0)
        } else {
            sources * (2.0 * judged as f64 - sources)
        };
        values[k] = match penalty {
            Penalty::Aic => 2.0 * (misfit + parameters),
            Penalty::Mdl => misfit + 0.5 * parameters * n.ln(),
        };
    }
    let sources = (0..judged).min_by(|&i, &k| values[i].total_cmp(&values[k])).unwrap_or(0);
    Count { sources, values }
}

/// Of the number of free parameters.
#[derive(Debug, Clone, Copy)]
enum Penalty {
    Aic,
    Mdl,
}

/// Counts sources from the eigenvalues of a covariance, largest first; `false_alarm` is that of the largest-root test.
pub fn count_sources(
    eigenvalues: &[f64],
    sizes: CountSizes,
    criterion: Criterion,
    false_alarm: f64,
) -> Count {
    match criterion {
        Criterion::LargestRoot => count_by_largest_root(eigenvalues, sizes, false_alarm),
        Criterion::Aic => count_by_information(eigenvalues, sizes, Penalty::Aic),
        Criterion::Mdl => count_by_information(eigenvalues, sizes, Penalty::Mdl),
    }
}

/// Most sources that an array error of power `mismatch` over that of each source leaves: no eigenvalue (largest first)
/// counts as a source that is no more over the smallest one than the error of those before it.
///
/// The error of one source alone keeps the covariance of rank one. What averages copies of it that the error changes
/// differently gives it further eigenvalues: averaging with the reversal, smoothing, channels that drift. Their sum is at
/// most `mismatch` times the source's own eigenvalue.
pub fn most_by_mismatch(eigenvalues: &[f64], mismatch: f64) -> usize {
    let Some(smallest) = eigenvalues.last().map(|last| last.max(0.0)) else { return 0 };
    let mut before = 0.0;
    let explained = |&eigenvalue: &f64| {
        let is_explained = before > 0.0 && eigenvalue - smallest <= mismatch * before;
        before += eigenvalue.max(0.0);
        is_explained
    };
    if mismatch > 0.0 {
        eigenvalues.iter().position(explained).unwrap_or(eigenvalues.len())
    } else {
        eigenvalues.len()
    }
}

/// Eigenvalues of the covariance of `data`, largest first, and what the criterion makes of them.
/// Averaging with the reversal is for arrays that are evenly spaced.
///
/// # Errors
/// As [`Data::check`]; [`AoaError::Snapshots`] for a single vector, in which no criterion can tell sources from noise;
/// [`boresight_core::InputError::OutOfRange`] for an option out of range;
/// [`boresight_core::InputError::TooLarge`] for what takes more than the limits of this thread.
pub fn count_sources_in(
    data: Data<'_>,
    options: &CountOptions,
) -> Result<(Vec<f64>, Count), AoaError> {
    check(options, Naming::Rust)?;
    let CountOptions { criterion, false_alarm, forward_backward: average_reversed, mismatch_db } =
        *options;
    let elements = match data {
        Data::Snapshots(y) => y.nrows(),
        Data::Covariance { matrix, .. } => matrix.nrows(),
    };
    check_operations("the count of sources", cost::eigenvalues(elements, data.snapshots()))?;
    let mut covariance = match data {
        Data::Snapshots(y) => {
            data.check(y.nrows())?;
            sample_covariance(y)
        }
        Data::Covariance { matrix, .. } => {
            data.check(matrix.nrows())?;
            matrix.to_owned()
        }
    };
    if average_reversed {
        covariance = forward_backward(covariance.view());
    }
    let eigenvalues = hermitian_eigen(covariance.view())?.values.to_vec();
    let (vectors, subarrays) = (data.snapshots(), 1);
    if vectors < 2 && !average_reversed {
        return Err(AoaError::Snapshots {
            method: "counting by eigenvalues",
            expected: "at least 2 snapshots, or averaging with the reversal".into(),
            given: vectors,
        });
    }
    let sizes = CountSizes { vectors, subarrays, forward_backward: average_reversed };
    let mut count = count_sources(&eigenvalues, sizes, criterion, false_alarm);
    count.sources = count.sources.min(most_by_mismatch(&eigenvalues, mismatch_of(mismatch_db)));
    Ok((eigenvalues, count))
}

/// How a plan comes to its number of sources.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counting {
    wanted: SourceCount,
    false_alarm: f64,
    mismatch: f64,
}

impl Counting {
    pub fn new(options: &EstimatorOptions) -> Self {
        let false_alarm = options.nomp.false_alarm;
        Self { wanted: options.sources, false_alarm, mismatch: options.mismatch() }
    }

    /// The number that is known.
    pub fn known(self) -> Option<usize> {
        match self.wanted {
            SourceCount::Known(sources) => Some(sources),
            _ => None,
        }
    }

    /// Whether the way of counting is up to the method.
    pub fn is_auto(self) -> bool {
        self.wanted == SourceCount::Auto
    }

    /// The number for these eigenvalues (largest first), at most `most`.
    pub fn resolve(self, eigenvalues: &[f64], sizes: CountSizes, most: usize) -> usize {
        let count = |criterion| {
            let count = count_sources(eigenvalues, sizes, criterion, self.false_alarm).sources;
            count.min(most_by_mismatch(eigenvalues, self.mismatch)).min(most)
        };
        match self.wanted {
            SourceCount::Known(sources) => sources.min(most),
            SourceCount::Auto => count(Criterion::LargestRoot),
            SourceCount::Aic => count(Criterion::Aic),
            SourceCount::Mdl => count(Criterion::Mdl),
            // No plan is made with it.
            SourceCount::Network => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: CountSizes = CountSizes { vectors: 100, subarrays: 1, forward_backward: false };

    fn count_sources(eigenvalues: &[f64], sizes: CountSizes, criterion: Criterion) -> Count {
        super::count_sources(eigenvalues, sizes, criterion, 1e-2)
    }

    #[test]
    fn agrees_with_the_formula_worked_by_hand() {
        let count = count_sources(&[4.0, 1.0], SIZES, Criterion::Mdl);
        let misfit = 100.0 * (2.0 * 2.5f64.ln() - 4.0f64.ln());
        assert!((count.values[0] - misfit).abs() < 1e-9);
        assert!((count.values[1] - 0.5 * 3.0 * 100f64.ln()).abs() < 1e-9);
        assert_eq!(count.sources, 1);
        let count = count_sources(&[4.0, 1.0], SIZES, Criterion::Aic);
        assert!((count.values[0] - 2.0 * misfit).abs() < 1e-9);
        assert!((count.values[1] - 6.0).abs() < 1e-9);
    }

    #[test]
    fn noise_free_eigenvalues_count_the_rank() {
        let values = [5.0, 2.0, 3e-16, 1e-17, -2e-16];
        assert_eq!(count_sources(&values, SIZES, Criterion::Mdl).sources, 2);
        assert_eq!(count_sources(&values, SIZES, Criterion::Aic).sources, 2);
        assert_eq!(count_sources(&values, SIZES, Criterion::LargestRoot).sources, 2);
    }

    #[test]
    fn hopeless_input_counts_nothing() {
        for values in [&[][..], &[0.0, 0.0], &[f64::NAN, 1.0], &[1.0, 1.0, 1.0]] {
            assert_eq!(count_sources(values, SIZES, Criterion::Aic).sources, 0, "{values:?}");
        }
        let single = CountSizes { vectors: 1, ..SIZES };
        assert!(count_sources(&[3.0, 0.0], single, Criterion::LargestRoot).values.is_empty());
        assert_eq!(count_sources(&[3.0, 0.0], single, Criterion::Mdl).sources, 0);
    }

    #[test]
    fn an_array_error_explains_what_is_below_it() {
        let most = |values: &[f64]| most_by_mismatch(values, 0.01);
        assert_eq!(most(&[100.0, 0.9, 0.1, 0.1]), 1);
        assert_eq!(most(&[100.0, 2.0, 0.1, 0.1]), 2);
        assert_eq!(most(&[100.0, 90.0, 1.9, 0.1]), 2);
        // Two of equal power, and noise: neither hides the other.
        assert_eq!(most(&[5.0, 5.0, 1.0]), 2);
        assert_eq!(most(&[0.0, 0.0]), 2);
        assert_eq!(most(&[]), 0);
        assert_eq!(most_by_mismatch(&[100.0, 0.0], 0.0), 2);
    }
}
