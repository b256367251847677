//! Joint range-angle estimation: against the Cramer-Rao bound, where echoes are coherent, of unequal
//! power or moving, and on noise alone.

use boresight_aoa::{EstimatorOptions, RangeAngle, RangeAngleEstimate, SourceCount};
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex32, Complex64, Diagnose, Direction, Random};
use boresight_math::phasor::cis;
use ndarray::{Array3, s};
use std::f64::consts::{PI, TAU};

const SAMPLES: usize = 256;
const BINS: usize = 65;
const CHIRPS: usize = 4;

/// Range bin, azimuth in deg, power in dB, turns of the phase from chirp to chirp.
type Target = (f64, f64, f64, f64);

/// A region around bin 32 of the range spectrum of `samples`, noise of one raw sample at 0 dB less `snr_db`.
fn region(
    array: &Array,
    targets: &[Target],
    snr_db: f64,
    random: &mut Random,
) -> Array3<Complex32> {
    let noise = 10f64.powf(-snr_db / 10.0) / SAMPLES as f64;
    let mut data =
        Array3::from_shape_fn((BINS, array.len(), CHIRPS), |_| random.complex_normal(noise));
    for &(bin, azimuth_deg, power_db, turns) in targets {
        let steering = steering_vector(array, Direction::azimuth(azimuth_deg.to_radians()));
        let start = cis(random.uniform(0.0, TAU)) * 10f64.powf(power_db / 20.0);
        for ((n, k, l), z) in data.indexed_iter_mut() {
            // The transform of a tone, summed as it is defined.
            let distance = bin - n as f64;
            let below = (PI * distance / SAMPLES as f64).sin();
            let kernel = if below.abs() < 1e-9 {
                Complex64::new(1.0, 0.0)
            } else {
                cis(PI * distance * (SAMPLES as f64 - 1.0) / SAMPLES as f64)
                    * ((PI * distance).sin() / (SAMPLES as f64 * below))
            };
            *z += start * kernel * steering[k] * cis(TAU * turns * l as f64);
        }
    }
    data.mapv(|z| Complex32::new(z.re as f32, z.im as f32))
}

fn plan(array: &Array, sources: SourceCount) -> RangeAngle {
    let field_of_view_rad = 15f64.to_radians();
    let options = EstimatorOptions { sources, field_of_view_rad, ..EstimatorOptions::default() };
    RangeAngle::new(array, SAMPLES, BINS, &options).unwrap()
}

/// Share of scenes in which all angles are within 1 deg.
fn success(mut scene: impl FnMut(&mut Random) -> [Target; 2], snr_db: f64, scenes: u64) -> f64 {
    let array = Array::ula(8).unwrap();
    let mut joint = plan(&array, SourceCount::Known(2));
    let right = (0..scenes).filter(|&seed| {
        let mut random = Random::new(38, seed);
        let targets = scene(&mut random);
        let found = joint.estimate(region(&array, &targets, snr_db, &mut random).view()).unwrap();
        let sorted = |mut all: Vec<f64>| {
            all.sort_by(f64::total_cmp);
            all
        };
        let found = sorted(found.targets.iter().map(|t| t.azimuth_rad.to_degrees()).collect());
        let truth = sorted(targets.iter().map(|t| t.1).collect());
        found.len() == 2 && found.iter().zip(&truth).all(|(f, t)| (f - t).abs() <= 1.0)
    });
    right.count() as f64 / scenes as f64
}

/// Two distinct whole degrees within 10 and ranges within 20 bins.
fn pair(random: &mut Random) -> [(f64, f64); 2] {
    let degree = |random: &mut Random| (random.uniform(-10.5, 10.5)).round();
    let first = degree(random);
    let second = loop {
        let second = degree(random);
        if (second - first).abs() >= 1.0 {
            break second;
        }
    };
    [first, second].map(|angle| (random.uniform(22.0, 42.0), angle))
}

fn scenes() -> u64 {
    std::env::var("BORESIGHT_SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(100)
}

#[test]
fn pairs_at_ranges_of_their_own_are_found() {
    // Less five standard deviations of a share of so many scenes.
    let least = |share: f64| share - 5.0 * (share * (1.0 - share) / scenes() as f64).sqrt();
    for (snr_db, second_db, share) in
        [(-10.0, 0.0, 0.985), (15.0, 0.0, 0.995), (15.0, -6.0, 0.995), (15.0, -15.0, 0.985)]
    {
        let scene = |random: &mut Random| {
            let [(near, one), (far, other)] = pair(random);
            [(near, one, 0.0, 0.0), (far, other, second_db, 0.0)]
        };
        let found = success(scene, snr_db, scenes());
        println!("{snr_db} dB, second at {second_db} dB: {found}");
        assert!(found >= least(share), "{snr_db} dB, second at {second_db} dB: {found}");
    }
}

#[test]
fn pairs_at_one_range_are_found_where_one_moves_or_both_stand() {
    for (turns, share) in [(0.0, 0.8), (0.3, 0.9)] {
        let scene = |random: &mut Random| {
            let [(near, one), (_, other)] = pair(random);
            [(near, one, 0.0, 0.0), (near, other, 0.0, turns)]
        };
        let found = success(scene, 15.0, scenes());
        println!("{turns} turns a chirp: {found}");
        assert!(found >= share, "{turns} turns a chirp: {found}");
    }
}

#[test]
fn stated_deviations_hold_68_of_100_errors() {
    let array = Array::ula(8).unwrap();
    let mut joint = plan(&array, SourceCount::Known(2));
    let targets = [(30.2, -4.0, 0.0, 0.0), (32.9, 5.5, -6.0, 0.1)];
    let trials = 4 * scenes();
    let mut within = 0;
    for trial in 0..trials {
        let mut random = Random::new(39, trial);
        let found = joint.estimate(region(&array, &targets, 10.0, &mut random).view()).unwrap();
        assert!(found.warnings.is_empty());
        for (target, truth) in found.targets.iter().zip(&targets) {
            let angle = (target.azimuth_rad - truth.1.to_radians()).abs();
            within += u32::from(angle <= target.azimuth_deviation_rad.unwrap());
            within += u32::from((target.bin - truth.0).abs() <= target.bin_deviation.unwrap());
            let power = 10.0 * target.power.log10();
            assert!((power - truth.2).abs() < 1.0, "{power}");
        }
    }
    let share = f64::from(within) / (4 * trials) as f64;
    // Errors of one trial's four values are taken as one trial.
    let margin = 5.0 * (0.683 * 0.317 / trials as f64).sqrt();
    println!("{share} of 0.683");
    assert!((share - 0.683).abs() < margin, "{share}");
}

#[test]
fn noise_holds_targets_as_often_as_allowed_and_targets_are_counted() {
    let array = Array::ula(8).unwrap();
    let mut joint = plan(&array, SourceCount::Auto);
    let allowed = EstimatorOptions::default().nomp.false_alarm;
    let trials = 4 * scenes();
    let mut random = Random::new(40, 0);
    let false_alarms = (0..trials)
        .filter(|_| {
            !joint
                .estimate(region(&array, &[], 0.0, &mut random).view())
                .unwrap()
                .targets
                .is_empty()
        })
        .count();
    println!("{false_alarms} of {trials} at {allowed}");
    let mean = allowed * trials as f64;
    assert!(false_alarms as f64 <= mean + 5.0 * mean.sqrt().max(1.0), "{false_alarms} of {trials}");
    let counted = |targets: &[Target], joint: &mut RangeAngle, random: &mut Random| {
        let right = (0..100).filter(|_| {
            let found: RangeAngleEstimate =
                joint.estimate(region(&array, targets, 10.0, random).view()).unwrap();
            found.targets.len() == targets.len()
        });
        right.count()
    };
    let one = [(31.7, 4.0, 0.0, 0.0)];
    let three = [(31.7, 4.0, 0.0, 0.0), (31.7, -7.0, -5.0, 0.2), (40.2, -6.0, -10.0, 0.0)];
    for targets in [&one[..], &three] {
        let right = counted(targets, &mut joint, &mut random);
        assert!(right >= 95, "{} targets: {right} of 100", targets.len());
    }
}

#[test]
fn bins_that_are_zero_are_not_measured() {
    let array = Array::ula(8).unwrap();
    let mut random = Random::new(41, 0);
    let mut data = region(&array, &[(32.4, 3.0, 0.0, 0.0)], 20.0, &mut random);
    data.slice_mut(s![..20, .., ..]).fill(Complex32::default());
    let found = plan(&array, SourceCount::Auto).estimate(data.view()).unwrap();
    assert_eq!(found.targets.len(), 1);
    assert!((found.targets[0].bin - 32.4).abs() < 0.01);
    let expected = 0.01 / SAMPLES as f64;
    assert!((found.noise_power / expected - 1.0).abs() < 0.15, "{}", found.noise_power);
    // One bin tells the azimuth, and no range.
    data.slice_mut(s![..32, .., ..]).fill(Complex32::default());
    data.slice_mut(s![33.., .., ..]).fill(Complex32::default());
    let found = plan(&array, SourceCount::Auto).estimate(data.view()).unwrap();
    let [target] = found.targets[..] else { panic!("{found:?}") };
    assert!((target.azimuth_rad.to_degrees() - 3.0).abs() < 0.1, "{target:?}");
    assert!((target.bin - 32.0).abs() <= 0.5 && target.bin_deviation.is_none(), "{target:?}");
    data.fill(Complex32::default());
    let nothing = plan(&array, SourceCount::Known(2)).estimate(data.view()).unwrap();
    assert!(nothing.targets.is_empty() && nothing.noise_power == 0.0);
}

#[test]
fn what_cannot_be_is_refused() {
    let array = Array::ula(8).unwrap();
    let options = |sources| EstimatorOptions { sources, ..EstimatorOptions::default() };
    let refused = |array: &Array, bins, sources| {
        RangeAngle::new(array, SAMPLES, bins, &options(sources)).err().unwrap().code()
    };
    let area = boresight_core::presets::preset("awr1843").unwrap();
    assert_eq!(refused(&area, BINS, SourceCount::Auto), "unsuitable-array");
    assert_eq!(refused(&array, SAMPLES + 1, SourceCount::Auto), "out-of-range");
    assert_eq!(refused(&array, 0, SourceCount::Auto), "out-of-range");
    assert_eq!(refused(&array, BINS, SourceCount::Known(9)), "too-many-sources");
    assert_eq!(refused(&array, BINS, SourceCount::Mdl), "incompatible");
    let mut joint = plan(&array, SourceCount::Auto);
    let code = |joint: &mut RangeAngle, data: Array3<Complex32>| {
        joint.estimate(data.view()).unwrap_err().code()
    };
    assert_eq!(code(&mut joint, Array3::zeros((BINS, 7, 4))), "shape");
    assert_eq!(code(&mut joint, Array3::zeros((BINS, 8, 0))), "shape");
    let mut data = Array3::zeros((BINS, 8, 4));
    data[[3, 2, 1]] = Complex32::new(0.0, f32::NAN);
    assert_eq!(code(&mut joint, data), "not-finite");
    for extreme in [1e-38f32, 1e38] {
        let mut random = Random::new(42, 0);
        let data =
            region(&array, &[(32.0, 3.0, 0.0, 0.0)], 20.0, &mut random).mapv(|z| z * extreme);
        let _ = joint.estimate(data.view());
    }
}
