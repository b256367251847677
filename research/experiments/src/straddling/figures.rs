//! Losses, errors and cost against the number of points of the grid, as SVG.

use super::GRIDS;
use super::report::{ConditionResult, GridResult, StraddlingReport};
use boresight_validate::plot::{Panel, Series, draw};

/// What is drawn of a result, if it can be.
type Value = fn(&GridResult) -> Option<f64>;

/// A row of losses and a row of errors for one target at each signal-to-noise ratio, then weak targets and cost.
/// What knows no grid is a dashed line across.
pub(super) fn straddling(report: &StraddlingReport) -> String {
    let mut panels = vec![];
    let rows: [(&str, Value, [bool; 2]); 3] = [
        ("mean straddling loss / dB", |r| positive(r.straddling_db[0]), [true; 2]),
        ("mean loss of estimated power / dB", power_loss, [true, false]),
        ("rms error of azimuth / deg", |r| positive(r.error_deg[0]), [true; 2]),
    ];
    let single = || report.conditions.iter().filter(|c| c.condition.weak_db.is_none());
    for (label, value, logarithmic) in rows {
        for condition in single() {
            let title = format!("one target, {} dB", condition.condition.snr_db);
            panels.push(panel(&title, label, logarithmic, condition, value));
        }
    }
    for condition in &report.conditions {
        if let Some(weak_db) = condition.condition.weak_db {
            let title = format!("{weak_db} dB beside 0 dB, {} dB", condition.condition.snr_db);
            let found: Value = |r| Some(r.found);
            let label = "share of weak targets found";
            panels.push(panel(&title, label, [true, false], condition, found));
        }
    }
    if let Some(condition) = report.conditions.first() {
        let cost: Value = |r| r.operations.and_then(positive);
        let label = "operations, by formula";
        panels.push(panel("cost of a snapshot", label, [true; 2], condition, cost));
    }
    draw(&panels, 2)
}

/// Losses that are worth showing: Capon's powers on one snapshot and IAA's on grids too coarse for the array are none.
fn power_loss(result: &GridResult) -> Option<f64> {
    Some(result.power_loss_db[0]).filter(|loss| (-3.0..=12.0).contains(loss))
}

fn positive(x: f64) -> Option<f64> {
    (x > 0.0).then_some(x)
}

fn panel(
    title: &str,
    y: &str,
    logarithmic: [bool; 2],
    condition: &ConditionResult,
    value: Value,
) -> Panel {
    let series = condition.methods.iter().map(|method| {
        let points = match &method.results[..] {
            [one] if one.grid.is_none() => {
                let ends = [GRIDS[0], GRIDS[GRIDS.len() - 1]];
                let across = |value| ends.map(|grid| (grid as f64, value)).to_vec();
                value(one).map_or(vec![], across)
            }
            all => all.iter().filter_map(|r| Some((r.grid? as f64, value(r)?))).collect(),
        };
        let gridless = method.results.iter().all(|r| r.grid.is_none());
        Series { name: method.name.clone(), points, dashed: gridless, marked: !gridless }
    });
    Panel {
        title: title.into(),
        x: "points of the grid".into(),
        y: y.into(),
        logarithmic,
        series: series.collect(),
        ..Panel::default()
    }
}
