//! IAA's score on random scenes: the largest F1 over a threshold on power.

use boresight_aoa::{Data, Estimator, EstimatorOptions, Method};
use boresight_core::presets::preset;

const SCENES: u64 = 200;
const WITHIN_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// Largest F1 for `targets` within 60 degrees and 13 dB on the sparse long-range array. A
/// prediction within half a degree of a target is right, a target with a prediction that close is
/// found.
fn best_f1(targets: usize, snr_db: f64) -> f64 {
    let array = preset("lrr48").unwrap();
    let simulator = crate::support::random_scenes(&array, targets, snr_db, 91);
    let options = EstimatorOptions {
        grid_points: 2048,
        field_of_view_rad: 60.0_f64.to_radians(),
        dynamic_range_db: 40.0,
        max_peaks: 64,
        ..EstimatorOptions::default()
    };
    let mut iaa = Estimator::new(Method::Iaa, &array, &options).unwrap();
    // Power of each prediction and whether it is right; power up to which each target is found.
    let mut predictions = Vec::new();
    let mut targets_found = Vec::new();
    for scene in 0..SCENES {
        let (y, truth) = simulator.scene(scene).unwrap();
        let result = iaa.estimate(Data::Snapshots(y.view())).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() <= WITHIN_RAD;
        for source in &result.sources {
            let at = source.direction.azimuth_rad;
            let right = truth.iter().any(|t| near(t.direction.azimuth_rad, at));
            predictions.push((source.power, right));
        }
        for target in &truth {
            let at = target.direction.azimuth_rad;
            let powers = result.sources.iter().filter(|s| near(s.direction.azimuth_rad, at));
            targets_found.push(powers.map(|s| s.power).fold(0.0, f64::max));
        }
    }
    let mut best = 0.0f64;
    for &(threshold, _) in &predictions {
        let kept = predictions.iter().filter(|p| p.0 >= threshold).count() as f64;
        let right = predictions.iter().filter(|p| p.0 >= threshold && p.1).count() as f64;
        let found = targets_found.iter().filter(|&&p| p >= threshold).count() as f64;
        let (precision, recall) = (right / kept, found / targets_found.len() as f64);
        best = best.max(2.0 * precision * recall / (precision + recall));
    }
    best
}

/// Published figures for the plain FFT lie between 0.7 and 0.9; a NumPy study of 4000 scenes gives
/// IAA 0.98 to 1.00 at 35 dB and 0.97 to 0.99 at 15 dB. Of at least 400 targets here about 2 % are
/// missed or false, in clusters: a standard deviation of at most 0.007.
#[test]
fn iaa_scores_as_expected() {
    for (snr_db, least) in [(35.0, 0.965), (15.0, 0.955)] {
        for targets in [2, 6, 10] {
            let f1 = best_f1(targets, snr_db);
            println!("{targets} targets at {snr_db} dB: F1 {f1:.4}");
            assert!(f1 >= least, "{targets} targets at {snr_db} dB: {f1}");
        }
    }
}
