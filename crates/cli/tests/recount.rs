//! The scores of the angle experiments, counted again from the answers by a program in another language.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

use common::{folder, stdout};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn recount(answers: &Path, report: &Path) -> Output {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/recount.py");
    Command::new("python3").arg(script).arg(answers).arg(report).output().unwrap()
}

#[test]
fn scores_counted_again_are_those_reported() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3");
        return;
    }
    let folder = folder("recount");
    let model = |name: &str| {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
        models.join(format!("{name}.onnx")).to_str().unwrap().to_owned()
    };
    let (of_snapshots, of_regions) = (model("learned-pursuit"), model("cnn3d-2"));
    let aoa =
        ["--validation", "2", "--methods", "iaa,iaa+hard,nomp+refined", "--model", &of_snapshots];
    let counting = model("counting");
    let doa = ["--model", &of_regions, "--model", &counting];
    for (name, trials, arguments) in [("aoa", "3", &aoa[..]), ("doa", "5", &doa[..])] {
        let [answers, report] = ["jsonl", "json"].map(|end| folder.join(format!("{name}.{end}")));
        let run = ["evaluate", name, "--trials", trials, "--seed", "7", "--json", "--answers"];
        let text = stdout(&[&run[..], &[answers.to_str().unwrap()], arguments].concat());
        std::fs::write(&report, &text).unwrap();
        let same = recount(&answers, &report);
        let said = String::from_utf8_lossy(&same.stdout).into_owned();
        println!("{name}: {said}{}", String::from_utf8_lossy(&same.stderr));
        assert!(same.status.success(), "{said}");
        // 45 conditions of 15 numbers by 5 entrants; 24 of 4 by 5 counters and of 9 by 15 methods, less some.
        let compared: usize = said.split(' ').next().unwrap().parse().unwrap();
        assert!(compared > 2000, "{said}");

        // One more hit or one less in one condition is seen.
        let mut other: Value = serde_json::from_str(&text).unwrap();
        let score = match name {
            "aoa" => &mut other["conditions"][7]["methods"][1]["best"]["f1"],
            _ => &mut other["conditions"][17]["methods"][2]["success"],
        };
        *score = (score.as_f64().unwrap() + 0.01).into();
        std::fs::write(&report, other.to_string()).unwrap();
        let differs = recount(&answers, &report);
        let said = String::from_utf8_lossy(&differs.stdout);
        assert!(!differs.status.success() && !said.contains(" 0 differ"), "{said}");
    }
}
