//! A sweep run in parts and put together is the sweep run at once, byte for byte.

#![allow(clippy::unwrap_used)]

mod support;

use boresight_cli::street::CHAIN;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_experiments::{
    Entrants, EvaluateError, aoa, calibration, doa, images, imperfections, merge, near_field,
    resolution, straddling,
};
use boresight_fleet::Part;
use boresight_validate::ValidateError;
use boresight_validate::experiment::{Experiment, How, run_outcome, run_part};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use support::merged;

fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("boresight-merge-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn part<E: Experiment>(options: &E, number: u64, of: u64, folder: &Path) -> usize {
    let how = How { threads: 2, folder: Some(folder) };
    let part = Part::new(number, of).unwrap();
    run_part(options, how, part, |_| ControlFlow::Continue(())).unwrap()
}

/// Runs at once and in three parts, two of them in one folder.
fn check<E: Experiment>(options: &E) {
    let root = folder(E::NAME);
    let how = How { threads: 1, folder: Some(&root) };
    let at_once = run_outcome(options, how, |_| ControlFlow::Continue(())).unwrap();
    let [a, b, out] = ["a", "b", "out"].map(|name| root.join(name));
    let records = part(options, 1, 3, &a) + part(options, 3, 3, &a) + part(options, 2, 3, &b);
    assert_eq!(records as u64, options.scenes());
    // Compared without printing: outcomes are long.
    assert!(merged(&[a, b], &out) == at_once);
    let name = Part::WHOLE.file_name(E::NAME);
    let sorted = |folder: &Path| {
        let text = std::fs::read_to_string(folder.join(&name)).unwrap();
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        lines[1..].sort();
        lines
    };
    assert!(sorted(&out) == sorted(&root));
    // What was put together can be put together again.
    assert!(merged(&[out.join(&name)], &out) == at_once);
    std::fs::remove_dir_all(root).unwrap();
}

fn aoa_options(seed: u64) -> aoa::AoaExperiment {
    let imperfections = ImperfectionSpread { phase_rad: 0.1, ..ImperfectionSpread::default() };
    let entrants = Entrants::new(vec!["iaa".into(), "nomp+refined".into()], vec![]);
    aoa::AoaExperiment {
        array: "ula8".into(),
        trials: 3,
        validation: 2,
        seed,
        imperfections,
        entrants,
        ..aoa::AoaExperiment::default()
    }
}

#[test]
fn parts_make_the_whole() {
    check(&aoa_options(1));
    check(&calibration::CalibrationExperiment {
        scenes: 2,
        seed: 3,
        duration_s: 12.0,
        standing: false,
    });
    let setup = doa::Setup::Simulation;
    let entrants = Entrants::new(doa::default_methods(setup).unwrap(), vec![]);
    check(&doa::DoaExperiment {
        setup,
        axis: doa::Axis::Snr,
        trials: 1,
        seed: 1,
        entrants,
        end_to_end: None,
    });
    let entrants = Entrants::new(vec![CHAIN.into()], vec![]);
    check(&images::ImagesExperiment { streets: 2, seed: 1, entrants });
    let (array, snapshots) = ("ula4".into(), vec![1, 3]);
    check(&resolution::ResolutionExperiment { array, snapshots, trials: 1, seed: 1 });
    let (array, entrants) = ("ula16".into(), Entrants::new(vec!["nomp".into()], vec![]));
    check(&near_field::NearFieldExperiment { array, snr_db: 20.0, trials: 1, seed: 1, entrants });
    let (array, entrants) = ("ula8".into(), Entrants::new(vec!["bartlett".into()], vec![]));
    check(&straddling::StraddlingExperiment { array, trials: 1, seed: 1, entrants });
    let (array, entrants) = ("ula8".into(), Entrants::new(vec!["iaa".into()], vec![]));
    check(&imperfections::ImperfectionsExperiment {
        array,
        snr_db: 15.0,
        trials: 1,
        seed: 1,
        entrants,
    });
}

#[test]
fn parts_that_do_not_go_together_are_refused() {
    let root = folder("refused");
    let [a, b, c] = ["a", "b", "c"].map(|name| root.join(name));
    part(&aoa_options(1), 1, 2, &a);
    let missing = merge(std::slice::from_ref(&a));
    let scenes = aoa_options(1).scenes() as usize;
    assert!(
        matches!(missing, Err(EvaluateError::Run(ValidateError::Incomplete { missing, first: 1, .. })) if missing == scenes / 2),
        "{missing:?}"
    );
    // Another seed.
    part(&aoa_options(2), 2, 2, &b);
    let other = merge(&[a.clone(), b]);
    assert!(matches!(other, Err(EvaluateError::Run(ValidateError::OtherRun { .. }))), "{other:?}");
    // The same scenes twice are fine, with other records they are not, and records of another version are
    // not those of this one.
    part(&aoa_options(1), 2, 2, &c);
    let file = a.join("aoa-1-of-2.jsonl");
    let text = std::fs::read_to_string(&file).unwrap();
    let copy = c.join("copy.jsonl");
    std::fs::write(&copy, &text).unwrap();
    merge(&[a.clone(), c.clone()]).unwrap();
    std::fs::write(&copy, text.replacen("\"score\":{\"targets\":", "\"score\":{\"targets\":1", 1))
        .unwrap();
    let conflict = merge(&[a.clone(), c.clone()]);
    assert!(
        matches!(conflict, Err(EvaluateError::Run(ValidateError::Conflict { .. }))),
        "{conflict:?}"
    );
    std::fs::remove_file(copy).unwrap();
    for file in [file, c.join("aoa-2-of-2.jsonl")] {
        let text = std::fs::read_to_string(&file).unwrap();
        let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
        assert!(text.contains(&version));
        std::fs::write(&file, text.replacen(&version, "\"version\":\"0.0.0\"", 1)).unwrap();
    }
    let version = merge(&[a, c]);
    assert!(
        matches!(version, Err(EvaluateError::Run(ValidateError::OtherRun { .. }))),
        "{version:?}"
    );
    let nothing = merge(std::slice::from_ref(&root));
    assert!(matches!(nothing, Err(EvaluateError::Run(ValidateError::Core(_)))), "{nothing:?}");
    assert!(matches!(
        merge(&[root.join("x")]),
        Err(EvaluateError::Run(ValidateError::File { .. }))
    ));
    std::fs::remove_dir_all(root).unwrap();
}
