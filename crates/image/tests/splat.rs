//! Splatting against sums done by hand, and what it conserves.

#![allow(clippy::unwrap_used)]

use boresight_core::{Diagnose, InputError, Random};
use boresight_image::{Axis, Grid, ImageError, RangeAzimuthDoppler, SpectrumPlan, Target};
use proptest::prelude::*;

/// 11 ranges from 5 to 15 m, 9 sines from -0.8 to 0.8.
fn grid() -> Grid {
    Grid::new([5.0, 15.0], 11, 0.8_f64.asin(), 9).unwrap()
}

fn rates() -> Axis {
    Axis::new("rate_mps", -3.0, 3.0, 7).unwrap()
}

fn target(range_m: f64, rate_mps: f64, sine: f64, power: f64) -> Target {
    Target { range_m, rate_mps, azimuth_rad: sine.asin(), power, confidence: 1.0 }
}

#[test]
fn a_target_is_shared_among_its_neighbours() {
    let mut cube = RangeAzimuthDoppler::new(grid(), Some(rates())).unwrap();
    let half_sure = Target { confidence: 0.5, ..target(7.25, 1.5, 0.05, 8.0) };
    cube.add_target(&half_sure).unwrap();
    // Of a power of 4: 3/4 at 7 m and 1/4 at 8 m, half at either rate, 3/4 at sine 0, 1/4 at 0.2.
    for (cell, share) in [
        ([2, 4, 4], 0.75 * 0.5 * 0.75),
        ([2, 5, 5], 0.75 * 0.5 * 0.25),
        ([3, 4, 5], 0.25 * 0.5 * 0.25),
        ([3, 5, 4], 0.25 * 0.5 * 0.75),
    ] {
        assert!((f64::from(cube.power[cell]) - 4.0 * share).abs() < 1e-6, "{cell:?}");
    }
    assert_eq!(cube.power.iter().filter(|&&power| power > 0.0).count(), 8);
    assert_eq!(cube.outside.count, 0);
}

#[test]
fn what_falls_beside_the_grid_is_counted() {
    let mut map = RangeAzimuthDoppler::new(grid(), None).unwrap();
    map.add_target(&target(15.25, 0.0, 0.0, 4.0)).unwrap();
    map.add_target(&target(40.0, 0.0, 0.0, 2.0)).unwrap();
    map.add_target(&target(8.0, 0.0, 0.85, 8.0)).unwrap();
    let behind = Target { azimuth_rad: 3.0, ..target(8.0, 0.0, 0.0, 16.0) };
    map.add_target(&behind).unwrap();
    map.add_target(&target(8.0, 99.0, 0.1, 32.0)).unwrap();
    assert_eq!(map.outside.count, 4);
    assert!((map.outside.power - (1.0 + 2.0 + 2.0 + 16.0)).abs() < 1e-9, "{:?}", map.outside);
    assert!((map.power.sum() - (3.0 + 6.0 + 32.0)).abs() < 1e-5);
}

proptest! {
    /// Whatever the targets, no power is lost, and a map is the cube's sum over Doppler. Sums of
    /// 200 numbers in single precision are right to 1e-5.
    #[test]
    fn power_is_conserved(seed in any::<u64>()) {
        let mut random = Random::new(seed, 0);
        let mut cube = RangeAzimuthDoppler::new(grid(), Some(rates())).unwrap();
        let mut map = RangeAzimuthDoppler::new(grid(), None).unwrap();
        let (mut all, mut in_rates) = (0.0, 0.0);
        for _ in 0..200 {
            let rate = random.uniform(-3.5, 3.5);
            let target =
                target(random.uniform(4.0, 16.0), rate, random.uniform(-1.0, 1.0), random.unit());
            all += target.power;
            map.add_target(&target).unwrap();
            if rate.abs() <= 3.0 {
                in_rates += target.power;
                cube.add_target(&target).unwrap();
            }
        }
        let sum = f64::from(map.power.sum());
        prop_assert!((sum + map.outside.power - all).abs() < 1e-5 * all);
        let sum = f64::from(cube.power.sum());
        prop_assert!((sum + cube.outside.power - in_rates).abs() < 1e-5 * in_rates);
        // The same targets in a map: the cube summed.
        let mut random = Random::new(seed, 0);
        let mut direct = RangeAzimuthDoppler::new(grid(), None).unwrap();
        for _ in 0..200 {
            let rate = random.uniform(-3.5, 3.5);
            let target =
                target(random.uniform(4.0, 16.0), rate, random.uniform(-1.0, 1.0), random.unit());
            if rate.abs() <= 3.0 {
                direct.add_target(&target).unwrap();
            }
        }
        let (summed, direct) = (cube.to_map().power, direct.to_map().power);
        for (a, b) in summed.iter().zip(&direct) {
            prop_assert!((a - b).abs() < 1e-5 * direct.sum());
        }
    }

    #[test]
    fn no_input_panics(range in any::<f64>(), rate in any::<f64>(), azimuth in any::<f64>(),
                       power in any::<f64>(), confidence in any::<f64>()) {
        let mut cube = RangeAzimuthDoppler::new(grid(), Some(rates())).unwrap();
        let target = Target { range_m: range, rate_mps: rate, azimuth_rad: azimuth, power, confidence };
        let _ = cube.add_target(&target);
        prop_assert!(cube.power.iter().all(|power| power.is_finite()));
        let plan = SpectrumPlan::new(&[-0.5, 0.5], &grid()).unwrap();
        let _ = cube.add_spectrum(&plan, range, rate, &[power as f32, 1.0], Some(confidence));
        prop_assert!(cube.power.iter().all(|power| !power.is_nan()));
    }
}

/// Azimuths uniform in sine over -1 to 1.
fn azimuths(points: usize) -> Vec<f64> {
    (0..points).map(|k| (-1.0 + 2.0 * k as f64 / points as f64).asin()).collect()
}

#[test]
fn an_even_spectrum_gives_an_even_image() {
    // Coarser than the grid by 1.25 and finer by 2 and 12.8. The last column lies beyond the last
    // point of the coarse spectrum.
    for points in [8, 20, 128] {
        let plan = SpectrumPlan::new(&azimuths(points), &grid()).unwrap();
        let mut map = RangeAzimuthDoppler::new(grid(), None).unwrap();
        map.add_spectrum(&plan, 9.0, 0.0, &vec![3.0; points], None).unwrap();
        for column in 0..8 {
            let power = map.power[[4, 0, column]];
            // Sums of a tent at 12.8 points a cell vary by 1 / (4 * 12.8^2).
            assert!((power - 3.0).abs() < 0.005, "{points}: {power} in {column}");
        }
    }
}

#[test]
fn spectra_keep_their_energy() {
    let plan = SpectrumPlan::new(&azimuths(100), &grid()).unwrap();
    let mut random = Random::new(3, 0);
    let mut cube = RangeAzimuthDoppler::new(grid(), Some(rates())).unwrap();
    let mut all = 0.0;
    for _ in 0..20 {
        let power: Vec<f32> = (0..100).map(|_| random.unit() as f32).collect();
        // A point stands for 0.02 in sine, a tenth of a cell.
        all += 0.1 * f64::from(power.iter().sum::<f32>());
        let (range, rate) = (random.uniform(4.0, 16.0), random.uniform(-3.0, 3.0));
        cube.add_spectrum(&plan, range, rate, &power, None).unwrap();
    }
    let found = f64::from(cube.power.sum()) + cube.outside.power;
    assert!((found - all).abs() < 1e-5 * all, "{found} {all}");
    assert!(cube.outside.power > 0.1 * all);
}

#[test]
fn levels_and_elevations() {
    let plan = SpectrumPlan::new(&azimuths(10), &grid()).unwrap();
    // Two elevations; the strongest of each azimuth counts, and the peak is set to 6.
    let mut power = [0.0; 20];
    (power[5], power[15]) = (1.0, 2.0);
    let mut map = RangeAzimuthDoppler::new(grid(), None).unwrap();
    map.add_spectrum(&plan, 9.0, 0.0, &power, Some(6.0)).unwrap();
    assert!((map.power[[4, 0, 4]] - 6.0).abs() < 1e-5, "{}", map.power[[4, 0, 4]]);
    let mut map = RangeAzimuthDoppler::new(grid(), None).unwrap();
    map.add_spectrum(&plan, 9.0, 0.0, &[f32::MAX; 10], None).unwrap();
    assert!(map.power.iter().all(|power| power.is_finite()));
    for (power, code, what) in [
        (&power[..15], "shape", "a spectrum"),
        (&[f32::NAN; 10], "out-of-range", "power 0 of a spectrum"),
        (&[-1.0; 10], "out-of-range", "power 0 of a spectrum"),
    ] {
        let refused = map.add_spectrum(&plan, 9.0, 0.0, power, None).unwrap_err();
        assert_eq!((refused.code(), &*refused.details().what), (code, what));
    }
}

#[test]
fn grids_that_are_none_are_refused() {
    for (range_m, view_rad, what) in [
        ([-1.0, 5.0], 1.0, "range_m"),
        ([1.0, 5.0], 1.6, "field_of_view_rad"),
        ([1.0, f64::NAN], 1.0, "range_m"),
    ] {
        assert_eq!(Grid::new(range_m, 4, view_rad, 8).unwrap_err().details().what, what);
    }
    let large = Grid::new([1.0, 5.0], 16_000, 1.0, 16_000);
    assert!(matches!(large, Err(ImageError::Argument(InputError::TooLarge { .. }))), "{large:?}");
    for (azimuths, what) in [
        (&[0.1][..], "azimuths of the spectra"),
        (&[0.2, 0.1], "azimuth 1 of the spectra (rad)"),
        (&[0.0, 2.0], "azimuth of a spectrum (rad)"),
        (&[0.0, f64::NAN], "azimuth of a spectrum (rad)"),
    ] {
        assert_eq!(SpectrumPlan::new(azimuths, &grid()).unwrap_err().details().what, what);
    }
}
