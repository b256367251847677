//! The experiment on resolution on few trials.

#![allow(clippy::unwrap_used)]

use boresight_core::Diagnose;
use boresight_experiments::EvaluateError;
use boresight_experiments::resolution::{
    ResolutionExperiment, ResolutionReport, SEPARATIONS, SNRS_DB,
};
use boresight_validate::experiment::{Experiment, How, Report as _, run};
use std::ops::ControlFlow;

fn report(
    array: &str,
    snapshots: &[usize],
    trials: u64,
) -> Result<ResolutionReport, EvaluateError> {
    let snapshots = snapshots.to_vec();
    let options = ResolutionExperiment { array: array.into(), snapshots, trials, seed: 2 };
    run(&options, How { threads: 2, folder: None }, |_| ControlFlow::Continue(()))
}

#[test]
fn far_targets_are_resolved_near_ones_are_not_and_the_limit_lies_between() {
    let report = report("ula8", &[1, 16], 12).unwrap();
    assert!((report.beam_deg - 12.8).abs() < 0.1, "{}", report.beam_deg);
    assert_eq!(report.conditions.len(), 2 * SNRS_DB.len());
    for condition in &report.conditions {
        let (snapshots, snr_db) = (condition.snapshots, condition.snr_db);
        let shares = |name: &str| {
            let found = condition.methods.iter().find(|m| m.name == name).unwrap();
            &found.resolved
        };
        let fit = shares("maximum-likelihood");
        // Two beam widths at 20 dB: the bound is a twentieth of half the separation.
        if snr_db >= 20.0 {
            assert_eq!(fit[SEPARATIONS.len() - 1], 1.0, "{snapshots} at {snr_db} dB");
        }
        // A quarter of the limit: the deviation is 16 times the separation, so that chance gives at most a few
        // percent: 3 of 12 in one of 200 cases.
        let limit = condition.limit.unwrap();
        for (separation, share) in SEPARATIONS.iter().zip(fit) {
            if *separation < 0.25 * limit {
                assert!(*share < 0.2, "{separation} of {limit}: {share}");
            }
        }
        // Smith's limit is where an efficient estimator has a probability of erf(1 / sqrt 2), 68 %.
        let at = SEPARATIONS.iter().position(|s| *s >= limit).unwrap();
        assert!(condition.efficient[at] >= 0.68);
        assert!(at == 0 || condition.efficient[at - 1] < 0.69);
        assert!(condition.efficient.is_sorted());
        // The Fourier beam sees two maxima only beyond about a beam width.
        let fourier = shares("bartlett");
        assert!(fourier[5] < 0.2, "{fourier:?}");
    }
    // One snapshot has room for subspace methods by smoothing only.
    let names = |k: usize| -> Vec<&str> {
        report.conditions[k].methods.iter().map(|m| m.name.as_str()).collect()
    };
    assert!(names(0).contains(&"music, smoothed") && !names(0).contains(&"music"));
    assert!(names(0).contains(&"single-snapshot-music"));
    assert!(names(SNRS_DB.len()).contains(&"music"));
    let rows: usize = report.conditions.iter().map(|c| c.methods.len() + 1).sum();
    assert_eq!(report.csv().lines().count(), 1 + rows * SEPARATIONS.len());
    assert!(report.tables().to_string().contains("limit (Smith 2005)"));
    assert!(report.figures()[0].contains("16 snapshots, 20 dB"));
}

#[test]
fn sparse_arrays_leave_out_what_needs_a_uniform_one_and_bad_options_are_refused() {
    let sparse =
        ResolutionExperiment { array: "lrr48".into(), snapshots: vec![1], trials: 1, seed: 0 };
    let names = ResolutionExperiment::methods(&sparse.plan().unwrap());
    assert!(names.iter().any(|name| name == "1: nomp"), "{names:?}");
    assert!(!names.iter().any(|name| name.contains("smoothed")), "{names:?}");
    for (array, snapshots, trials, what) in [
        ("nothing", &[1][..], 1, "array preset"),
        ("ula8", &[], 1, "numbers of snapshots"),
        ("ula8", &[0], 1, "snapshots"),
        ("ula8", &[1], 0, "trials"),
    ] {
        assert_eq!(report(array, snapshots, trials).unwrap_err().details().what, what);
    }
}
