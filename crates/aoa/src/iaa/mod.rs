//! Iterative adaptive approach (Yardibi, Li, Stoica, Xue and Baggeroer 2010), with the thresholding
//! of Rowe, Li and Stoica (2013).
//!
//! A weighted least-squares estimate of the power at every point of a grid, weighted by the inverse
//! of the covariance that the powers of the last iteration imply. It works from a single snapshot
//! and on coherent sources. The grid covers all azimuths, also those outside the field of view,
//! since what is there is in the data as well.

mod adaptive;
mod dense;
mod fast;
pub(crate) mod fourier;
pub(crate) mod inverse;
mod kernel;
mod residues;

use crate::checks::{ambiguity, check_array, settle};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::normalised::{power_out, scale_of};
use crate::options::{EstimatorOptions, IaaForm, IaaOptions, IaaPrecision, Thresholding};
use crate::peaks::{Peak, PeakFinder};
use crate::plan::Plan;
use adaptive::AdaptiveKernel;
use boresight_core::{Array, Complex64, Direction};
use dense::DenseKernel;
use fast::FastKernel;
use fourier::LatticeFourier;
use kernel::Kernel;
use ndarray::ArrayView2;
use std::f64::consts::FRAC_PI_2;

/// Shares of the element power put on the diagonal of a singular covariance, one after another.
const LOADINGS: [f64; 5] = [1e-13, 1e-11, 1e-9, 1e-6, 1e-3];

/// IAA prepared for one array and grid.
pub(crate) struct Iaa {
    options: IaaOptions,
    kernel: Box<dyn Kernel>,
    grid: Grid,
    finder: PeakFinder,
    peaks: Vec<Peak>,
    ambiguity: Option<Warning>,
}

impl Iaa {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Iaa, array, options)?;
        let grid = Grid::new(array, options);
        let kernel: Box<dyn Kernel> = match (options.iaa.form, array.lattice()) {
            (IaaForm::Auto | IaaForm::Fast, Some(lattice)) => {
                let adaptive = match options.iaa.precision {
                    IaaPrecision::Auto => AdaptiveKernel::new(&lattice, grid.full_points),
                    IaaPrecision::Double => None,
                };
                match adaptive {
                    Some(adaptive) => Box::new(adaptive),
                    None => {
                        let points = grid.full_points;
                        let fourier =
                            LatticeFourier::<f64>::new(points, lattice.spacing, lattice.span());
                        Box::new(FastKernel::new(&lattice, points, fourier, 0.0))
                    }
                }
            }
            (IaaForm::Fast, None) => {
                return Err(AoaError::Array {
                    method: Method::Iaa.name(),
                    expected: "elements on a grid along y for its fast form".into(),
                    given: "stands on no such grid".into(),
                });
            }
            _ => Box::new(DenseKernel::new(array, all_directions(array, options))),
        };
        Ok(Self {
            options: options.iaa,
            kernel,
            finder: PeakFinder::new(array, &grid, options),
            peaks: Vec::new(),
            grid,
            ambiguity: ambiguity(array, options),
        })
    }

    /// Iterates on snapshots times `scale`; returns the loading that was needed, and the number of
    /// iterations done.
    fn iterate(&mut self, y: ArrayView2<Complex64>, scale: f64) -> (Option<f64>, usize) {
        self.kernel.start(y, scale);
        let mean = y.iter().map(|z| (z * scale).norm_sqr()).sum::<f64>() / y.len() as f64;
        let regularisation = self.options.regularisation * mean;
        let floor = 10f64.powf(-self.options.threshold_db / 10.0);
        let mut loaded: Option<f64> = None;
        for iteration in 0..self.options.iterations {
            if self.kernel.iterate(regularisation).is_err() {
                let element = self.kernel.element_power();
                let share = LOADINGS
                    .into_iter()
                    .find(|share| self.kernel.iterate(regularisation + share * element).is_ok());
                match share {
                    Some(share) => loaded = Some(loaded.unwrap_or(0.0).max(share)),
                    None => return (Some(loaded.unwrap_or(0.0)), iteration),
                }
            }
            self.threshold(floor);
        }
        (loaded, self.options.iterations)
    }

    fn threshold(&mut self, floor: f64) {
        if self.options.thresholding == Thresholding::None {
            return;
        }
        let mut largest = 0.0f64;
        self.kernel.map_power(&mut |p| {
            largest = largest.max(p);
            p
        });
        let least = floor * largest;
        match self.options.thresholding {
            Thresholding::None => {}
            Thresholding::Hard => {
                self.kernel.map_power(&mut |p| if p < least { 0.0 } else { p });
            }
            // At 0 dB nothing would be left; the strongest point stays.
            Thresholding::Soft => self.kernel.map_power(&mut |p| {
                let left = p - least;
                if left > 0.0 || p < largest { left.max(0.0) } else { p }
            }),
        }
    }
}

impl Plan for Iaa {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let mut estimate = Estimate::new(Method::Iaa);
        self.estimate_into(data, &mut estimate)?;
        Ok(estimate)
    }

    fn estimate_into(&mut self, data: Data<'_>, out: &mut Estimate) -> Result<(), AoaError> {
        let Data::Snapshots(y) = data else {
            return Err(AoaError::NeedsSnapshots { method: Method::Iaa.name() });
        };
        out.method = Method::Iaa;
        out.iterations = 0;
        out.warnings.clear();
        out.warnings.extend(self.ambiguity.iter().cloned());
        let spectrum = out.spectrum.get_or_insert_default();
        spectrum.azimuth_rad.clone_from(&self.grid.azimuth_rad);
        spectrum.elevation_rad.clone_from(&self.grid.elevation_rad);
        let values = &mut spectrum.values;
        values.clear();
        values.resize(self.grid.len(), 0.0);
        if let Some(largest) = scale_of(y) {
            let (loaded, iterations) = self.iterate(y, 1.0 / largest);
            out.iterations = iterations;
            out.warnings.extend(loaded.map(|share| Warning::Loaded { share }));
            if iterations < self.options.iterations {
                out.warnings.push(Warning::NotConverged { iterations });
            }
            self.crop(largest, values);
        }
        self.finder.find_into(&self.grid, values, &mut self.peaks);
        out.sources.clear();
        out.sources.extend(self.peaks.iter().map(|peak| Source {
            direction: peak.direction,
            power: top_power(&self.grid, values, peak),
            amplitude: None,
            confidence: None,
        }));
        settle(out, None);
        Ok(())
    }
}

impl Iaa {
    /// Powers inside the field of view, in the unit of the data.
    fn crop(&self, largest: f64, values: &mut [f64]) {
        let azimuths = self.grid.sines.len();
        for (row, out) in values.chunks_exact_mut(azimuths).enumerate() {
            self.kernel.power_from(row * self.grid.full_points + self.grid.first, out);
            out.iter_mut().for_each(|p| *p = power_out(*p, largest));
        }
    }
}

/// Directions over all azimuths, elevation-major.
fn all_directions(array: &Array, options: &EstimatorOptions) -> Vec<Direction> {
    let whole = EstimatorOptions { field_of_view_rad: FRAC_PI_2, ..*options };
    let whole = Grid::new(array, &whole);
    (0..whole.len()).map(|g| whole.direction(g)).collect()
}

/// Height of the parabola through the logarithms around a peak.
fn top_power(grid: &Grid, values: &[f64], peak: &Peak) -> f64 {
    let azimuths = grid.sines.len();
    let (row, column) = (peak.index / azimuths, peak.index % azimuths);
    let mut gain = 0.0;
    if column > 0 && column + 1 < azimuths {
        gain += rise(values[peak.index - 1], peak.value, values[peak.index + 1]);
    }
    if row > 0 && row + 1 < grid.elevation_rad.len() {
        gain += rise(values[peak.index - azimuths], peak.value, values[peak.index + azimuths]);
    }
    (peak.value * gain.exp()).min(f64::MAX)
}

/// How far, in natural logarithm, the top of the parabola through three values is above the middle
/// one.
fn rise(left: f64, middle: f64, right: f64) -> f64 {
    let log = |x: f64| x.clamp(f64::MIN_POSITIVE, f64::MAX).ln();
    let (l, m, r) = (log(left), log(middle), log(right));
    let bend = l - 2.0 * m + r;
    if bend < 0.0 { -(l - r) * (l - r) / (8.0 * bend) } else { 0.0 }
}

#[cfg(test)]
mod tests;
