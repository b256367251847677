//! Joint maximum likelihood of range and azimuth in a region of the range spectrum.
//!
//! A target occupies a few range bins, all elements and all chirps. Estimators that use the region's
//! covariance sum over all bins, most of which contain only noise, and discard range. This estimator
//! fits the region itself: the response of a target is the product of the transform's response along
//! range and the steering vector, with an independent complex amplitude in every chirp. A grid
//! search (alternating projection, Ziskind and Wax 1988) places each target, and Gauss-Newton steps
//! refine all targets jointly.

mod atoms;
mod refine;
mod search;

use crate::error::AoaError;
use crate::estimate::Warning;
use crate::options::{EstimatorOptions, SourceCount};
use crate::order::false_alarm::{Shares, Volumes};
use atoms::Atoms;
use boresight_core::{Array, Complex32, Complex64, Extent, InputError};
use boresight_math::order::sort_descending;
use ndarray::{Array3, ArrayView3};
use refine::{Fit, Model, Refined};
use search::{Search, Seen};

/// Name in messages.
const NAME: &str = "joint range-angle estimation";
/// Most targets of a region.
pub const MAX_TARGETS: usize = 8;
/// Most places of the grid times chirps.
const MAX_CELLS: usize = 4_000_000;
/// Maximum number of relocation rounds; a few suffice.
const MAX_ROUNDS: usize = 10;
/// Minimum relative decrease of the residual for a relocated target to be accepted.
const SETTLED: f64 = 1e-9;
/// Minimum fraction of a response's power that must remain after projecting out the other targets.
const LEAST_LEFT: f64 = 1e-3;
/// Fraction of the power below which the residual is rounding error.
const EXHAUSTED: f64 = 1e-12;

/// Range and sine of the azimuth of a target.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    /// Range bins from the first of the region.
    bin: f64,
    sine: f64,
}

/// A target of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeAngleTarget {
    /// Range bins from the first of the region.
    pub bin: f64,
    /// Azimuth, rad.
    pub azimuth_rad: f64,
    /// Power of one raw sample at one element, mean over the chirps.
    pub power: f64,
    /// Standard deviation of `bin` (Cramer-Rao bound at the estimated noise power), or `None` if the
    /// data do not determine the range.
    pub bin_deviation: Option<f64>,
    /// Standard deviation of the azimuth, rad, or `None` if undetermined.
    pub azimuth_deviation_rad: Option<f64>,
}

/// Result for one region.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeAngleEstimate {
    /// Targets, strongest first.
    pub targets: Vec<RangeAngleTarget>,
    /// Noise power per range bin and element, estimated from the residual.
    pub noise_power: f64,
    /// [`Warning::NotConverged`] if the Gauss-Newton iteration reached its limit.
    pub warnings: Vec<Warning>,
}

/// Joint range-angle estimator for one array and region size.
pub struct RangeAngle {
    atoms: Atoms,
    search: Search,
    shares: Shares,
    /// Threshold for gains caused by unknown array errors, as a fraction of the explained power.
    mismatch: f64,
    options: EstimatorOptions,
    most: usize,
}

impl RangeAngle {
    /// Prepares for regions of `bins` range bins from a `samples`-point transform without window or zero padding, on a
    /// linear array. Uses the options `sources` ([`SourceCount::Known`] or [`SourceCount::Auto`]), `field_of_view_rad`,
    /// `max_iterations`, `tolerance`, `mismatch_db` and `nomp.false_alarm`.
    ///
    /// # Errors
    /// [`AoaError::Array`] for an array with an extent in elevation, [`AoaError::TooManySources`] for more than
    /// [`MAX_TARGETS`], [`InputError::OutOfRange`] for other options out of range and for regions larger than the
    /// transform, [`InputError::Incompatible`] for another way to count.
    pub fn new(
        array: &Array,
        samples: usize,
        bins: usize,
        options: &EstimatorOptions,
    ) -> Result<Self, AoaError> {
        options.check()?;
        boresight_math::error::check_range("region bins", bins as f64, 1.0, samples as f64)?;
        if array.extent() == Extent::Area {
            return Err(AoaError::Array {
                method: NAME,
                expected: "elements along a line".into(),
                given: "has elements above one another".into(),
            });
        }
        let most = match options.sources {
            SourceCount::Known(sources) if sources > MAX_TARGETS => {
                return Err(AoaError::TooManySources {
                    method: NAME,
                    most: MAX_TARGETS,
                    given: sources,
                });
            }
            SourceCount::Known(sources) => sources,
            SourceCount::Auto => MAX_TARGETS,
            other => {
                return Err(AoaError::Argument(InputError::Incompatible {
                    what: "sources of joint range-angle estimation".into(),
                    expected: "a number or auto".into(),
                    given: format!("{other:?}"),
                }));
            }
        };
        let along = array.positions().iter().map(|p| p[1]);
        let mean = along.clone().sum::<f64>() / array.len() as f64;
        let atoms = Atoms { samples, bins, positions: along.map(|y| y - mean).collect() };
        let widest = options.field_of_view_rad.sin();
        let search = Search::new(&atoms, widest);
        let spread = atoms.positions.iter().map(|p| p * p).sum::<f64>() / array.len() as f64;
        let sides = [
            2.0 * widest * (spread * std::f64::consts::PI.powi(2)).sqrt(),
            (bins - 1) as f64 * atoms::range_spread(samples).sqrt(),
        ];
        let volumes = Volumes::of_rectangle(sides);
        // Element errors are equal in all bins and chirps: a single noise vector along the array.
        let mismatch = options.mismatch()
            * Volumes::of_rectangle([sides[0], 0.0]).level(options.nomp.false_alarm, 1)
            / array.len() as f64;
        let shares = Shares::of(volumes, bins * array.len(), 2, options.nomp.false_alarm);
        Ok(Self { atoms, search, shares, mismatch, options: *options, most })
    }

    /// Estimates the targets of a region of bins x elements x chirps, as returned by
    /// [`boresight_signal::region::crop_region`]. Bins that are entirely zero are treated as missing.
    ///
    /// # Errors
    /// [`InputError::Shape`] for another shape than planned or no chirps, [`InputError::NotFinite`] for values that are
    /// not finite, [`InputError::OutOfRange`] for more chirps than fit in memory.
    pub fn estimate(
        &mut self,
        region: ArrayView3<'_, Complex32>,
    ) -> Result<RangeAngleEstimate, AoaError> {
        let data = self.checked(region)?;
        let (_, elements, chirps) = data.dim();
        let held: Vec<bool> =
            data.outer_iter().map(|bin| bin.iter().any(|z| z.norm_sqr() > 0.0)).collect();
        let power: f64 = data.iter().map(|z| z.norm_sqr()).sum();
        let values = held.iter().filter(|held| **held).count() * elements;
        let mut found = Refined { fit: Fit::of_nothing(power), iterations: 0, converged: true };
        if power > f64::MIN_POSITIVE {
            let view = data.view();
            let seen = self.search.see(&view, &held);
            let widest = self.options.field_of_view_rad.sin();
            let model = Model { atoms: &self.atoms, data: view, held: &held, power, widest };
            self.shares.set_elements(values);
            while found.fit.places.len() < self.most && found.fit.residual > EXHAUSTED * power {
                let Some(next) = self.add(&seen, &model, &found.fit.places) else { break };
                if self.options.sources == SourceCount::Auto {
                    let left = found.fit.residual;
                    let share = self.shares.after(found.fit.places.len(), chirps);
                    let gain = left - next.fit.residual;
                    let by_mismatch = self.mismatch * (power - left);
                    let is_noise = share.is_none_or(|share| gain <= share * left + by_mismatch);
                    let noise_power = self.noise_power(&next.fit, values, chirps);
                    if is_noise || !next.fit.is_determined(noise_power, model.limits()) {
                        break;
                    }
                }
                found = next;
            }
        }
        let noise_power = self.noise_power(&found.fit, values, chirps);
        Ok(RangeAngleEstimate {
            targets: told(&found.fit, noise_power),
            noise_power,
            warnings: (!found.converged)
                .then_some(Warning::NotConverged { iterations: found.iterations })
                .into_iter()
                .collect(),
        })
    }

    /// Residual noise power of a fit to `values` bins and elements. Each target has one complex amplitude per chirp and
    /// two real parameters.
    fn noise_power(&self, fit: &Fit, values: usize, chirps: usize) -> f64 {
        let targets = fit.places.len();
        let freedom = (chirps * values.saturating_sub(targets)) as f64 - targets as f64;
        fit.residual / freedom.max(1.0)
    }

    /// Adds one target at the strongest residual and refines all targets jointly. Then relocates each target in turn
    /// while that decreases the residual.
    fn add(&self, seen: &Seen<'_>, model: &Model<'_>, others: &[Place]) -> Option<Refined> {
        let (iterations, tolerance) = (self.options.max_iterations, self.options.tolerance);
        let refine = |places: &[Place]| model.refine(places, iterations, tolerance);
        let mut places = others.to_vec();
        places.push(seen.best(model, others)?);
        let mut best = refine(&places)?;
        let count = places.len();
        let mut settled = 1;
        for at in (0..count).cycle().take(MAX_ROUNDS * count) {
            if settled >= count {
                break;
            }
            settled += 1;
            let mut places = best.fit.places.clone();
            let moved = places.remove(at);
            let Some(place) = seen.best(model, &places) else { continue };
            if self.search.is_near(moved, place) {
                continue;
            }
            places.insert(at, place);
            if let Some(next) = refine(&places)
                && next.fit.residual < best.fit.residual * (1.0 - SETTLED)
            {
                best = next;
                settled = 1;
            }
        }
        Some(best)
    }

    fn checked(&self, region: ArrayView3<'_, Complex32>) -> Result<Array3<Complex64>, AoaError> {
        let (bins, elements, chirps) = region.dim();
        let planned = (self.atoms.bins, self.atoms.positions.len());
        if (bins, elements) != planned || chirps == 0 {
            return Err(AoaError::Argument(InputError::Shape {
                what: "region".into(),
                expected: format!("[{}, {}, chirps]", planned.0, planned.1),
                given: vec![bins, elements, chirps],
            }));
        }
        let most = MAX_CELLS as f64 / self.search.len().max(1) as f64;
        boresight_math::error::check_range("region chirps", chirps as f64, 1.0, most)?;
        let of_parts = |(index, z): (usize, &Complex32)| {
            let given = if z.re.is_finite() { z.im } else { z.re };
            (!given.is_finite()).then_some((index, f64::from(given)))
        };
        if let Some((index, given)) = region.iter().enumerate().find_map(of_parts) {
            let what = "region".into();
            return Err(AoaError::Argument(InputError::NotFinite { what, index, given }));
        }
        Ok(region.mapv(|z| Complex64::new(z.re.into(), z.im.into())))
    }
}

fn told(fit: &Fit, noise_power: f64) -> Vec<RangeAngleTarget> {
    let deviations = fit.deviations(noise_power);
    let places = fit.places.iter().enumerate().zip(fit.amplitudes.rows());
    let mut targets: Vec<RangeAngleTarget> = places
        .map(|((at, place), amplitudes)| {
            let deviation = deviations.as_ref().map(|all| all[at]);
            let cosine = (1.0 - place.sine * place.sine).sqrt();
            RangeAngleTarget {
                bin: place.bin,
                azimuth_rad: place.sine.asin(),
                power: amplitudes.iter().map(|z| z.norm_sqr()).sum::<f64>()
                    / amplitudes.len() as f64,
                bin_deviation: deviation.and_then(|(bin, _)| bin),
                azimuth_deviation_rad: deviation
                    .map(|(_, sine)| sine / cosine)
                    .filter(|deviation| deviation.is_finite()),
            }
        })
        .collect();
    sort_descending(&mut targets, |target| target.power);
    targets
}
