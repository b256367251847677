//! MUSIC on the Hankel matrix of a single snapshot of a uniform array (Liao and Fannjiang 2016).

use crate::checks::{ambiguity, check_array, check_sources, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::method::Method;
use crate::model::covariance::Prepared;
use crate::model::powers::sources_at;
use crate::model::subspace::{noise_projector, signal_basis};
use crate::options::EstimatorOptions;
use crate::order::counting::CountSizes;
use crate::order::counting::Counting;
use crate::plan::Plan;
use crate::spectra::null_spectrum::NullSpectrum;
use boresight_core::{Array, Complex64};
use boresight_math::error::check_range;
use boresight_signal::{forward_backward, sample_covariance};
use ndarray::{Array2, ArrayView1};

/// The windows of `L` neighbouring elements of `K` are the columns of a Hankel matrix whose
/// column space is spanned by the sources' steering vectors of length `L`. `L` is half the array
/// and one more, or [`EstimatorOptions::smoothing`]; at most `min(L - 1, K - L + 1)` sources are found,
/// `min(L - 1, 2 (K - L + 1))` with forward-backward averaging.
pub(crate) struct SingleSnapshotMusic {
    array: Array,
    nulls: NullSpectrum,
    sources: Counting,
    length: usize,
    most: usize,
    forward_backward: bool,
    ambiguity: Option<Warning>,
}

impl SingleSnapshotMusic {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        let method = Method::SingleSnapshotMusic;
        check_array(method, array, options)?;
        let elements = array.len();
        let length = options.smoothing.unwrap_or(elements / 2 + 1);
        check_range("smoothing", length as f64, 2.0, elements as f64)?;
        let windows = (elements - length + 1) * if options.forward_backward { 2 } else { 1 };
        let most = windows.min(length - 1);
        check_sources(method, options.sources, most)?;
        let part: Vec<usize> = (0..length).collect();
        Ok(Self {
            array: array.clone(),
            nulls: NullSpectrum::new(&array.select(&part)?, options),
            sources: Counting::new(options),
            length,
            most,
            forward_backward: options.forward_backward,
            ambiguity: ambiguity(array, options),
        })
    }

    fn prepare(&self, snapshot: ArrayView1<Complex64>) -> Result<Prepared, AoaError> {
        let windows = snapshot.len() - self.length + 1;
        let hankel = Array2::from_shape_fn((self.length, windows), |(i, k)| snapshot[i + k]);
        let mut matrix = sample_covariance(hankel.view());
        if self.forward_backward {
            matrix = forward_backward(matrix.view());
        }
        let sizes = CountSizes {
            vectors: windows,
            subarrays: windows,
            forward_backward: self.forward_backward,
        };
        Prepared::new(matrix, sizes, 1)
    }
}

impl Plan for SingleSnapshotMusic {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let method = Method::SingleSnapshotMusic;
        let Data::Snapshots(y) = data else {
            return Err(AoaError::NeedsSnapshots { method: method.name() });
        };
        if y.ncols() != 1 {
            return Err(AoaError::Snapshots {
                method: method.name(),
                expected: "one snapshot".into(),
                given: y.ncols(),
            });
        }
        let prepared = self.prepare(y.column(0))?;
        let basis = signal_basis(method, &prepared, self.sources, self.most)?;
        let projector = noise_projector(&basis);
        let (spectrum, directions) = self.nulls.search(projector.view(), basis.ncols());
        let sources = sources_at(&self.array, &directions, data);
        let warnings = self.ambiguity.iter().cloned().collect();
        Ok(conclude(method, sources, Some(basis.ncols()), Some(spectrum), 0, warnings))
    }
}
