//! Probability of resolution against separation, as SVG.

use super::SNRS_DB;
use super::report::{ResolutionReport, counted};
use boresight_validate::plot::{Panel, Series, draw};

/// A panel a condition: a row a signal-to-noise ratio, a column a number of snapshots.
pub(super) fn probabilities(report: &ResolutionReport) -> String {
    let rows = SNRS_DB.iter().flat_map(|snr_db| {
        report.conditions.iter().filter(move |condition| condition.snr_db == *snr_db)
    });
    let panels: Vec<Panel> = rows
        .map(|condition| {
            let line = |name: &str, shares: &[f64], dashed| Series {
                name: name.into(),
                points: report.separations.iter().copied().zip(shares.iter().copied()).collect(),
                dashed,
                marked: !dashed,
            };
            let mut series = vec![];
            // Methods that are smoothed with one snapshot go under their plain name, so that all panels share a
            // legend.
            for name in names(report) {
                let method =
                    condition.methods.iter().find(|m| m.name.trim_end_matches(SMOOTHED) == name);
                series.push(line(name, method.map_or(&[], |m| &m.resolved), false));
            }
            series.push(line("estimator at the bound", &condition.efficient, true));
            Panel {
                title: format!("{}, {} dB", counted(condition.snapshots), condition.snr_db),
                x: "separation / beam widths".into(),
                y: "share resolved".into(),
                y_limits: Some([0.0, 1.02]),
                series,
                ..Panel::default()
            }
        })
        .collect();
    draw(&panels, panels.len() / SNRS_DB.len())
}

const SMOOTHED: &str = ", smoothed";

/// Methods of any condition.
fn names(report: &ResolutionReport) -> Vec<&str> {
    let mut names: Vec<&str> = vec![];
    for method in report.conditions.iter().flat_map(|condition| &condition.methods) {
        let name = method.name.trim_end_matches(SMOOTHED);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}
