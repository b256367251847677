//! What an estimator works on.

use crate::error::AoaError;
use boresight_core::{Complex64, InputError};
use boresight_math::error::check_finite;
use ndarray::{ArrayView, ArrayView2, Dimension};

/// Measurements of one cell.
#[derive(Debug, Clone, Copy)]
pub enum Data<'a> {
    /// Elements x snapshots.
    Snapshots(ArrayView2<'a, Complex64>),
    /// A Hermitian sample covariance, elements x elements, and the number of snapshots in it.
    Covariance {
        /// The matrix.
        matrix: ArrayView2<'a, Complex64>,
        /// Snapshots averaged.
        snapshots: usize,
    },
}

impl Data<'_> {
    /// Number of snapshots.
    pub fn snapshots(&self) -> usize {
        match self {
            Self::Snapshots(y) => y.ncols(),
            Self::Covariance { snapshots, .. } => *snapshots,
        }
    }

    /// Checks that the data has one row an element, is not empty, finite and, for a covariance,
    /// Hermitian to 1e-6 of its largest entry with a real, non-negative diagonal.
    ///
    /// # Errors
    /// [`InputError::Shape`], [`InputError::Empty`], [`InputError::NotFinite`],
    /// [`InputError::OutOfRange`].
    pub fn check(&self, elements: usize) -> Result<(), AoaError> {
        match self {
            Self::Snapshots(y) => {
                if y.ncols() == 0 {
                    return Err(empty("snapshots"));
                }
                if y.nrows() != elements {
                    return Err(shape("snapshots", format!("[{elements}, snapshots]"), *y));
                }
                check_all_finite("snapshots", *y)?;
            }
            Self::Covariance { matrix, snapshots } => {
                if *snapshots == 0 {
                    return Err(empty("snapshots in the covariance"));
                }
                if matrix.dim() != (elements, elements) {
                    let expected = format!("[{elements}, {elements}]");
                    return Err(shape("covariance", expected, *matrix));
                }
                check_all_finite("covariance", *matrix)?;
                let scale = matrix.iter().map(|z| z.norm()).fold(0.0, f64::max);
                let skew = matrix
                    .indexed_iter()
                    .map(|((i, k), z)| (z - matrix[[k, i]].conj()).norm())
                    .fold(0.0, f64::max);
                let lowest = matrix.diag().iter().map(|z| z.re).fold(0.0, f64::min);
                let refused = |what: &str, expected: &str, given: f64| {
                    let (what, expected) = (what.into(), expected.into());
                    Err(AoaError::Argument(InputError::OutOfRange { what, expected, given }))
                };
                if skew > 1e-6 * scale {
                    let expected = "at most 1e-6 of its largest entry, as of a Hermitian matrix";
                    return refused("asymmetry of the covariance", expected, skew);
                }
                if lowest < 0.0 {
                    return refused("diagonal of the covariance", "powers of at least 0", lowest);
                }
            }
        }
        Ok(())
    }
}

/// Data weaker than this is silence: its powers could not be told from zero.
pub(crate) const SILENCE: f64 = 1e-150;

impl Data<'_> {
    /// Refuses data that is not zero and whose powers vanish in double precision.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`].
    pub(crate) fn check_not_vanishing(&self) -> Result<(), AoaError> {
        let (what, largest, least) = match self {
            Self::Snapshots(y) => {
                let parts = y.iter().flat_map(|z| [z.re.abs(), z.im.abs()]);
                ("largest part of the snapshots", parts.fold(0.0, f64::max), SILENCE)
            }
            Self::Covariance { matrix, .. } => {
                let powers = matrix.diag().into_iter().map(|z| z.re);
                ("largest power of the covariance", powers.fold(0.0, f64::max), f64::MIN_POSITIVE)
            }
        };
        if largest > 0.0 && largest <= least {
            return Err(AoaError::Argument(InputError::OutOfRange {
                what: what.into(),
                expected: format!(
                    "0 or more than {least:e}, below which powers cannot be computed"
                ),
                given: largest,
            }));
        }
        Ok(())
    }
}

/// Looks at everything at once and, only if something is amiss, for the first offender.
pub(crate) fn check_all_finite<D: Dimension>(
    what: &str,
    data: ArrayView<Complex64, D>,
) -> Result<(), InputError> {
    let sound = |z: &Complex64| z.re.is_finite() & z.im.is_finite();
    if let Some(numbers) = data.as_slice()
        && numbers.iter().fold(true, |all, z| all & sound(z))
    {
        return Ok(());
    }
    check_finite(what, data.iter().flat_map(|z| [z.re, z.im]))
}

fn empty(what: &str) -> AoaError {
    InputError::Empty { what: what.into(), expected: "at least one".into() }.into()
}

fn shape(what: &str, expected: String, given: ArrayView2<Complex64>) -> AoaError {
    InputError::Shape { what: what.into(), expected, given: given.shape().to_vec() }.into()
}
