#![allow(clippy::unwrap_used)]
use super::*;
use crate::tdm::phase_step_rad;
use boresight_core::Random;
use boresight_core::presets::preset;
use boresight_math::decibels::db_to_power;

/// The virtual array of all transmitters and receivers.
fn whole(name: &str) -> (Array, usize) {
    let array = preset(name).unwrap();
    let whole = Array::mimo(array.tx(), array.rx()).unwrap();
    (whole, array.tx().len())
}

fn test_of(array: &Array, transmitters: usize, kind: Multiplexing) -> FoldTest {
    let channels: Vec<usize> = (0..array.len()).collect();
    FoldTest::new(array, &channels, transmitters, kind, transmitters / 2, None).unwrap()
}

/// A cell at its SNR a channel, of waves of some amplitude, bin and fold.
fn cell(
    test: &FoldTest,
    waves: &[(Direction, f64)],
    bin: f64,
    fold: i32,
    snr_db: f64,
    random: &mut Random,
) -> Array2<Complex64> {
    let step = phase_step_rad(bin, 64, test.chirps, fold);
    let receivers = test.channels.len() / test.chirps;
    let mut sum = Array2::zeros((test.channels.len(), 1));
    for (direction, amplitude) in waves {
        let gain = cis(random.phase()) * *amplitude;
        for (at, z) in test.response(*direction).into_iter().enumerate() {
            sum[[at, 0]] += gain * z * cis(step * (at / receivers) as f64);
        }
    }
    sum.mapv_inplace(|z: Complex64| z + random.complex_normal(db_to_power(-snr_db)));
    sum
}

/// Share of cells whose fold is right, and of those that say so with 0.99.
fn shares(test: &FoldTest, snr_db: f64, cells: usize, two: bool) -> [f64; 3] {
    let mut random = Random::new(20, 0);
    let mut counts = [0; 3];
    for n in 0..cells {
        let uniform = |random: &mut Random| random.phase() / TAU + 0.5;
        let bin = 64.0 * uniform(&mut random);
        let folds = test.folds(bin, 64);
        let fold = folds[n % folds.len()];
        let azimuth = |random: &mut Random| 2.0 * (uniform(random) - 0.5);
        let mut waves = vec![(Direction::azimuth(azimuth(&mut random)), 1.0)];
        if two {
            waves.push((Direction::azimuth(azimuth(&mut random)), 0.5));
        }
        let cell = cell(test, &waves, bin, fold, snr_db, &mut random);
        let noise = db_to_power(-snr_db);
        let found = test.decide(cell.view(), bin, 64, noise).unwrap();
        let sure = found.probability >= 0.99;
        counts[0] += usize::from(found.fold == fold);
        counts[1] += usize::from(sure);
        counts[2] += usize::from(sure && found.fold != fold);
    }
    counts.map(|count| count as f64 / cells as f64)
}

#[test]
fn folds_are_right_in_99_percent_at_15_db() {
    // SNR of one channel in the cell; azimuths within 57 deg, rates over all folds.
    for name in ["awr1642", "awr1843", "lrr48", "cascade86"] {
        let (array, transmitters) = whole(name);
        let cells = if array.len() > 100 { 100 } else { 400 };
        let test = test_of(&array, transmitters, Multiplexing::TimeDivision);
        assert_eq!(test.hypotheses(), transmitters);
        let found = shares(&test, 15.0, cells, false);
        assert!(found[0] >= 0.99 && found[1] >= 0.99, "{name}: {found:?}");
        // A second target of 6 dB less leaves them right, and certainty honest.
        let found = shares(&test, 15.0, cells, true);
        assert!(found[0] >= 0.99 && found[2] <= 0.01, "{name}: {found:?}");
        // Weak cells are left undecided rather than wrong.
        let found = shares(&test, 0.0, cells, false);
        assert!(found[2] <= 0.01, "{name}: {found:?}");
    }
    let ula = Array::ula(12).unwrap();
    let test = test_of(&ula, 3, Multiplexing::TimeDivision);
    let found = shares(&test, 15.0, 400, false);
    assert!(found[0] >= 0.99 && found[1] >= 0.99, "{found:?}");
    let (array, transmitters) = whole("awr1642");
    let test = test_of(&array, transmitters, Multiplexing::BinaryPhase);
    let found = shares(&test, 15.0, 400, false);
    // The wrong fold swaps the two transmitters, which are alike where the path between them
    // is whole quarters of a turn: there nothing is told, and it is said.
    assert!(found[0] >= 0.95 && found[1] >= 0.8 && found[2] <= 0.005, "{found:?}");
}

#[test]
fn an_array_that_cannot_tell_says_so() {
    // One receiver and transmitters half a wavelength apart: any step is some angle.
    let ula = Array::ula(4).unwrap();
    let test = test_of(&ula, 4, Multiplexing::TimeDivision);
    let found = shares(&test, 30.0, 200, false);
    assert!(found[1] <= 0.02, "{found:?}");
    // One element: nothing at all, and of equals the slowest.
    let point = Array::mimo(&[[0.0; 3]; 2], &[[0.0; 3]]).unwrap();
    let test = test_of(&point, 2, Multiplexing::TimeDivision);
    let still = Array2::from_elem((2, 1), Complex64::ONE);
    let found = test.decide(still.view(), 32.0, 64, 1e-3).unwrap();
    assert!(found.fold == 0 && found.probability > 0.99, "elements that coincide: {found:?}");
    let nothing = Array2::zeros((2, 1));
    let found = test.decide(nothing.view(), 40.0, 64, 0.0).unwrap();
    assert!(found.fold == 0 && (found.probability - 0.5).abs() < 1e-9, "{found:?}");
}

#[test]
fn an_array_off_its_plan_tells_folds_all_the_same() {
    // 20 deg from channel to channel, which no model knows of, at 40 dB.
    let (array, transmitters) = whole("awr1843");
    let test = test_of(&array, transmitters, Multiplexing::TimeDivision);
    let mut random = Random::new(3, 0);
    let mut right = 0;
    for n in 0..200 {
        let fold = [-1, 0, 1][n % 3];
        let bin = 32.0 + 20.0 * (random.phase() / TAU - 0.5);
        let azimuth = Direction::azimuth(random.phase() / TAU - 0.5);
        let mut cell = cell(&test, &[(azimuth, 1.0)], bin, fold, 40.0, &mut random);
        for mut row in cell.rows_mut() {
            let error = cis(0.35 * (random.phase() / TAU - 0.5) * 12_f64.sqrt());
            row.mapv_inplace(|z| z * error);
        }
        let found = test.decide(cell.view(), bin, 64, 1e-4).unwrap();
        right += usize::from(found.fold == fold);
    }
    assert!(right >= 198, "{right} of 200");
}

#[test]
fn folds_of_equal_phase_are_the_slowest() {
    let (array, transmitters) = whole("awr1642");
    let channels: Vec<usize> = (0..8).collect();
    let kind = Multiplexing::TimeDivision;
    let test = FoldTest::new(&array, &channels, transmitters, kind, 3, None).unwrap();
    assert_eq!(test.hypotheses(), 2);
    assert_eq!((test.folds(40.0, 64), test.folds(20.0, 64)), (vec![0, -1], vec![0, 1]));
    for (channels, folds) in [(&channels[..7], 1), (&[9; 8], 1), (&channels, 33)] {
        assert!(FoldTest::new(&array, channels, transmitters, kind, folds, None).is_err());
    }
    let wrong = Array2::zeros((7, 1));
    assert!(test.decide(wrong.view(), 0.0, 64, 0.0).is_err());
}
