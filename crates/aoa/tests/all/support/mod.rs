//! Data with known answers, made from the definition alone.

use boresight_aoa::{Estimate, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction, Random};
use boresight_simulate::snapshots::{
    Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator,
};
use ndarray::Array2;

/// Directions in the horizontal plane from degrees.
pub fn azimuths(degrees: &[f64]) -> Vec<Direction> {
    degrees.iter().map(|deg| Direction::azimuth(deg.to_radians())).collect()
}

/// `y = A s + n` with independent circular Gaussian signals of the given powers.
pub fn scene(
    array: &Array,
    directions: &[Direction],
    powers: &[f64],
    noise_power: f64,
    snapshots: usize,
    random: &mut Random,
) -> Array2<Complex64> {
    let signals = Array2::from_shape_fn((directions.len(), snapshots), |(i, _)| {
        random.complex_normal(powers[i])
    });
    let noise =
        Array2::from_shape_fn((array.len(), snapshots), |_| random.complex_normal(noise_power));
    steering_matrix(array, directions).dot(&signals) + noise
}

/// Single snapshots of targets within 13 dB at random azimuths.
pub fn random_scenes(array: &Array, targets: usize, snr_db: f64, seed: u64) -> SnapshotSimulator {
    let sampling = SceneSampling { count: [targets; 2], ..SceneSampling::default() };
    let options = SnapshotOptions {
        scene: Scene::Sampled(sampling),
        snr_db,
        snapshots: 1,
        fluctuation: Fluctuation::RandomPhase,
        seed,
        ..SnapshotOptions::default()
    };
    SnapshotSimulator::new(array, &options).unwrap()
}

/// Options for a known number of sources.
pub fn known(sources: usize) -> EstimatorOptions {
    EstimatorOptions { sources: SourceCount::Known(sources), ..EstimatorOptions::default() }
}

/// One estimate.
pub fn estimate(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
    y: &Array2<Complex64>,
) -> Estimate {
    let mut estimator = Estimator::new(method, array, options).unwrap();
    estimator.estimate(boresight_aoa::Data::Snapshots(y.view())).unwrap()
}

/// Azimuths found, ascending.
pub fn found(estimate: &Estimate) -> Vec<f64> {
    let mut angles: Vec<f64> =
        estimate.sources.iter().map(|source| source.direction.azimuth_rad).collect();
    angles.sort_by(f64::total_cmp);
    angles
}
