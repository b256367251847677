//! The minimum-norm method (Kumaresan and Tufts 1983).

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::method::Method;
use crate::model::powers::sources_at;
use crate::model::subspace::SubspacePlan;
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use crate::spectra::null_spectrum::NullSpectrum;
use boresight_core::{Array, Complex64};
use ndarray::{Array1, Array2, Axis};

/// Sources are the nulls of `|a^H w|^2`, `w` being the shortest vector of the noise subspace whose
/// entry at a reference element is 1. The pseudo-spectrum is `a^H a` over that.
pub(crate) struct MinNorm {
    array: Array,
    subspace: SubspacePlan,
    nulls: NullSpectrum,
    ambiguity: Option<Warning>,
}

impl MinNorm {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::MinNorm, array, options)?;
        let subspace = SubspacePlan::new(Method::MinNorm, array, options)?;
        Ok(Self {
            array: array.clone(),
            nulls: NullSpectrum::new(subspace.array(), options),
            ambiguity: ambiguity(array, options),
            subspace,
        })
    }
}

impl Plan for MinNorm {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let basis = self.subspace.basis(data)?;
        let vector = shortest_noise_vector(&basis).insert_axis(Axis(1));
        let form = vector.dot(&boresight_math::linalg::adjoint(vector.view()));
        let (spectrum, directions) = self.nulls.search(form.view(), basis.ncols());
        let sources = sources_at(&self.array, &directions, data);
        let warnings = self.ambiguity.iter().cloned().collect();
        let expected = Some(basis.ncols());
        Ok(conclude(Method::MinNorm, sources, expected, Some(spectrum), 0, warnings))
    }
}

/// `(e - E E^H e) / (1 - |E^H e|^2)` with `e` the unit vector of the reference element: the first,
/// unless it lies in the signal subspace, in which case the one that does so least.
fn shortest_noise_vector(basis: &Array2<Complex64>) -> Array1<Complex64> {
    let share = |k: usize| basis.row(k).iter().map(|z| z.norm_sqr()).sum::<f64>();
    let mut reference = 0;
    if share(0) > 1.0 - 1e-9 {
        let least = (0..basis.nrows()).min_by(|&a, &b| share(a).total_cmp(&share(b)));
        reference = least.unwrap_or(0);
    }
    let row = basis.row(reference).mapv(|z| z.conj());
    let mut vector = -basis.dot(&row);
    vector[reference] += 1.0;
    let scale = 1.0 / (1.0 - share(reference)).max(f64::EPSILON);
    vector.mapv(|z| z * scale)
}
