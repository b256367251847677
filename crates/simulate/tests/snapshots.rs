//! Snapshots against the model they are drawn from.

#![allow(clippy::unwrap_used)]

use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Diagnose, Direction, Imperfections, InputError};
use boresight_math::decibels::db_to_power;
use boresight_math::linalg::hermitian_eigen;
use boresight_signal::sample_covariance;
use boresight_simulate::{
    Fluctuation, Scene, SceneSampling, SimulateError, SnapshotOptions, SnapshotSimulator, Target,
};
use ndarray::Array2;
use proptest::prelude::*;

const NOISELESS: f64 = 300.0;

fn given(targets: &[(f64, f64, Option<f64>)]) -> Scene {
    let target = |&(deg, power_db, phase_rad): &(f64, f64, Option<f64>)| Target {
        direction: Direction::azimuth(deg.to_radians()).into(),
        power_db,
        phase_rad,
        range_m: None,
    };
    Scene::Given(targets.iter().map(target).collect())
}

fn options(
    scene: Scene,
    fluctuation: Fluctuation,
    snr_db: f64,
    snapshots: usize,
) -> SnapshotOptions {
    SnapshotOptions {
        scene,
        snr_db,
        snapshots,
        fluctuation,
        seed: 12,
        ..SnapshotOptions::default()
    }
}

fn simulate(array: &Array, options: &SnapshotOptions) -> (Array2<Complex64>, Vec<Target>) {
    SnapshotSimulator::new(array, options).unwrap().scene(0).unwrap()
}

/// Entries of a covariance of 20 000 snapshots have a standard error of at most the largest
/// variance over the root of their number, 0.9 %; five of it.
#[test]
fn covariances_are_those_of_the_model() {
    let array = preset("ula6").unwrap();
    let count = 20_000;
    for fluctuation in [Fluctuation::ComplexNormal, Fluctuation::RandomPhase] {
        let scene = given(&[(-20.0, 0.0, None), (35.0, -6.0, None)]);
        let (values, truth) = simulate(&array, &options(scene, fluctuation, 10.0, count));
        let covariance = sample_covariance(values.view());
        let variance = 1.0 + db_to_power(-6.0) + db_to_power(-10.0);
        let margin = 5.0 * variance / (count as f64).sqrt();
        for ((i, k), given) in covariance.indexed_iter() {
            let mut expected: Complex64 = truth
                .iter()
                .map(|t| {
                    let a = steering_vector(&array, *t.direction);
                    a[i] * a[k].conj() * db_to_power(t.power_db)
                })
                .sum();
            if i == k {
                expected += db_to_power(-10.0);
            }
            assert!((given - expected).norm() < margin, "{fluctuation:?} {i} {k}");
        }
    }
}

#[test]
fn the_first_snapshot_has_the_given_magnitude_and_phase() {
    let array = preset("lrr48").unwrap();
    for fluctuation in [Fluctuation::RandomPhase, Fluctuation::Coherent] {
        let scene = given(&[(17.0, -6.0, Some(0.7))]);
        let (values, truth) = simulate(&array, &options(scene, fluctuation, NOISELESS, 4));
        let a = steering_vector(&array, *truth[0].direction);
        let amplitude = Complex64::from_polar(10.0_f64.powf(-0.3), 0.7);
        for (k, a) in a.iter().enumerate() {
            assert!((values[[k, 0]] - a * amplitude).norm() < 1e-12);
            assert!((values[[k, 3]].norm() - amplitude.norm()).abs() < 1e-12);
        }
        assert!((values[[0, 1]] - values[[0, 0]]).norm() > 1e-3);
    }
}

#[test]
fn coherent_targets_have_a_covariance_of_rank_one() {
    let array = preset("ula8").unwrap();
    for (fluctuation, rank) in
        [(Fluctuation::Coherent, 1), (Fluctuation::RandomPhase, 2), (Fluctuation::ComplexNormal, 2)]
    {
        let scene = given(&[(-10.0, 0.0, None), (20.0, 0.0, None)]);
        let (values, truth) = simulate(&array, &options(scene, fluctuation, NOISELESS, 50));
        let eigen = hermitian_eigen(sample_covariance(values.view()).view()).unwrap().values;
        assert_eq!(eigen.iter().filter(|&&v| v > 1e-9 * eigen[0]).count(), rank);
        let phases = truth.iter().filter(|t| t.phase_rad.is_some()).count();
        assert_eq!(phases, if fluctuation == Fluctuation::ComplexNormal { 0 } else { 2 });
    }
}

/// 3000 scenes; the mean of each uniform quantity within five standard errors.
#[test]
fn sampled_scenes_follow_the_rule() {
    let sampling = SceneSampling {
        count: [1, 5],
        field_of_view_rad: 1.0,
        elevation_field_of_view_rad: 0.2,
        power_db: [-13.0, -1.0],
    };
    let array = preset("ula2").unwrap();
    let options = options(Scene::Sampled(sampling), Fluctuation::RandomPhase, 20.0, 1);
    let truth = SnapshotSimulator::new(&array, &options).unwrap().scenes(0, 3000).unwrap().truth;
    let counts: Vec<f64> = truth.iter().map(|t| t.len() as f64).collect();
    let check = |values: Vec<f64>, low: f64, high: f64, variance: f64| {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        assert!(values.iter().all(|v| (low..=high).contains(v)));
        assert!((mean - (low + high) / 2.0).abs() < 5.0 * (variance / n).sqrt(), "{mean}");
    };
    check(counts, 1.0, 5.0, 2.0);
    let all: Vec<Target> = truth.into_iter().flatten().collect();
    let uniform = |low: f64, high: f64, of: fn(&Target) -> f64| {
        check(all.iter().map(of).collect(), low, high, (high - low).powi(2) / 12.0);
    };
    uniform(-1.0, 1.0, |t| t.direction.azimuth_rad);
    uniform(-0.2, 0.2, |t| t.direction.elevation_rad);
    uniform(-13.0, -1.0, |t| t.power_db);
    uniform(-std::f64::consts::PI, std::f64::consts::PI, |t| t.phase_rad.unwrap());
}

#[test]
fn sweeps_split_anywhere() {
    let array = preset("awr1642").unwrap();
    let options =
        options(Scene::Sampled(SceneSampling::default()), Fluctuation::RandomPhase, 15.0, 2);
    let simulator = SnapshotSimulator::new(&array, &options).unwrap();
    let whole = simulator.scenes(0, 9).unwrap();
    let tail = simulator.scenes(4, 5).unwrap();
    assert_eq!(whole.values.slice(ndarray::s![4.., .., ..]), tail.values);
    assert_eq!(whole.truth[4..], tail.truth[..]);
    assert_eq!(simulator.scene(8).unwrap().1, whole.truth[8]);
    assert_ne!(whole.truth[0], whole.truth[1]);
}

#[test]
fn imperfect_arrays_respond_as_the_core_says() {
    let array = preset("awr1843").unwrap();
    let spread = ImperfectionSpread {
        gain_db: 1.0,
        phase_rad: 0.3,
        position: 0.1,
        coupling_db: Some(-15.0),
    };
    let imperfections = Imperfections::random(&array, spread, 6).unwrap();
    let scene = given(&[(30.0, 0.0, Some(0.0))]);
    let options = SnapshotOptions {
        imperfections: Some(imperfections.clone()),
        ..options(scene, Fluctuation::RandomPhase, NOISELESS, 1)
    };
    let (values, truth) = simulate(&array, &options);
    let expected = imperfections.steering_vector(&array, *truth[0].direction).unwrap();
    for (given, expected) in values.iter().zip(&expected) {
        assert!((given - expected).norm() < 1e-12);
    }
}

/// Snapshot of a noiseless target of phase zero on `lrr48`, and the response to a plane wave.
fn near_and_far(
    array: &Array,
    azimuth_deg: f64,
    range_m: f64,
    imperfections: Option<Imperfections>,
) -> (Vec<Complex64>, Vec<Complex64>) {
    let direction = Direction::azimuth(azimuth_deg.to_radians());
    let snapshot = |range_m| {
        let target = Target {
            direction: direction.into(),
            range_m,
            phase_rad: Some(0.0),
            ..Target::default()
        };
        let options = SnapshotOptions {
            imperfections: imperfections.clone(),
            ..options(Scene::Given(vec![target]), Fluctuation::RandomPhase, NOISELESS, 1)
        };
        let (values, truth) = simulate(array, &options);
        assert_eq!(truth[0].range_m, range_m);
        values.iter().copied().collect()
    };
    (snapshot(Some(range_m)), snapshot(None))
}

/// `lrr48` is 92 half wavelengths of 1.95 mm long: a Fraunhofer distance of 16.5 m. Transmitters are up to 152 mm from
/// the origin: at a million times the distance the phase differs by `pi (0.152^2 + 0.027^2) / 0.0039 / 1.65e7`, 1.2e-6;
/// rounding of `2 R` leaves 1e-8 m of the path, 1.6e-5 rad.
#[test]
fn far_beyond_the_fraunhofer_distance_waves_are_plane() {
    let array = preset("lrr48").unwrap();
    let spread = ImperfectionSpread {
        gain_db: 1.0,
        phase_rad: 0.3,
        position: 0.1,
        coupling_db: Some(-15.0),
    };
    let imperfections = Imperfections::random(&array, spread, 6).unwrap();
    for imperfections in [None, Some(imperfections)] {
        let (near, far) = near_and_far(&array, -35.0, 16.5e6, imperfections);
        assert!(near.iter().zip(&far).all(|(near, far)| (near - far).norm() < 1e-4));
    }
}

/// To second order the paths over a transmitter at `t` and a receiver at `r`, along y, are longer than those of a plane
/// wave by `(t^2 + r^2) cos(azimuth)^2 / 2 R`. At 100 m that is a phase of up to 0.19 rad; the third order is less by
/// `t / R`, 3e-4 rad.
#[test]
fn nearer_by_phases_are_quadratic_in_the_places_of_transmitters_and_receivers() {
    let array = preset("lrr48").unwrap();
    let (half_m, range_m) = (0.0039 / 2.0, 100.0);
    for azimuth_deg in [-50.0, 0.0, 20.0] {
        let (near, far) = near_and_far(&array, azimuth_deg, range_m, None);
        let across = f64::cos(azimuth_deg.to_radians()).powi(2);
        for (k, channel) in array.channels().iter().enumerate() {
            let [t, r] = [array.tx()[channel.tx], array.rx()[channel.rx]].map(|p| p[1] * half_m);
            let longer_m = (t * t + r * r) * across / (2.0 * range_m);
            let expected = std::f64::consts::TAU * longer_m / 0.0039;
            let phase = (near[k] * far[k].conj()).arg();
            assert!((phase - expected).abs() < 4e-4, "{azimuth_deg} deg, {k}: {phase}");
            assert!((near[k].norm() - 1.0).abs() < 1e-12);
        }
    }
    // The same virtual elements as receivers beside one transmitter answer otherwise, by `t r cos^2 / R`.
    let alone = Array::new(array.positions()).unwrap();
    let (mimo, _) = near_and_far(&array, 0.0, range_m, None);
    let (simo, _) = near_and_far(&alone, 0.0, range_m, None);
    let last = array.len() - 1;
    let difference = (simo[last] * mimo[last].conj()).arg();
    let expected = std::f64::consts::TAU / 0.0039 * (78.0 * 14.0 * half_m * half_m) / range_m;
    assert!((difference - expected).abs() < 4e-4, "{difference} for {expected}");
}

#[test]
fn too_much_and_too_little_are_named() {
    let array = preset("lrr48").unwrap();
    let good = options(given(&[]), Fluctuation::RandomPhase, 10.0, 1);
    let simulator = SnapshotSimulator::new(&array, &good).unwrap();
    assert!(matches!(
        simulator.scenes(0, usize::MAX),
        Err(SimulateError::Argument(InputError::TooLarge { .. }))
    ));
    assert_eq!(simulator.scenes(0, 0).unwrap().truth.len(), 0);
    let none = SnapshotOptions { snapshots: 0, ..good.clone() };
    assert!(matches!(
        SnapshotSimulator::new(&array, &none),
        Err(SimulateError::Argument(InputError::OutOfRange { .. }))
    ));
    for (range_m, wavelength_m, what) in
        [(0.0, 0.004, "range_m"), (f64::NAN, 0.004, "range_m"), (1.0, 0.0, "wavelength_m")]
    {
        let target = Target { range_m: Some(range_m), ..Target::default() };
        let scene = Scene::Given(vec![target]);
        let options = SnapshotOptions { scene, wavelength_m, ..good.clone() };
        let error = SnapshotSimulator::new(&array, &options).unwrap_err();
        assert!(error.details().what.contains(what), "{error}");
    }
    let backwards = SceneSampling { count: [3, 2], ..SceneSampling::default() };
    let backwards = SnapshotOptions { scene: Scene::Sampled(backwards), ..good };
    let refused = SnapshotSimulator::new(&array, &backwards).err().unwrap();
    assert_eq!(refused.details().what, "fewest targets");
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(0.0), -90.0..90.0, any::<f64>()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever the numbers, there are finite snapshots or a typed error.
    #[test]
    fn any_numbers_give_finite_snapshots_or_an_error(
        numbers in prop::array::uniform6(any_number()),
        counts in prop::array::uniform2(prop_oneof![0..20_usize, Just(usize::MAX)]),
        snapshots in prop_oneof![0..4_usize, Just(usize::MAX)],
        sampled in any::<bool>(),
    ) {
        let [snr_db, azimuth_rad, elevation_rad, power, other, phase] = numbers;
        let scene = if sampled {
            Scene::Sampled(SceneSampling {
                count: counts,
                field_of_view_rad: azimuth_rad,
                elevation_field_of_view_rad: elevation_rad,
                power_db: [power, other],
            })
        } else {
            let direction = Direction::new(azimuth_rad, elevation_rad);
            let range_m = (other > 0.0).then_some(other);
            Scene::Given(vec![Target { direction: direction.into(), power_db: power, phase_rad: Some(phase), range_m }])
        };
        let options = options(scene, Fluctuation::RandomPhase, snr_db, snapshots);
        let array = preset("awr1642").unwrap();
        if let Ok(simulator) = SnapshotSimulator::new(&array, &options)
            && let Ok((values, _)) = simulator.scene(3)
        {
            prop_assert!(values.iter().all(|z| z.re.is_finite() && z.im.is_finite()));
        }
    }
}
