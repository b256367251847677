//! Images of the street against `tests/golden/images.csv`, natively and in wasm: the maps of one
//! radar by the FFT and by IAA, and the bird's-eye view of two radars by IAA, at a small size. The
//! file is what `cargo test -p boresight-wasm --test all -- print_images --nocapture` prints.

use boresight_aoa::{Estimator, EstimatorOptions, Method};
use boresight_core::presets::preset;
use boresight_image::{
    Grid, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, ViewGrid, birds_eye_view,
};
use boresight_pipeline::Chain;
use boresight_pipeline::image::chain_options;
use boresight_simulate::street::{Street, StreetOptions};
use ndarray::{Array2, Axis};
use std::f64::consts::FRAC_PI_3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test;

/// Powers may differ by this much of themselves and of the strongest of their image. Cubes are the
/// same bits; transforms in single precision round at 1e-7 of the strongest sample, and IAA's weak
/// parts amplify that by less than a hundred.
const TOLERANCE: [f64; 2] = [1e-3, 1e-5];

/// The map of radar `index`, with 64 samples over 25 m and 32 loops.
fn map(street: &Street, index: usize, method: Method) -> RangeAzimuthMap {
    let radar = &street.radars[index];
    let array = preset(radar.array).unwrap();
    let (cube, _) = street.cube(index).unwrap();
    let options = chain_options();
    let mut chain = Chain::new(&radar.waveform, 8, &array, &options).unwrap();
    let cells = chain.cells(cube.index_axis(Axis(0), 0)).unwrap();
    let mut estimator = Estimator::new(method, &array, &EstimatorOptions::default()).unwrap();
    let batch = estimator.estimate_batch(cells.snapshots.view(), true).unwrap();
    let spectra = batch.spectra.unwrap();
    let mut image =
        RangeAzimuthDoppler::new(Grid::new([2.0, 22.0], 26, FRAC_PI_3, 40).unwrap(), None).unwrap();
    let plan = SpectrumPlan::new(&spectra.azimuth_rad, &image.grid).unwrap();
    let rows = spectra.values.chunks_exact(spectra.azimuth_rad.len());
    for (cell, power) in cells.cells.iter().zip(rows) {
        image.add_spectrum(&plan, cell.range_m, cell.rate_mps, power, None).unwrap();
    }
    image.to_map()
}

/// The images by name.
fn images() -> Vec<(&'static str, Array2<f32>)> {
    let mut street = Street::new(StreetOptions { seed: 2, ..StreetOptions::default() }).unwrap();
    for radar in &mut street.radars {
        // The same range bins over a quarter of the range, beyond which no point is simulated.
        (radar.waveform.samples, radar.waveform.loops) = (64, 32);
        radar.waveform.slope_hz_per_s *= 4.0;
    }
    let maps = [1, 2].map(|index| map(&street, index, Method::Iaa));
    let radars = [1, 2].map(|index| (&maps[index - 1], street.radars[index].mounting));
    let grid = ViewGrid::new([0.0, 25.0], [-10.0, 10.0], 0.5).unwrap();
    let view = birds_eye_view(&radars, grid).unwrap();
    vec![
        ("map-bartlett", map(&street, 1, Method::Bartlett).power),
        ("map-iaa", maps[0].power.clone()),
        ("view-iaa", view.power),
    ]
}

fn strongest(image: &Array2<f32>) -> f64 {
    f64::from(image.iter().copied().fold(0.0, f32::max))
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn images_are_those_of_the_golden_file() {
    let golden = include_str!("../../../../tests/golden/images.csv");
    let mut lines = golden.lines().skip(1);
    for (name, image) in images() {
        let peak = strongest(&image);
        let lit = image.iter().filter(|&&power| f64::from(power) > 1e-4 * peak).count();
        assert!(lit > 50, "{name}: {lit} cells within 40 dB");
        for row in image.outer_iter() {
            let mut fields = lines.next().unwrap().split(',');
            assert_eq!(fields.next(), Some(name));
            for &power in row {
                let expected = peak_share(fields.next().unwrap());
                let error = (f64::from(power) / peak - expected).abs();
                let limit = TOLERANCE[0] * expected + TOLERANCE[1];
                assert!(error < limit, "{name}: {} and {expected}", f64::from(power) / peak);
            }
            assert_eq!(fields.next(), None);
        }
    }
    assert_eq!(lines.next(), None);
}

fn peak_share(field: &str) -> f64 {
    if field.is_empty() { 0.0 } else { field.parse().unwrap() }
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn print_images() {
    println!("image,power over the strongest of the image");
    for (name, image) in images() {
        let peak = strongest(&image);
        for row in image.outer_iter() {
            let share = |&power: &f32| {
                let share = f64::from(power) / peak;
                if share < 1e-6 { String::new() } else { format!("{share:.4e}") }
            };
            println!("{name},{}", row.iter().map(share).collect::<Vec<_>>().join(","));
        }
    }
}
