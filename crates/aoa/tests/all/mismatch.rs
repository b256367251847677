//! Simulated boards whose elements are off by 1 dB and 10 deg, with and without that level as `mismatch_db`:
//! `cargo test -p boresight-aoa --test all mismatch:: -- --nocapture` prints how often each counts right.

use boresight_aoa::order::counting::{CountOptions, Criterion, count_sources_in};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction, Random};
use boresight_math::phasor::cis;
use ndarray::Array2;
use std::f64::consts::FRAC_PI_4;

const BOARDS: u64 = 300;

/// 10 lg((10 deg)^2 + (1 dB of amplitude)^2).
const LEVEL_DB: f64 = -13.6;

/// Snapshots of targets (azimuth, power in dB) on a board of its own, with phases of their own in each.
fn snapshots(
    array: &Array,
    targets: &[(f64, f64)],
    snr_db: f64,
    count: usize,
    random: &mut Random,
) -> Array2<Complex64> {
    let board: Vec<Complex64> = (0..array.len())
        .map(|_| {
            let gain = 10f64.powf(random.normal() / 20.0);
            cis(random.normal() * 10f64.to_radians()) * gain
        })
        .collect();
    let noise = 10f64.powf(-snr_db / 10.0);
    let mut y = Array2::from_shape_fn((array.len(), count), |_| random.complex_normal(noise));
    for &(azimuth, power_db) in targets {
        let response = steering_vector(array, Direction::azimuth(azimuth));
        for mut column in y.columns_mut() {
            let amplitude = cis(random.phase()) * 10f64.powf(power_db / 20.0);
            for (k, z) in column.iter_mut().enumerate() {
                *z += response[k] * board[k] * amplitude;
            }
        }
    }
    y
}

type Counter = fn(&Array, Array2<Complex64>, Option<f64>) -> usize;

fn nomp(array: &Array, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    let options = EstimatorOptions { mismatch_db, ..EstimatorOptions::default() };
    let mut nomp = Estimator::new(Method::Nomp, array, &options).unwrap();
    nomp.estimate(Data::Snapshots(y.view())).unwrap().sources.len()
}

fn refined(array: &Array, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    let options = EstimatorOptions { mismatch_db, refine: true, ..EstimatorOptions::default() };
    let mut method = Estimator::new(Method::Bartlett, array, &options).unwrap();
    method.estimate(Data::Snapshots(y.view())).unwrap().sources.len()
}

fn reversed(criterion: Criterion, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    let options =
        CountOptions { criterion, forward_backward: true, mismatch_db, ..CountOptions::default() };
    count_sources_in(Data::Snapshots(y.view()), &options).unwrap().1.sources
}

fn mdl(_: &Array, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    reversed(Criterion::Mdl, y, mismatch_db)
}

fn aic(_: &Array, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    reversed(Criterion::Aic, y, mismatch_db)
}

/// MUSIC that counts in a smoothed covariance.
fn smoothed(array: &Array, y: Array2<Complex64>, mismatch_db: Option<f64>) -> usize {
    let options = EstimatorOptions {
        mismatch_db,
        sources: SourceCount::Mdl,
        smoothing: Some(6),
        ..EstimatorOptions::default()
    };
    let mut music = Estimator::new(Method::RootMusic, array, &options).unwrap();
    music.estimate(Data::Snapshots(y.view())).unwrap().sources.len()
}

/// Shares of boards on which `counter` says the number of targets.
fn right(counter: Counter, targets: usize, count: usize, mismatch_db: Option<f64>) -> f64 {
    let array = preset("awr1642").unwrap();
    let mut right = 0;
    for trial in 0..BOARDS {
        let mut random = Random::new(81, trial);
        let snr_db = random.uniform(20.0, 40.0);
        let first = random.uniform(-FRAC_PI_4, 0.0);
        let second = (first.sin() + random.uniform(0.4, 0.8)).asin();
        let all = [(first, 0.0), (second, -6.0)];
        let y = snapshots(&array, &all[..targets], snr_db, count, &mut random);
        right += usize::from(counter(&array, y, mismatch_db) == targets);
    }
    right as f64 / BOARDS as f64
}

#[test]
fn an_error_of_the_array_splits_no_target_and_hides_none() {
    let cases: [(&str, Counter, usize); 7] = [
        ("NOMP, 1 snapshot", nomp, 1),
        ("NOMP, 16 snapshots", nomp, 16),
        ("Bartlett refined, 16 snapshots", refined, 16),
        ("MDL, reversed, 16 snapshots", mdl, 16),
        ("MDL, reversed, 200 snapshots", mdl, 200),
        ("AIC, reversed, 16 snapshots", aic, 16),
        ("root-MUSIC, MDL, smoothed", smoothed, 16),
    ];
    let mut rows = vec![];
    println!("| | one target, without | with | two targets, without | with |");
    for (name, counter, count) in cases {
        let [one, one_with, two, two_with] =
            [(1, None), (1, Some(LEVEL_DB)), (2, None), (2, Some(LEVEL_DB))]
                .map(|(targets, level)| right(counter, targets, count, level));
        let percent = [one, one_with, two, two_with].map(|share| format!("{:.0} %", 100.0 * share));
        println!("| {name} | {} |", percent.join(" | "));
        rows.push((name, one_with, two, two_with));
    }
    for (name, one_with, two, two_with) in rows {
        assert!(one_with >= 0.95, "{name}: {one_with}");
        // One snapshot of eight elements tells two from noise of unknown power no more often.
        assert!(two_with >= two.min(0.95), "{name}: {two_with}");
    }
    // It is the error that splits targets.
    assert!(right(nomp, 1, 16, None) < 0.3);
    assert!(right(mdl, 1, 200, None) < 0.3);
}
