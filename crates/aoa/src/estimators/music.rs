//! Multiple signal classification (Schmidt 1986).

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::method::Method;
use crate::model::powers::sources_at;
use crate::model::subspace::{SubspacePlan, noise_projector};
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use crate::spectra::null_spectrum::NullSpectrum;
use boresight_core::Array;

/// Sources are where the steering vector comes closest to the signal subspace: the minima of
/// `a^H (I - E E^H) a`, found on the grid and refined by Newton steps. The pseudo-spectrum is
/// `a^H a` over that, 1 where a direction lies wholly in the noise subspace.
pub(crate) struct Music {
    array: Array,
    subspace: SubspacePlan,
    nulls: NullSpectrum,
    ambiguity: Option<Warning>,
}

impl Music {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Music, array, options)?;
        let subspace = SubspacePlan::new(Method::Music, array, options)?;
        Ok(Self {
            array: array.clone(),
            nulls: NullSpectrum::new(subspace.array(), options),
            ambiguity: ambiguity(array, options),
            subspace,
        })
    }
}

impl Plan for Music {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let basis = self.subspace.basis(data)?;
        let projector = noise_projector(&basis);
        let (spectrum, directions) = self.nulls.search(projector.view(), basis.ncols());
        let sources = sources_at(&self.array, &directions, data);
        let warnings = self.ambiguity.iter().cloned().collect();
        let expected = Some(basis.ncols());
        Ok(conclude(Method::Music, sources, expected, Some(spectrum), 0, warnings))
    }
}
