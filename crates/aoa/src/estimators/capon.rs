//! Capon's minimum-variance beamformer (1969).

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Spectrum, SpectrumKind, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::model::covariance::{CovariancePlan, Prepared};
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use crate::spectra::peaks::PeakFinder;
use crate::spectra::quadratic::{QuadraticSpectrum, Towards};
use boresight_core::{Array, Complex64};
use boresight_math::linalg::Cholesky;
use boresight_signal::load_diagonal;
use ndarray::Array2;

/// Loading where there are fewer vectors than elements, as a share of the mean element power:
/// about the noise at 20 dB.
const LOAD_FEW: f64 = 1e-2;

/// Loading where there is no noise to make the covariance regular.
const LOAD_SINGULAR: f64 = 1e-9;

/// `P(u) = 1 / (a^H R^-1 a)`; sources are its peaks, their powers its heights.
pub(crate) struct Capon {
    covariance: CovariancePlan,
    spectrum: QuadraticSpectrum,
    finder: PeakFinder,
    ambiguity: Option<Warning>,
}

impl Capon {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Capon, array, options)?;
        let covariance = CovariancePlan::new(Method::Capon, array, options)?;
        let grid = Grid::new(array, options);
        Ok(Self {
            finder: PeakFinder::new(covariance.array(), &grid, options),
            spectrum: QuadraticSpectrum::new(covariance.array(), &grid),
            ambiguity: ambiguity(array, options),
            covariance,
        })
    }

    /// The inverse of the covariance, loaded as asked for and as far as it takes to have one, and
    /// the share loaded beyond what was asked for.
    fn inverse(&self, prepared: &Prepared) -> Result<(Array2<Complex64>, f64), AoaError> {
        let mut matrix = prepared.matrix.clone();
        self.covariance.load(&mut matrix);
        let mut share = 0.0;
        if prepared.rank() < matrix.nrows() && !self.covariance.loads() {
            share = LOAD_FEW;
            load_diagonal(&mut matrix, share);
        }
        loop {
            match Cholesky::new(matrix.view()) {
                Ok(factor) if is_regular(&factor) => return Ok((factor.inverse(), share)),
                Err(error) if share > 1.0 => return Err(error.into()),
                _ => {
                    let more = (10.0 * share).max(LOAD_SINGULAR);
                    load_diagonal(&mut matrix, more);
                    share += more;
                }
            }
        }
    }
}

/// Whether the pivots leave some digits to the inverse.
fn is_regular(factor: &Cholesky) -> bool {
    let largest = factor.diagonal().fold(0.0, f64::max);
    factor.diagonal().all(|pivot| pivot > 1e-6 * largest)
}

impl Plan for Capon {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let prepared = self.covariance.prepare(data)?;
        let mut warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        let (mut values, mut sources) = (vec![0.0; self.spectrum.grid().len()], Vec::new());
        if prepared.power > 0.0 {
            let (inverse, share) = self.inverse(&prepared)?;
            if share > 0.0 {
                warnings.push(Warning::Loaded { share });
            }
            values = self.spectrum.evaluate(inverse.view());
            values.iter_mut().for_each(|v| *v = 1.0 / v.max(f64::MIN_POSITIVE));
            for peak in self.finder.find(self.spectrum.grid(), &values) {
                let form = inverse.view();
                let (direction, value) =
                    self.spectrum.refine(form, peak.direction, Towards::Minimum);
                sources.push(Source::new(direction, 1.0 / value));
            }
        }
        let grid = self.spectrum.grid();
        let spectrum = Spectrum {
            azimuth_rad: grid.azimuth_rad.clone(),
            elevation_rad: grid.elevation_rad.clone(),
            values,
            kind: SpectrumKind::Power,
        };
        Ok(conclude(Method::Capon, sources, None, Some(spectrum), 0, warnings))
    }
}
