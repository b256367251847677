//! What is missing of the score in each group of conditions, as SVG.

use super::conditions::Group;
use super::report::{ConditionResult, HardReport};
use boresight_validate::plot::{Panel, Series, draw};

/// Smallest share that is drawn: no error in the usual number of targets.
const LEAST: f64 = 1e-4;

/// Noise with 6 targets, numbers of targets and separation at 25 dB, and short uniform arrays with 2 targets at 25 dB.
pub(super) fn hard(report: &HardReport) -> String {
    type Abscissa = fn(&ConditionResult) -> Option<f64>;
    let panels: [(Group, &str, &str, Abscissa); 4] = [
        (Group::Noise, "lrr48, 6 targets", "signal-to-noise ratio / dB", |c| {
            (c.targets == 6).then_some(c.snr_db)
        }),
        (Group::Targets, "lrr48, 25 dB", "targets", |c| {
            (c.snr_db == 25.0).then_some(c.targets as f64)
        }),
        (Group::Pairs, "lrr48, 2 targets, 25 dB", "separation / beamwidths", |c| {
            c.pair_beams.filter(|_| c.snr_db == 25.0)
        }),
        (Group::Arrays, "uniform arrays, 2 targets, 25 dB", "elements", |c| {
            let elements = c.array.strip_prefix("ula")?.parse().ok()?;
            (c.targets == 2 && c.snr_db == 25.0).then_some(elements)
        }),
    ];
    let panel = |(group, title, x, abscissa): (Group, &str, &str, Abscissa)| Panel {
        title: title.into(),
        x: x.into(),
        y: "1 - largest strict F1".into(),
        logarithmic: [false, true],
        series: report
            .methods
            .iter()
            .enumerate()
            .map(|(k, name)| Series {
                name: name.clone(),
                points: report
                    .of_group(group)
                    .filter_map(|c| Some((abscissa(c)?, (1.0 - c.strict_f1(k)?).max(LEAST))))
                    .collect(),
                dashed: name.contains("refined"),
                marked: true,
            })
            .collect(),
        ..Panel::default()
    };
    draw(&panels.map(panel), 2)
}
