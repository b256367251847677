//! The scores of the angle experiments, counted again from the answers by a program in another language.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

use common::{folder, model, stdout};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn recount(answers: &Path, report: &Path) -> Output {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("recount.py");
    Command::new("python3").arg(script).arg(answers).arg(report).output().unwrap()
}

#[test]
fn scores_counted_again_are_those_reported() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3");
        return;
    }
    let folder = folder("recount");
    let (of_snapshots, of_regions) = (model("learned-pursuit"), model("cnn3d-2"));
    let aoa =
        ["--validation", "2", "--methods", "iaa,iaa+hard,nomp+refined", "--model", &of_snapshots];
    let counting = model("counting");
    let doa = ["--model", &of_regions, "--model", &counting];
    let one = model("dnn-small-1");
    let flow = [&doa[..], &["--model", &one, "--regions", "end-to-end"]].concat();
    for (name, file, trials, arguments) in
        [("aoa", "aoa", "3", &aoa[..]), ("doa", "doa", "5", &doa), ("doa", "flow", "3", &flow)]
    {
        let [answers, report] = ["jsonl", "json"].map(|end| folder.join(format!("{file}.{end}")));
        let run = [name, "--trials", trials, "--seed", "7", "--json", "--answers"];
        let text = stdout(&[&run[..], &[answers.to_str().unwrap()], arguments].concat());
        std::fs::write(&report, &text).unwrap();
        let same = recount(&answers, &report);
        let said = String::from_utf8_lossy(&same.stdout).into_owned();
        println!("{file}: {said}{}", String::from_utf8_lossy(&same.stderr));
        assert!(same.status.success(), "{said}");
        // 45 conditions of 15 numbers by 5 entrants; 24 of 4 by 5 counters and of 9 by 15 methods, less some; from end
        // to end 24 of 4 by one counter, and 18 of 9 by one network each.
        let compared: usize = said.split(' ').next().unwrap().parse().unwrap();
        assert!(compared > if file == "flow" { 200 } else { 2000 }, "{said}");

        // One more hit or one less in one condition is seen.
        let mut other: Value = serde_json::from_str(&text).unwrap();
        let score = match name {
            "aoa" => &mut other["conditions"][7]["methods"][1]["best"]["f1"],
            _ => {
                let methods = other["conditions"][17]["methods"].as_array_mut().unwrap();
                &mut methods.iter_mut().rev().find(|of| !of.is_null()).unwrap()["success"]
            }
        };
        *score = (score.as_f64().unwrap() + 0.01).into();
        std::fs::write(&report, other.to_string()).unwrap();
        let differs = recount(&answers, &report);
        let said = String::from_utf8_lossy(&differs.stdout);
        assert!(!differs.status.success() && !said.contains(" 0 differ"), "{said}");
    }
}
