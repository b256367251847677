//! Trained networks in the experiments, beside the methods, on few scenes.

#![allow(clippy::unwrap_used)]

mod common;
mod support;

use boresight_core::imperfections::ImperfectionSpread;
use boresight_experiments::aoa::score::Threshold;
use boresight_experiments::doa::{Setup, Targets};
use boresight_experiments::{Entrants, EvaluateError, Network, aoa, doa, merge};
use boresight_fleet::Part;
use boresight_neural::{Card, Kind, Model};
use boresight_pipeline::regions::RegionChainOptions;
use boresight_validate::experiment::{How, Report as _, run, run_part};
use boresight_validate::{Outcome, ValidateError};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

fn network(name: &str) -> Network {
    let path = PathBuf::from(common::model(name));
    let read = |ending: &str| std::fs::read(path.with_extension(ending)).unwrap();
    let card = Card::from_json(&read("json")).unwrap();
    let network = Network::new(Model::load(&read("onnx"), Some(&card)).unwrap(), "unnamed");
    assert_eq!((network.name.as_str(), Some(&network.sha256)), (name, card.sha256.as_ref()));
    network
}

fn folder(name: &str) -> PathBuf {
    let path =
        std::env::temp_dir().join(format!("boresight-networks-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn how(threads: usize, folder: Option<&Path>) -> How<'_> {
    How { threads, folder }
}

fn aoa_options(methods: &[&str], networks: Vec<Network>) -> aoa::AoaExperiment {
    let entrants = Entrants::new(methods.iter().map(|&name| name.into()).collect(), networks);
    let imperfections = ImperfectionSpread::default();
    aoa::AoaExperiment {
        array: "lrr48".into(),
        trials: 2,
        validation: 2,
        seed: 1,
        imperfections,
        entrants,
        ..aoa::AoaExperiment::default()
    }
}

#[test]
fn a_network_is_scored_as_methods_are_and_its_records_are_its_own() {
    let go = |_| ControlFlow::Continue(());
    let root = folder("aoa");
    let options = aoa_options(&["iaa", "nomp"], vec![network("learned-pursuit")]);
    let report = run(&options, how(2, Some(&root)), go).unwrap();
    assert_eq!(report.methods, ["iaa", "nomp", "learned-pursuit", "learned-pursuit+refined"]);
    let mean = |k: usize| {
        let f1 = report.conditions.iter().map(|c| c.methods[k].best.unwrap().f1);
        f1.sum::<f64>() / report.conditions.len() as f64
    };
    // 540 targets: the shipped network misses or invents some percent of them at most.
    assert!(mean(2) > 0.93 && mean(3) > 0.93, "{} {}", mean(2), mean(3));
    // Thresholds on confidence reach from hardly any prediction to all queries; those on power do not.
    let curve = &report.conditions[0].methods[2].curve;
    assert!(curve.last().unwrap().precision < 0.2, "{curve:?}");
    assert_eq!(Threshold::default(), Threshold::Power);

    // What is recorded is not run again: a name without a model is enough.
    let mut known = options.clone();
    known.entrants.networks[0].model = None;
    let again = run(&known, how(1, Some(&root)), go).unwrap();
    assert!(format!("{again:?}") == format!("{report:?}"));
    // In parts on other numbers of threads, methods and network in folders of their own, it is the same.
    let [methods, networks, out] = ["methods", "networks", "out"].map(|name| root.join(name));
    for (threads, number) in [(1, 1), (2, 2)] {
        let part = Part::new(number, 2).unwrap();
        run_part(&aoa_options(&["iaa", "nomp"], vec![]), how(threads, Some(&methods)), part, go)
            .unwrap();
        let alone = aoa_options(&[], options.entrants.networks.clone());
        run_part(&alone, how(threads, Some(&networks)), part, go).unwrap();
    }
    let merged = support::merged(&[networks.clone(), methods.clone()], &out);
    assert!(merged == Outcome::new::<aoa::AoaExperiment>(&report, &[]));
    assert!(support::merged(std::slice::from_ref(&out), &out) == merged);
    assert!(merged.brief.len() < merged.json.len() / 3);
    // The network of another training under the same name needs records of its own; the methods keep theirs.
    let mut other = options.clone();
    other.entrants.networks[0].sha256 = "0".repeat(64);
    let refused = run(&other, how(1, Some(&root)), go);
    assert!(
        matches!(refused, Err(EvaluateError::Run(ValidateError::OtherRun { .. }))),
        "{refused:?}"
    );
    std::fs::remove_file(root.join("aoa-learned-pursuit.jsonl")).unwrap();
    let before = std::fs::read(root.join("aoa.jsonl")).unwrap();
    run(&other, how(2, Some(&root)), go).unwrap();
    assert_eq!(std::fs::read(root.join("aoa.jsonl")).unwrap(), before);
    // Two trainings of one name cannot stand side by side.
    let both = merge(&[networks, root.join("aoa-learned-pursuit.jsonl")]);
    assert!(matches!(both, Err(EvaluateError::Run(ValidateError::OtherRun { .. }))), "{both:?}");
    std::fs::remove_dir_all(root).unwrap();
}

#[test]
fn what_a_network_cannot_do_is_refused_before_anything_runs() {
    let go = |_| ControlFlow::Continue(());
    let aoa = |array: &str, networks: Vec<Network>| {
        let options = aoa::AoaExperiment { array: array.into(), ..aoa_options(&["iaa"], networks) };
        run(&options, how(1, None), go).unwrap_err()
    };
    let aaetr = network("learned-pursuit");
    assert!(matches!(aoa("ula16", vec![aaetr.clone()]), EvaluateError::Network(_)));
    assert!(matches!(aoa("lrr48", vec![network("dnn-small-2")]), EvaluateError::Network(_)));
    assert!(matches!(aoa("lrr48", vec![aaetr.clone(), aaetr.clone()]), EvaluateError::Core(_)));
    let mut name_only = aaetr.clone();
    name_only.model = None;
    assert!(matches!(aoa("lrr48", vec![name_only]), EvaluateError::NoModel { .. }));
    let entrants = Entrants::new(vec![], vec![aaetr]);
    let doa = doa::DoaExperiment {
        axis: doa::Axis::Snr,
        setup: Setup::Simulation,
        trials: 1,
        seed: 1,
        entrants,
        end_to_end: None,
    };
    assert!(matches!(run(&doa, how(1, None), go), Err(EvaluateError::Core(_))));
}

#[test]
fn networks_of_regions_count_and_estimate_beside_the_rules() {
    let go = |_| ControlFlow::Continue(());
    let networks = vec![network("dnn-small-2"), network("counting")];
    let methods = vec!["MDL".into(), "maximum-likelihood".into()];
    let entrants = Entrants::new(methods, networks);
    let options = doa::DoaExperiment {
        axis: doa::Axis::Snr,
        setup: Setup::Simulation,
        trials: 21,
        seed: 2,
        entrants,
        end_to_end: None,
    };
    let report = run(&options, how(2, None), go).unwrap();
    assert_eq!(report.counters, ["MDL", "counting"]);
    assert_eq!(report.methods, ["maximum-likelihood", "dnn-small-2"]);
    assert_eq!(
        report.networks.iter().map(|n| n.kind).collect::<Vec<_>>(),
        [Kind::Counting, Kind::Dnn]
    );
    // 21 scenes of each kind: the network is right in far more than the third that guessing gets.
    let rightly = report.counted_rightly(1, Targets::Apart, 15.0);
    assert!(rightly > 0.7, "{rightly}");
    let at = |targets, method: usize| report.at(targets, 15.0).unwrap().methods[method].clone();
    // It is for two targets only, and always names as many.
    assert!(at(Targets::One, 1).is_none() && at(Targets::One, 0).is_some());
    let two = at(Targets::Apart, 1).unwrap();
    assert!(two.found == 1.0 && two.within[2] > 0.5, "{two:?}");
    // Its angles are whole degrees already.
    assert!((two.rmse_deg - two.rounded_rmse_deg).abs() < 1e-9, "{two:?}");
    let tables = report.tables().to_string();
    let figure_7 = tables.split("Figure 7").nth(1).unwrap().split("Figure 8").next().unwrap();
    assert!(!figure_7.contains("dnn-small-2") && tables.contains("| dnn-small-2 |"), "{tables}");
    assert!(report.figures()[2].contains("dnn-small-2"));
    assert!(!report.csv().contains("one,15,\"dnn-small-2\""));
}

/// The flow tells nothing, and counts what is told nearly as often: the very same scenes at 15 dB, where the region that is
/// detected is the strongest bin's.
#[test]
fn from_end_to_end_networks_do_as_well_as_told() {
    let go = |_| ControlFlow::Continue(());
    let networks = vec![network("counting"), network("dnn-small-2")];
    let told = doa::DoaExperiment {
        axis: doa::Axis::Snr,
        setup: Setup::Simulation,
        trials: 21,
        seed: 2,
        entrants: Entrants::new(vec![], networks.clone()),
        end_to_end: None,
    };
    let flow = |centre_deg| doa::EndToEnd {
        counting: network("counting"),
        centre_deg,
        regions: RegionChainOptions::default(),
    };
    let end_to_end = doa::DoaExperiment { end_to_end: Some(flow(0.0)), ..told.clone() };
    let report = |options: &doa::DoaExperiment| run(options, how(2, None), go).unwrap();
    let (told, found) = (report(&told), report(&end_to_end));
    for snr_db in [0.0, 15.0] {
        for targets in [Targets::None, Targets::One, Targets::Apart, Targets::Together] {
            let [told, found] =
                [&told, &found].map(|report| report.at(targets, snr_db).unwrap().clone());
            // One scene of 21 may fall to either side.
            for (a, b) in told.counted[0].iter().zip(&found.counted[0]) {
                assert!((a - b).abs() < 0.06, "{targets:?} {snr_db}: {told:?} {found:?}");
            }
            if let Some(Some(found)) = found.methods.first() {
                // The number was counted here.
                let counted = report_of(&told.counted[0], targets);
                assert!((found.found - counted).abs() < 0.06, "{found:?}");
            }
        }
    }
    // Around 35 deg every region is turned.
    let aside = doa::DoaExperiment { end_to_end: Some(flow(35.0)), ..end_to_end.clone() };
    let two = report(&aside).at(Targets::Apart, 15.0).unwrap().methods[0].clone().unwrap();
    assert!(two.success > 0.8, "{two:?}");
    // Nothing that is told can take part, nor anything that does not count stand for what does.
    let with = |entrants, flow| doa::DoaExperiment {
        axis: doa::Axis::Snr,
        entrants,
        end_to_end: Some(flow),
        ..end_to_end.clone()
    };
    let counting = doa::EndToEnd { counting: network("dnn-small-2"), ..flow(0.0) };
    for refused in [
        with(Entrants::new(vec!["MDL".into()], networks.clone()), flow(0.0)),
        with(Entrants::new(vec![], networks.clone()), flow(80.0)),
        with(Entrants::new(vec![], networks.clone()), counting),
    ] {
        let error = run(&refused, how(1, None), go).unwrap_err();
        assert!(matches!(error, EvaluateError::Core(_)), "{error:?}");
    }
}

/// The share of scenes that were counted as they are.
fn report_of(counted: &[f64; 4], targets: Targets) -> f64 {
    counted[targets.count()]
}
