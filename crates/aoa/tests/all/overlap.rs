//! Every method on MIMO arrays whose transmitters repeat positions: coincident virtual elements.

use crate::support::{estimate, found, known};
use boresight_aoa::Method;
use boresight_aoa::suits::unsuited;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction, Random};
use ndarray::Array2;

/// Scenes of each array, method and number of snapshots; `BORESIGHT_SCENES` for another number.
fn scenes() -> usize {
    std::env::var("BORESIGHT_SCENES").ok().and_then(|text| text.parse().ok()).unwrap_or(8)
}

/// A row of transmitters `step` apart before receivers half a wavelength apart.
fn row(transmitters: usize, step: usize, receivers: usize) -> Array {
    let at = |y: usize| [0.0, y as f64, 0.0];
    let tx: Vec<_> = (0..transmitters).map(|t| at(t * step)).collect();
    let rx: Vec<_> = (0..receivers).map(at).collect();
    Array::mimo(&tx, &rx).unwrap()
}

/// Two transmitters by eight receivers that share one to four positions, six by eight on 36 positions, and the azimuth
/// transmitters of a board with three transmitters and four receivers, a wavelength apart, with one repeated.
fn arrays() -> Vec<(&'static str, Array)> {
    let at = |y: f64| [0.0, y, 0.0];
    let rx: Vec<_> = (0..4).map(|r| at(f64::from(r))).collect();
    vec![
        ("2 x 8, 1 shared", row(2, 7, 8)),
        ("2 x 8, 2 shared", row(2, 6, 8)),
        ("2 x 8, 3 shared", row(2, 5, 8)),
        ("2 x 8, 4 shared", row(2, 4, 8)),
        (
            "6 x 8 on 36 places",
            Array::mimo(
                &[0.0, 4.0, 8.0, 16.0, 24.0, 28.0].map(at),
                &(0..8).map(|r| at(f64::from(r))).collect::<Vec<_>>(),
            )
            .unwrap(),
        ),
        ("3 x 4, half shared", Array::mimo(&[0.0, 2.0, 4.0].map(at), &rx).unwrap()),
    ]
}

/// Two azimuths at least `apart` in sine.
fn pair(random: &mut Random, apart: f64) -> [f64; 2] {
    loop {
        let sines = [(); 2].map(|()| random.uniform(-0.82, 0.82));
        if (sines[0] - sines[1]).abs() > apart {
            return sines;
        }
    }
}

/// Snapshots of targets of unit power and random phase in white noise.
fn scene(
    array: &Array,
    at: &[Direction],
    noise: f64,
    snapshots: usize,
    random: &mut Random,
) -> Array2<Complex64> {
    let phases = [(at.len(), snapshots), (array.len(), snapshots)];
    let signals = Array2::from_shape_fn(phases[0], |_| Complex64::from_polar(1.0, random.phase()));
    let noise = Array2::from_shape_fn(phases[1], |_| random.complex_normal(noise));
    steering_matrix(array, at).dot(&signals) + noise
}

#[test]
fn no_method_loses_a_separated_target() {
    let noise = 10f64.powf(-1.5);
    for (name, array) in arrays() {
        let rayleigh = 2.0 / (array.aperture() + 1.0);
        for snapshots in [1, 50] {
            for method in Method::ALL {
                if unsuited(method, &array, &known(2), snapshots).is_some() {
                    continue;
                }
                let mut random = Random::new(380, 0);
                let mut lost = 0;
                for _ in 0..scenes() {
                    let sines = pair(&mut random, 2.0 * rayleigh);
                    let at = sines.map(|sine| Direction::azimuth(sine.asin()));
                    let y = scene(&array, &at, noise, snapshots, &mut random);
                    let angles = found(&estimate(method, &array, &known(2), &y));
                    let near =
                        |sine: &f64| angles.iter().any(|a| (a.sin() - sine).abs() < rayleigh / 2.0);
                    lost += usize::from(!sines.iter().all(near));
                }
                assert_eq!(lost, 0, "{name}, {snapshots} snapshots, {}", method.name());
            }
        }
    }
}
