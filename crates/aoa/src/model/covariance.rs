//! From data to the covariance a method works on: averaging, smoothing, loading.

use crate::data::Data;
use crate::error::AoaError;
use crate::method::Method;
use crate::options::EstimatorOptions;
use crate::order::counting::CountSizes;
use crate::suits::too_few;
use boresight_core::{Array, Complex64, InputError};
use boresight_math::error::check_range;
use boresight_signal::{SignalError, forward_backward, load_diagonal, sample_covariance};
use ndarray::Array2;

/// Largest mean element power; leaves room for what a fit of close directions makes of it.
const MAX_POWER: f64 = 1e280;

/// How a method gets its covariance, as `options` ask.
#[derive(Debug, Clone)]
pub(crate) struct CovariancePlan {
    method: Method,
    array: Array,
    subarrays: usize,
    forward_backward: bool,
    loading: f64,
}

/// A covariance ready for an estimator.
#[derive(Debug, Clone)]
pub(crate) struct Prepared {
    /// Hermitian, of the size of [`CovariancePlan::array`], without loading.
    pub matrix: Array2<Complex64>,
    /// What the eigenvalues are worth when sources are counted.
    pub sizes: CountSizes,
    /// Snapshots it was made from.
    pub snapshots: usize,
    /// Mean element power.
    pub power: f64,
}

impl Prepared {
    /// Takes a Hermitian matrix and checks that its powers can be worked with.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] if they are not.
    pub fn new(
        matrix: Array2<Complex64>,
        sizes: CountSizes,
        snapshots: usize,
    ) -> Result<Self, AoaError> {
        let power = matrix.diag().iter().map(|z| z.re).sum::<f64>() / matrix.nrows() as f64;
        if power.is_nan() || power > MAX_POWER {
            return Err(AoaError::Argument(InputError::OutOfRange {
                what: "mean element power".into(),
                expected: format!("at most {MAX_POWER:e}"),
                given: power,
            }));
        }
        Ok(Self { matrix, sizes, snapshots, power })
    }

    /// The most its rank can be with that many vectors.
    pub fn rank(&self) -> usize {
        let copies = if self.sizes.forward_backward { 2 } else { 1 };
        self.sizes.vectors.saturating_mul(copies).min(self.matrix.nrows())
    }
}

impl CovariancePlan {
    /// Checks forward-backward averaging and smoothing against the array.
    pub fn new(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, AoaError> {
        let averaged = options.forward_backward || options.smoothing.is_some();
        if averaged && !array.is_uniform() {
            return Err(AoaError::Array {
                method: method.name(),
                expected: "evenly spaced elements for averaging or smoothing".into(),
                given: "is not evenly spaced".into(),
            });
        }
        let length = options.smoothing.unwrap_or(array.len());
        check_range("smoothing", length as f64, 1.0, array.len() as f64)?;
        let part: Vec<usize> = (0..length).collect();
        Ok(Self {
            method,
            array: array.select(&part)?,
            subarrays: array.len() - length + 1,
            forward_backward: options.forward_backward,
            loading: options.loading,
        })
    }

    /// The elements the covariance belongs to: the first subarray under smoothing, else all.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// The covariance of `data`.
    ///
    /// # Errors
    /// [`AoaError::Snapshots`] if there are too few for the method, [`InputError::OutOfRange`] if
    /// the powers overflow.
    pub fn prepare(&self, data: Data<'_>) -> Result<Prepared, AoaError> {
        let snapshots = data.snapshots();
        let least = self.method.requirements().min_snapshots;
        let vectors = snapshots.saturating_mul(self.subarrays);
        if too_few(self.method, snapshots, self.subarrays, self.forward_backward) {
            return Err(AoaError::Snapshots {
                method: self.method.name(),
                expected: format!("at least {least} snapshots, averaging or smoothing"),
                given: snapshots,
            });
        }
        let mut matrix = match data {
            Data::Snapshots(y) => sample_covariance(y),
            Data::Covariance { matrix, .. } => {
                let reversed = boresight_math::linalg::adjoint(matrix);
                (reversed + matrix).mapv(|z| z * 0.5)
            }
        };
        if self.forward_backward {
            matrix = forward_backward(matrix.view());
        }
        if self.subarrays > 1 {
            matrix = boresight_signal::spatial_smoothing(matrix.view(), self.array.len()).map_err(
                |error| match error {
                    SignalError::Argument(error) => AoaError::Argument(error),
                    other => AoaError::Argument(InputError::Shape {
                        what: other.to_string(),
                        expected: "a covariance that can be smoothed".into(),
                        given: vec![self.array.len()],
                    }),
                },
            )?;
        }
        let sizes = CountSizes {
            vectors,
            subarrays: self.subarrays,
            forward_backward: self.forward_backward,
        };
        Prepared::new(matrix, sizes, snapshots)
    }

    /// Whether loading was asked for.
    pub fn loads(&self) -> bool {
        self.loading > 0.0
    }

    /// Adds the loading asked for.
    pub fn load(&self, matrix: &mut Array2<Complex64>) {
        if self.loading > 0.0 {
            load_diagonal(matrix, self.loading);
        }
    }
}
