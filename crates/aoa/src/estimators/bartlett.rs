//! Conventional beamforming: power of a beam steered over the grid (Bartlett 1948).

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Spectrum, SpectrumKind, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::model::covariance::CovariancePlan;
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use crate::spectra::peaks::PeakFinder;
use crate::spectra::quadratic::{QuadraticSpectrum, Towards};
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction};

/// `P(u) = a^H R a / K^2` with `K` elements; sources are its peaks.
pub(crate) struct Bartlett {
    array: Array,
    covariance: CovariancePlan,
    spectrum: QuadraticSpectrum,
    finder: PeakFinder,
    ambiguity: Option<Warning>,
}

impl Bartlett {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Bartlett, array, options)?;
        let covariance = CovariancePlan::new(Method::Bartlett, array, options)?;
        let grid = Grid::new(array, options);
        Ok(Self {
            array: array.clone(),
            finder: PeakFinder::new(covariance.array(), &grid, options),
            spectrum: QuadraticSpectrum::new(covariance.array(), &grid),
            ambiguity: ambiguity(array, options),
            covariance,
        })
    }
}

impl Plan for Bartlett {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut prepared = self.covariance.prepare(data)?;
        self.covariance.load(&mut prepared.matrix);
        let elements = self.covariance.array().len() as f64;
        let mut values = self.spectrum.evaluate(prepared.matrix.view());
        // Rounding may leave a null slightly below zero.
        values.iter_mut().for_each(|v| *v = (*v / (elements * elements)).max(0.0));
        let grid = self.spectrum.grid();
        let sources = self
            .finder
            .find(grid, &values)
            .iter()
            .map(|peak| {
                let form = prepared.matrix.view();
                let top = self.spectrum.refine(form, peak.direction, Towards::Maximum);
                Source {
                    amplitude: beam(&self.array, top.0, data),
                    ..Source::new(top.0, top.1 / (elements * elements))
                }
            })
            .collect();
        let spectrum = Spectrum {
            azimuth_rad: grid.azimuth_rad.clone(),
            elevation_rad: grid.elevation_rad.clone(),
            values,
            kind: SpectrumKind::Power,
        };
        let warnings = self.ambiguity.iter().cloned().collect();
        Ok(conclude(Method::Bartlett, sources, None, Some(spectrum), 0, warnings))
    }
}

/// What a beam steered to `direction` sees in a single snapshot: `a^H y / K`.
fn beam(array: &Array, direction: Direction, data: Data<'_>) -> Option<Complex64> {
    let Data::Snapshots(y) = data else {
        return None;
    };
    let weights = steering_vector(array, direction);
    let sum: Complex64 = weights.iter().zip(y.column(0)).map(|(a, y)| a.conj() * y).sum();
    (y.ncols() == 1).then(|| sum / array.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Axis;

    #[test]
    fn one_wave_is_found_with_its_amplitude() {
        let truth = Complex64::new(0.3, -0.4);
        for (name, at) in [
            ("lrr48", Direction::azimuth(0.3)),
            ("awr1642", Direction::azimuth(-0.7)),
            ("awr1843", Direction::new(0.25, 0.1)),
        ] {
            let array = boresight_core::presets::preset(name).unwrap();
            let y = (steering_vector(&array, at) * truth).insert_axis(Axis(1));
            let mut plan = Bartlett::new(&array, &EstimatorOptions::default()).unwrap();
            let estimate = plan.estimate(Data::Snapshots(y.view())).unwrap();
            let first = estimate.sources[0];
            assert!((first.direction.azimuth_rad - at.azimuth_rad).abs() < 1e-7, "{name}");
            assert!((first.direction.elevation_rad - at.elevation_rad).abs() < 1e-6, "{name}");
            assert!((first.power - 0.25).abs() < 1e-12);
            assert!((first.amplitude.unwrap() - truth).norm() < 1e-6);
            assert!(estimate.resolved && estimate.warnings.is_empty());
        }
    }

    #[test]
    fn silence_has_no_source() {
        let array = Array::ula(4).unwrap();
        let y = ndarray::Array2::zeros((4, 3));
        let mut plan = Bartlett::new(&array, &EstimatorOptions::default()).unwrap();
        let estimate = plan.estimate(Data::Snapshots(y.view())).unwrap();
        assert!(!estimate.resolved && estimate.sources.is_empty());
        assert_eq!(estimate.warnings, [Warning::NoSources]);
    }
}
