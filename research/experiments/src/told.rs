//! Methods that are told the number of targets.

use boresight_aoa::options::NompOptions;
use boresight_aoa::{AoaError, Data, Estimator, EstimatorOptions, Method, Source, SourceCount};
use boresight_core::Array;

/// A method with its options.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name in records, tables and figures.
    pub name: String,
    method: Method,
    options: EstimatorOptions,
}

impl Candidate {
    /// The estimator.
    ///
    /// # Errors
    /// Those of [`Estimator::new`].
    pub fn estimator(&self, array: &Array) -> Result<Estimator, AoaError> {
        Estimator::new(self.method, array, &self.options)
    }

    /// Whether it takes a covariance.
    pub fn takes_covariance(&self) -> bool {
        self.method.requirements().takes_covariance
    }
}

/// Options of methods that are told the number of targets.
pub fn options(sources: usize, field_of_view_rad: f64) -> EstimatorOptions {
    EstimatorOptions {
        sources: SourceCount::Known(sources),
        field_of_view_rad,
        grid_points: 2048,
        dynamic_range_db: 40.0,
        max_peaks: sources,
        // Its own stop comes into play only where a target is no more than noise would be every other time.
        nomp: NompOptions {
            false_alarm: 0.5,
            max_sources: sources,
            ..EstimatorOptions::default().nomp
        },
        ..EstimatorOptions::default()
    }
}

/// Every method that can run on the array with that many snapshots. Those that need more than there are run
/// on the covariance smoothed over subarrays of two thirds of the elements, forwards and backwards, where the
/// array is uniform; so do, beside their plain form, the ones on eigenvectors where `coherent` targets are to be
/// told apart.
pub fn candidates(
    array: &Array,
    snapshots: usize,
    sources: usize,
    field_of_view_rad: f64,
    coherent: bool,
) -> Vec<Candidate> {
    let options = options(sources, field_of_view_rad);
    // Sparse Bayesian learning converges the more slowly the finer its grid is; it and maximum likelihood go on
    // between the points.
    let span = array.aperture() as usize + 1;
    let coarse = |points: usize| EstimatorOptions {
        grid_points: (points * span).next_power_of_two().min(options.grid_points),
        ..options
    };
    let smoothed = EstimatorOptions {
        forward_backward: true,
        smoothing: Some(array.len() - array.len() / 3),
        ..options
    };
    let mut all = vec![];
    for method in Method::ALL {
        let needs = method.requirements();
        if snapshots >= needs.min_snapshots
            && needs.max_snapshots.is_none_or(|most| snapshots <= most)
        {
            let options = match method {
                Method::SparseBayesian => coarse(8),
                Method::MaximumLikelihood => coarse(32),
                _ => options,
            };
            all.push(Candidate { name: method.name().into(), method, options });
        }
        // The co-array is of the whole array, whose distances smoothing would give up.
        let eigenvectors = needs.min_snapshots > 1 && method != Method::CoarrayMusic;
        if eigenvectors && (coherent || snapshots < needs.min_snapshots) {
            let name = format!("{}, smoothed", method.name());
            all.push(Candidate { name, method, options: smoothed });
        }
    }
    all.retain(|candidate| candidate.estimator(array).is_ok());
    all
}

/// Azimuths of the strongest `sources` estimates, rad, ascending; nothing if there are fewer.
///
/// # Errors
/// Those of [`Estimator::estimate`].
pub fn azimuths(
    estimator: &mut Estimator,
    data: Data,
    sources: usize,
) -> Result<Option<Vec<f64>>, AoaError> {
    Ok(strongest(&estimator.estimate(data)?.sources, sources))
}

/// Azimuths of the first, the strongest, of some sources, rad, ascending; nothing if there are fewer.
pub fn strongest(found: &[Source], sources: usize) -> Option<Vec<f64>> {
    let strongest = found.get(..sources)?.iter();
    let mut azimuths: Vec<f64> = strongest.map(|s| s.direction.azimuth_rad).collect();
    azimuths.sort_by(f64::total_cmp);
    Some(azimuths)
}
