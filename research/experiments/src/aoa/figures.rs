//! Figures 4 and 5 of the AAETR paper, as SVG.

use super::TARGETS;
use super::report::{AoaReport, MethodResult};
use boresight_validate::plot::{Panel, Series, draw};

/// Figure 4: precision against recall at the highest signal-to-noise ratio.
pub fn precision_recall(report: &AoaReport) -> String {
    let snr_db = report.snrs_db().last().copied().unwrap_or(f64::NAN);
    let targets = report.targets();
    // The paper's six panels of its nine numbers of targets, or all.
    let panels: Vec<Panel> = targets
        .iter()
        .copied()
        .filter(|n| targets != TARGETS || [2, 4, 6, 8, 9, 10].contains(n))
        .map(|targets| Panel {
            title: format!("{targets} targets, {snr_db} dB"),
            x: "recall".into(),
            y: "precision".into(),
            y_limits: Some([0.5, 1.01]),
            series: lines(report, |k| {
                let result = report.at(targets, snr_db, k);
                result.map_or(vec![], |m| m.curve.iter().map(|p| (p.recall, p.precision)).collect())
            }),
            ..Panel::default()
        })
        .collect();
    draw(&panels, 2)
}

/// Figure 5: what is missing of F1 at its largest and at one threshold, and the errors at the largest, against the number
/// of targets.
pub fn scores(report: &AoaReport) -> String {
    type Value = fn(&MethodResult) -> Option<f64>;
    let rows: [(&str, Value); 4] = [
        ("1 - largest F1", |m| m.best.map(|best| 1.0 - best.f1)),
        ("1 - F1 at one threshold", |m| m.at_one_threshold.map(|one| 1.0 - one.f1)),
        ("mean error of angle / deg", |m| m.best.map(|best| best.angle_error_deg)),
        ("mean error of power / dB", |m| m.best.map(|best| best.power_error_db)),
    ];
    let mut panels = vec![];
    let (targets, snrs_db) = (report.targets(), report.snrs_db());
    let mut ends: Vec<f64> = snrs_db.first().into_iter().chain(snrs_db.last()).copied().collect();
    ends.dedup();
    for (label, value) in rows {
        for &snr_db in &ends {
            panels.push(Panel {
                title: format!("{snr_db} dB"),
                x: "targets".into(),
                y: label.into(),
                logarithmic: [false, true],
                series: lines(report, |k| {
                    let point = |&n: &usize| {
                        let value = report.at(n, snr_db, k).and_then(value)?;
                        (value > 0.0).then_some((n as f64, value))
                    };
                    targets.iter().filter_map(point).collect()
                }),
                ..Panel::default()
            });
        }
    }
    draw(&panels, 2)
}

fn lines(report: &AoaReport, points: impl Fn(usize) -> Vec<(f64, f64)>) -> Vec<Series> {
    let line = |(k, name): (usize, &String)| Series {
        name: name.clone(),
        points: points(k),
        dashed: name.contains("refined"),
        marked: false,
    };
    report.methods.iter().enumerate().map(line).collect()
}
