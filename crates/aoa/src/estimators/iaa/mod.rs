//! Iterative adaptive approach (Yardibi, Li, Stoica, Xue and Baggeroer 2010), with the thresholding
//! of Rowe, Li and Stoica (2013).
//!
//! A weighted least-squares estimate of the power at every point of a grid, weighted by the inverse
//! of the covariance that the powers of the last iteration imply. It works from a single snapshot
//! and on coherent sources. The grid covers all azimuths, also those outside the field of view,
//! since what is there is in the data as well. Directions of sources are between the points of the grid,
//! and their powers are fitted there ([`peak_powers`]).
//!
//! Coincident elements of the array are averaged first: what they differ by is noise, which no plane wave explains
//! ([`crate::model::coincident`]).
//!
//! Thresholding makes the spectrum sparse. After each iteration, with `t` the threshold below the strongest,
//! `P -> P` where `P >= t max P`, else 0 (hard), or `P -> max(P - t max P, 0)` (soft). Without its weak part
//! the spectrum would imply a covariance of low rank and no noise, which nothing inverts to use. So what is taken away
//! counts as white noise in the next iteration, `R = A P A^H + v I` with `v` by how much the sum of powers fell; the
//! powers of the elements stay what they were. That is ours, as is the threshold relative to the strongest power.

mod adaptive;
mod dense;
mod fast;
pub(crate) mod fourier;
pub(crate) mod inverse;
mod kernel;
mod peak_powers;
mod residues;
mod split;

use crate::checks::{ambiguity, check_array, settle};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::model::coincident::Coincident;
use crate::model::normalised::{power_out, scale_of};
use crate::options::{EstimatorOptions, IaaForm, IaaOptions, IaaPrecision, Thresholding};
use crate::plan::Plan;
use crate::spectra::peaks::{Peak, PeakFinder};
use adaptive::AdaptiveKernel;
use boresight_core::{Array, Complex64, Direction};
use dense::DenseKernel;
use fast::FastKernel;
use fourier::LatticeFourier;
use kernel::Kernel;
use ndarray::ArrayView2;
use peak_powers::PeakPowers;
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
    /// Powers over the whole grid.
    whole: Vec<f64>,
    /// Of the peaks.
    powers: Vec<f64>,
    fit: PeakPowers,
    /// What the last threshold took off the element power.
    removed: f64,
    ambiguity: Option<Warning>,
    /// Where the array has coincident elements.
    coincident: Option<Coincident>,
}

impl Iaa {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Iaa, array, options)?;
        let coincident = Coincident::new(array)?;
        let array = coincident.as_ref().map_or(array, Coincident::array);
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
            whole: vec![0.0; grid.full_points * grid.elevation_rad.len()],
            powers: Vec::new(),
            fit: PeakPowers::new(array, &grid),
            removed: 0.0,
            grid,
            ambiguity: ambiguity(array, options),
            coincident,
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
        self.removed = 0.0;
        for iteration in 0..self.options.iterations {
            if self.kernel.iterate(regularisation + self.removed).is_err() {
                let element = self.kernel.element_power();
                let share = LOADINGS.into_iter().find(|share| {
                    let loading = regularisation + self.removed + share * element;
                    self.kernel.iterate(loading).is_ok()
                });
                match share {
                    Some(share) => loaded = Some(loaded.unwrap_or(0.0).max(share)),
                    None => return (Some(loaded.unwrap_or(0.0)), iteration),
                }
            }
            self.removed = self.threshold(floor);
        }
        (loaded, self.options.iterations)
    }

    /// Applies the threshold, a share of the largest power, and returns by how much the powers' sum falls.
    fn threshold(&mut self, floor: f64) -> f64 {
        if self.options.thresholding == Thresholding::None {
            return 0.0;
        }
        let before = self.kernel.element_power();
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
        (before - self.kernel.element_power()).max(0.0)
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
        out.sources.clear();
        let mut coincident = self.coincident.take();
        let y = coincident.as_mut().map_or(y, |coincident| coincident.average(y));
        if let Some(largest) = scale_of(y) {
            let (loaded, iterations) = self.iterate(y, 1.0 / largest);
            out.iterations = iterations;
            out.warnings.extend(loaded.map(|share| Warning::Loaded { share }));
            if iterations < self.options.iterations {
                out.warnings.push(Warning::NotConverged { iterations });
            }
            self.find(y, 1.0 / largest, values);
            let found = self.peaks.iter().zip(&self.powers);
            out.sources.extend(
                found.map(|(peak, &power)| Source::new(peak.direction, power_out(power, largest))),
            );
            values.iter_mut().for_each(|p| *p = power_out(*p, largest));
        }
        self.coincident = coincident;
        settle(out, None);
        Ok(())
    }
}

impl Iaa {
    /// The spectrum inside the field of view, its peaks and their powers, of the snapshots times `scale`.
    fn find(&mut self, y: ArrayView2<Complex64>, scale: f64, values: &mut [f64]) {
        let Self { grid, finder, peaks, whole, powers, fit, .. } = self;
        self.kernel.power_from(0, whole);
        let rows = whole.chunks_exact(grid.full_points);
        for (row, inside) in rows.zip(values.chunks_exact_mut(grid.sines.len())) {
            inside.copy_from_slice(&row[grid.first..grid.first + inside.len()]);
        }
        finder.find_into(grid, values, peaks);
        powers.clear();
        powers.extend(peaks.iter().map(|peak| peak.value));
        fit.fit(y, scale, whole, self.removed, peaks, powers);
    }
}

/// Directions over all azimuths, elevation-major.
fn all_directions(array: &Array, options: &EstimatorOptions) -> Vec<Direction> {
    let whole = EstimatorOptions { field_of_view_rad: FRAC_PI_2, ..*options };
    let whole = Grid::new(array, &whole);
    (0..whole.len()).map(|g| whole.direction(g)).collect()
}

#[cfg(test)]
mod tests;
