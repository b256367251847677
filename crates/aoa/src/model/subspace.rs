//! The signal subspace of a covariance: what MUSIC, root-MUSIC, ESPRIT and min-norm share.

use crate::checks::check_sources;
use crate::data::Data;
use crate::error::AoaError;
use crate::method::Method;
use crate::model::covariance::{CovariancePlan, Prepared};
use crate::options::EstimatorOptions;
use crate::order::counting::Counting;
use boresight_core::{Array, Complex64};
use boresight_math::linalg::{adjoint, leading_hermitian_eigen_by};
use ndarray::Array2;

/// How a method gets its signal subspace.
#[derive(Debug, Clone)]
pub(crate) struct SubspacePlan {
    method: Method,
    covariance: CovariancePlan,
    sources: Counting,
    most: usize,
}

impl SubspacePlan {
    /// One dimension must remain for the noise: of `K` elements (after smoothing), at most `K - 1`
    /// sources are found.
    ///
    /// # Errors
    /// [`AoaError::TooManySources`] above that, and the errors of [`CovariancePlan::new`].
    pub fn new(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
    ) -> Result<Self, AoaError> {
        let covariance = CovariancePlan::new(method, array, options)?;
        let most = covariance.array().len() - 1;
        check_sources(method, options.sources, most)?;
        Ok(Self { method, covariance, sources: Counting::new(options), most })
    }

    /// The elements the subspace belongs to.
    pub fn array(&self) -> &Array {
        self.covariance.array()
    }

    /// Orthonormal basis of the signal subspace, elements x sources; without columns where there
    /// is no source.
    ///
    /// # Errors
    /// [`AoaError::Snapshots`] if there are fewer vectors than sources asked for, and the errors
    /// of [`CovariancePlan::prepare`].
    pub fn basis(&self, data: Data<'_>) -> Result<Array2<Complex64>, AoaError> {
        let prepared = self.covariance.prepare(data)?;
        signal_basis(self.method, &prepared, self.sources, self.most)
    }
}

/// The eigenvectors of the `sources` largest eigenvalues.
pub(crate) fn signal_basis(
    method: Method,
    prepared: &Prepared,
    sources: Counting,
    most: usize,
) -> Result<Array2<Complex64>, AoaError> {
    let elements = prepared.matrix.nrows();
    if prepared.power <= 0.0 {
        return Ok(Array2::zeros((elements, 0)));
    }
    if let Some(given) = sources.known() {
        let rank = prepared.rank();
        if given > rank {
            return Err(AoaError::Snapshots {
                method: method.name(),
                expected: format!(
                    "snapshots, averaging or smoothing for a covariance of rank {given}; \
                     its rank is {rank}"
                ),
                given: prepared.snapshots,
            });
        }
    }
    let eigen = leading_hermitian_eigen_by(prepared.matrix.view(), |values| {
        sources.resolve(values, prepared.sizes, most)
    })?;
    Ok(eigen.vectors)
}

/// `I - E E^H` for an orthonormal basis `E`.
pub(crate) fn noise_projector(basis: &Array2<Complex64>) -> Array2<Complex64> {
    let mut projector = -basis.dot(&adjoint(basis.view()));
    projector.diag_mut().mapv_inplace(|z| Complex64::new(1.0 + z.re, 0.0));
    projector
}
