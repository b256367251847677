//! Figures 6 to 9 of the 3D-CNN paper, as SVG.

use super::report::{BOUNDS, PAIRS, Report};
use super::trial::{COUNTERS, DEVIATIONS_DEG};
use super::{SNRS_DB, Targets};
use crate::EvaluateError;
use crate::plot::{Axes, Panel, Series, draw};

const SNR: &str = "signal-to-noise ratio of a sample / dB";

pub(super) fn all(report: &Report) -> Result<Vec<(&'static str, String)>, EvaluateError> {
    Ok(vec![
        ("doa-counting.svg", counting(report)?),
        ("doa-rmse.svg", rmse(report)?),
        ("doa-success.svg", success(report)?),
        ("doa-deviation.svg", deviation(report)?),
    ])
}

/// Figure 6: scenes counted rightly.
fn counting(report: &Report) -> Result<String, EvaluateError> {
    let panels = PAIRS.map(|(two, which)| Panel {
        title: format!("0, 1 and 2 targets, the two {which}"),
        y_limits: Some([0.0, 1.02]),
        ..panel(
            SNR,
            "share counted rightly",
            (0..COUNTERS.len()).map(|k| {
                let points = SNRS_DB.map(|snr_db| (snr_db, report.counted_rightly(k, two, snr_db)));
                line(COUNTERS[k].0, points.to_vec(), k)
            }),
        )
    });
    draw(&panels, 2)
}

/// Figure 7: error of one target's angle.
fn rmse(report: &Report) -> Result<String, EvaluateError> {
    let methods =
        report.methods.iter().enumerate().map(|(k, name)| {
            line(name, report.over_snr(Targets::One, k, |m| m.rmse_deg).collect(), k)
        });
    let bounds = BOUNDS.into_iter().enumerate().map(|(k, name)| {
        let bounds = SNRS_DB.iter().zip(&report.bounds_deg);
        let points = bounds.map(|(snr_db, bounds)| (*snr_db, bounds[k])).collect();
        Series { dashed: true, marked: false, ..line(name, points, k) }
    });
    let panel = Panel {
        title: "one target".into(),
        axes: Axes::LogOrdinate,
        ..panel(SNR, "root mean square error / deg", methods.chain(bounds))
    };
    draw(&[panel], 1)
}

/// Figure 8: both angles within 1 deg.
fn success(report: &Report) -> Result<String, EvaluateError> {
    let panels =
        PAIRS.map(|(two, which)| Panel {
            title: format!("two targets {which}"),
            y_limits: Some([0.0, 1.02]),
            ..panel(
                SNR,
                "share within 1 deg",
                report.methods.iter().enumerate().map(|(k, name)| {
                    line(name, report.over_snr(two, k, |m| m.success).collect(), k)
                }),
            )
        });
    draw(&panels, 2)
}

/// Figure 9: accuracy of rounded angles by allowed deviation, all pairs and close ones.
fn deviation(report: &Report) -> Result<String, EvaluateError> {
    let snr_db = SNRS_DB[2];
    let mut panels = vec![];
    for close in [false, true] {
        for (two, which) in PAIRS {
            let kind = if close { "close pairs" } else { "all pairs" };
            let condition = report.at(two, snr_db);
            let lines = report.methods.iter().enumerate().map(|(k, name)| {
                let shares = condition.and_then(|c| c.methods.get(k)).map(|m| match close {
                    true => m.close_within,
                    false => m.within,
                });
                let points = DEVIATIONS_DEG.into_iter().zip(shares.into_iter().flatten());
                line(name, points.collect(), k)
            });
            panels.push(Panel {
                title: format!("{kind} {which}, {snr_db} dB"),
                y_limits: Some([0.0, 1.02]),
                ..panel("allowed deviation / deg", "share within", lines)
            });
        }
    }
    draw(&panels, 2)
}

fn panel(x: &str, y: &str, series: impl Iterator<Item = Series>) -> Panel {
    Panel {
        title: String::new(),
        x: x.into(),
        y: y.into(),
        axes: Axes::Linear,
        y_limits: None,
        series: series.collect(),
    }
}

/// A line; beyond as many as there are colours they are dashed.
fn line(name: &str, points: Vec<(f64, f64)>, index: usize) -> Series {
    Series { name: name.into(), points, dashed: index >= 12, marked: true }
}
