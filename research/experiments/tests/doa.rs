//! The experiments of the 3D-CNN paper on few trials, against theory.

#![allow(clippy::unwrap_used)]

use boresight_experiments::Entrants;
use boresight_experiments::doa::report::MethodResult;
use boresight_experiments::doa::{
    Axis, DIFFERENCES_DB, DoaExperiment, DoaReport, SNRS_DB, Setup, Targets, default_methods,
};
use boresight_validate::experiment::{How, Report as _, run};
use std::ops::ControlFlow;

fn report(setup: Setup, trials: u64) -> DoaReport {
    report_over(Axis::Snr, setup, trials)
}

fn report_over(axis: Axis, setup: Setup, trials: u64) -> DoaReport {
    let entrants = Entrants::new(default_methods(setup).unwrap(), vec![]);
    let options = DoaExperiment { setup, axis, trials, seed: 5, entrants, end_to_end: None };
    run(&options, How { threads: 2, folder: None }, |_| ControlFlow::Continue(())).unwrap()
}

fn of(report: &DoaReport, targets: Targets, snr_db: f64, method: usize) -> &MethodResult {
    report.at(targets, snr_db).unwrap().methods[method].as_ref().unwrap()
}

#[test]
fn maximum_likelihood_resolves_pairs_of_unequal_power_and_moving_ones() {
    let report = report_over(Axis::PowerDifference, Setup::Simulation, 42);
    let method = |name: &str| report.methods.iter().position(|m| m == name).unwrap();
    let success =
        |targets, second_db, name: &str| of(&report, targets, second_db, method(name)).success;
    assert!(report.at(Targets::One, 0.0).is_none());
    for second_db in DIFFERENCES_DB {
        // Five standard deviations of a share of 0.99 in 42 trials.
        for name in ["joint range-angle", "maximum-likelihood, whole degrees"] {
            for targets in [Targets::Apart, Targets::Moving] {
                let share = success(targets, second_db, name);
                assert!(share > 0.91, "{name}, {targets:?}, {second_db} dB: {share}");
            }
        }
    }
    // The conventional beam shows the stronger target only.
    assert!(success(Targets::Apart, -15.0, "bartlett") < 0.2);
    assert!(report.tables().to_string().contains("| -15 dB |"));
    assert_eq!(report.figures().len(), 1);
}

#[test]
fn one_target_is_found_with_the_error_of_theory_and_pairs_as_far_as_they_can_be() {
    let report = report(Setup::Simulation, 42);
    let method = |name: &str| report.methods.iter().position(|m| m == name).unwrap();
    // Mean over all signal-to-noise ratios of squared error over theory's, 252 errors: a standard deviation of the
    // root of 1 / sqrt(2 * 252), 4.5 %.
    for name in ["music", "root-music", "maximum-likelihood", "nomp"] {
        let squares = SNRS_DB.iter().zip(&report.bounds_deg).map(|(&snr_db, [_, theory])| {
            let result = of(&report, Targets::One, snr_db, method(name));
            assert_eq!(result.found, 1.0, "{name} at {snr_db} dB");
            (result.rmse_deg / theory).powi(2)
        });
        let ratio = (squares.sum::<f64>() / SNRS_DB.len() as f64).sqrt();
        assert!((0.85..1.15).contains(&ratio), "{name}: {ratio}");
    }
    // The bound of 1024 samples of 8 elements, in closed form at 0 dB on boresight, is a little below the mean
    // over angles.
    let slope = std::f64::consts::PI.powi(2);
    let boresight = (6.0 / (1024.0 * slope * 8.0 * 63.0)).sqrt().to_degrees();
    let [bound, theory] = report.bounds_deg[2];
    assert!(bound > boresight && bound < 1.02 * boresight && theory > bound, "{bound}");
    let at = |targets, snr_db| report.at(targets, snr_db).unwrap();
    for targets in [Targets::Apart, Targets::Together] {
        for condition in SNRS_DB.map(|snr_db| at(targets, snr_db)) {
            assert_eq!((condition.trials, condition.close), (42, 9));
            for m in condition.methods.iter().flatten() {
                assert!(m.within[0] <= m.within[1] && m.within[1] <= m.within[2]);
                assert!(m.within[2] <= m.found && m.success <= m.found);
            }
        }
    }
    // At 15 dB the bound of the nearest pairs is some tenths of a degree: fits of two targets are right nearly always, an
    // FFT sees no pair within its beam of 13 deg; coherent echoes leave the covariance one eigenvector.
    let success = |targets, name: &str| of(&report, targets, 15.0, method(name)).success;
    for name in ["maximum-likelihood", "root-music"] {
        assert!(success(Targets::Apart, name) > 0.9, "{name}");
    }
    assert!(success(Targets::Apart, "bartlett") < 0.5);
    assert!(success(Targets::Together, "root-music") < 0.3);
    assert!(success(Targets::Together, "root-music, smoothed") > 0.85);
    // The second eigenvector that MDL needs is there at different ranges only; that holds for two of three scenes.
    assert!(report.counted_rightly(1, Targets::Apart, 15.0) > 0.95);
    let together = report.counted_rightly(1, Targets::Together, 15.0);
    assert!((together - 2.0 / 3.0).abs() < 0.05, "{together}");
    // By class: coherent targets are nearly always counted as one, others are not.
    let by_class = |targets| report.counted_as_it_is(1, targets, 15.0);
    assert!(by_class(Targets::One) > 0.9 && by_class(Targets::Together) < 0.1);
    assert_eq!(report.figures().len(), 4);
    let tables = report.tables().to_string();
    let missed = format!("{:.1}", 100.0 * by_class(Targets::Together));
    let of_class =
        tables.split("Scenes with two targets at one range counted rightly").nth(1).unwrap();
    let mdl = of_class.lines().find(|line| line.starts_with("| MDL |")).unwrap();
    assert!(mdl.ends_with(&format!("| {missed} |")), "{mdl}");
    assert!(tables.contains("Figure 9") && !tables.contains("NaN"), "{tables}");
    let lines = SNRS_DB.len() * (4 * report.methods.len() + 4 * 5);
    assert_eq!(report.csv().lines().count(), 1 + lines);
}

#[test]
fn the_radar_of_the_papers_experiments_does_as_well() {
    let report = report(Setup::Experiment, 4);
    let method = report.methods.iter().position(|m| m == "maximum-likelihood").unwrap();
    for (snr_db, [_, theory]) in SNRS_DB.iter().zip(&report.bounds_deg) {
        let rmse = of(&report, Targets::One, *snr_db, method).rmse_deg;
        // Four errors: their mean square is below 4.5 times its mean in all but 0.1 % of cases.
        assert!(rmse < 2.2 * theory, "{snr_db} dB: {rmse} {theory}");
    }
}
