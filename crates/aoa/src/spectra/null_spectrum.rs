//! Pseudo-spectra whose peaks are the nulls of a Hermitian form: MUSIC and its relatives.

use crate::estimate::{Spectrum, SpectrumKind};
use crate::grid::Grid;
use crate::options::EstimatorOptions;
use crate::spectra::peaks::PeakFinder;
use crate::spectra::quadratic::{QuadraticSpectrum, Towards};
use boresight_core::{Array, Complex64, Direction};
use ndarray::ArrayView2;

/// Searches the grid for nulls of `a^H Q a` and refines them on the form itself.
pub(crate) struct NullSpectrum {
    spectrum: QuadraticSpectrum,
    finder: PeakFinder,
    elements: f64,
}

impl NullSpectrum {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Self {
        let grid = Grid::new(array, options);
        Self {
            finder: PeakFinder::new(array, &grid, options),
            spectrum: QuadraticSpectrum::new(array, &grid),
            elements: array.len() as f64,
        }
    }

    /// The pseudo-spectrum `a^H a / a^H Q a` and the directions of its `count` highest peaks.
    pub fn search(
        &mut self,
        form: ArrayView2<Complex64>,
        count: usize,
    ) -> (Spectrum, Vec<Direction>) {
        let mut values = self.spectrum.evaluate(form);
        // At a perfect null only rounding is left of the form.
        let least = 1e-15 * self.elements;
        values.iter_mut().for_each(|v| *v = self.elements / v.max(least));
        let grid = self.spectrum.grid();
        let directions = self
            .finder
            .highest(grid, &values, count)
            .iter()
            .map(|peak| self.spectrum.refine(form, peak.direction, Towards::Minimum).0)
            .collect();
        let spectrum = Spectrum {
            azimuth_rad: grid.azimuth_rad.clone(),
            elevation_rad: grid.elevation_rad.clone(),
            values,
            kind: SpectrumKind::Pseudo,
        };
        (spectrum, directions)
    }
}
