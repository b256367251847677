//! How often sources are counted right, from one snapshot to a hundred.

use crate::size::sized;
use crate::support::azimuths;
use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method};
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Random};
use ndarray::Array2;

fn trials() -> usize {
    sized(2000, 400)
}

/// Least share of the trials where so many are expected: four standard deviations less.
fn least(share: f64) -> f64 {
    share - 4.0 * (share * (1.0 - share) / trials() as f64).sqrt()
}

/// Three targets of random phase from snapshot to snapshot, `snr_db` over white noise; none without a level.
fn snapshots(snr_db: Option<f64>, count: usize, random: &mut Random) -> Array2<Complex64> {
    let array = Array::ula(8).unwrap();
    let amplitude = snr_db.map_or(0.0, |db| 10f64.powf(db / 20.0));
    let at = azimuths(&[-30.0, 2.0, 36.0]);
    let signals =
        Array2::from_shape_fn((3, count), |_| Complex64::from_polar(amplitude, random.phase()));
    let noise = Array2::from_shape_fn((8, count), |_| random.complex_normal(1.0));
    steering_matrix(&array, &at).dot(&signals) + noise
}

/// Share of trials with a count of `expected`.
fn right(
    snr_db: Option<f64>,
    vectors: usize,
    expected: usize,
    mut count: impl FnMut(Data<'_>) -> usize,
) -> f64 {
    let mut random = Random::new(382, vectors as u64);
    let mut counts = [0; 9];
    for _ in 0..trials() {
        let y = snapshots(snr_db, vectors, &mut random);
        counts[count(Data::Snapshots(y.view()))] += 1;
    }
    println!("{vectors} snapshots, {snr_db:?} dB: times that 0, 1, ... were counted: {counts:?}");
    f64::from(counts[expected]) / trials() as f64
}

#[test]
fn the_default_counts_right_from_few_snapshots_on() {
    for forward_backward in [false, true] {
        let options = CountOptions { forward_backward, ..CountOptions::default() };
        let count = |data: Data<'_>| count_sources_in(data, &options).unwrap().1.sources;
        for vectors in [2, 3, 4, 5, 6, 8, 12, 20, 50, 100] {
            let none = right(None, vectors, 0, count);
            let three = right(Some(20.0), vectors, 3, count);
            println!("{vectors} snapshots, averaged {forward_backward}: {none:.4} and {three:.4}");
            assert!(none >= least(0.99), "{vectors}: {none}");
            // Two eigenvalues of noise beside those of the three targets at least.
            assert!(vectors < 4 || three >= least(0.982), "{vectors}: {three}");
        }
    }
}

#[test]
fn maximum_likelihood_counts_right_in_single_snapshots() {
    let array = Array::ula(8).unwrap();
    let options = EstimatorOptions { grid_points: 128, ..EstimatorOptions::default() };
    let mut estimator = Estimator::new(Method::MaximumLikelihood, &array, &options).unwrap();
    let mut count = |data: Data<'_>| estimator.estimate(data).unwrap().sources.len();
    let none = right(None, 1, 0, &mut count);
    let three = right(Some(30.0), 1, 3, &mut count);
    println!("{none:.4} and {three:.4}");
    assert!(none >= least(0.99) && three >= least(0.967), "{none} {three}");
}
