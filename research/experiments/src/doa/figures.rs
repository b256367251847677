//! Figures 6 to 9 of the 3D-CNN paper, as SVG.

use super::report::{BOUNDS, DoaReport, PAIRS};
use super::tally::DEVIATIONS_DEG;
use super::{Axis, SNRS_DB, Targets};

use boresight_validate::plot::{Panel, Series, draw};

const SNR: &str = "signal-to-noise ratio of a sample / dB";

/// All that there are for what changes.
pub(super) fn all(report: &DoaReport) -> Vec<String> {
    let success = success(report);
    match report.axis {
        Axis::Snr => vec![success, counting(report), rmse(report), deviation(report)],
        Axis::PowerDifference => vec![success],
    }
}

/// Methods that are drawn beside the networks; the tables have all.
const SHOWN: [&str; 8] = [
    "bartlett",
    "music",
    "music, smoothed",
    "root-music",
    "root-music, smoothed",
    "esprit",
    "maximum-likelihood",
    "joint range-angle",
];

/// A line for each of those drawn, the same ones in the same colours in every figure; without points where there are
/// none.
fn lines(report: &DoaReport, points: impl Fn(usize) -> Vec<(f64, f64)>) -> Vec<Series> {
    let network = |name: &str| report.networks.iter().any(|network| network.name == *name);
    let drawn = report.methods.iter().enumerate();
    drawn
        .filter(|(_, name)| network(name) || SHOWN.contains(&name.as_str()))
        .map(|(k, name)| Series { dashed: !network(name), ..line(name, points(k)) })
        .collect()
}

/// Figure 6: scenes counted rightly.
fn counting(report: &DoaReport) -> String {
    let panels = PAIRS.map(|(two, which)| Panel {
        title: format!("0, 1 and 2 targets, the two {which}"),
        y_limits: Some([0.0, 1.02]),
        ..panel(
            SNR,
            "share counted rightly",
            report.counters.iter().enumerate().map(|(k, name)| {
                let points = SNRS_DB.map(|snr_db| (snr_db, report.counted_rightly(k, two, snr_db)));
                line(name, points.to_vec())
            }),
        )
    });
    draw(&panels, 2)
}

/// Figure 7: error of one target's angle. Where an angle in whole degrees is never wrong there is no point.
fn rmse(report: &DoaReport) -> String {
    let methods = lines(report, |k| {
        report.over(Targets::One, k, |m| m.rmse_deg).filter(|(_, rmse)| *rmse > 0.0).collect()
    });
    let bounds = BOUNDS.into_iter().enumerate().map(|(k, name)| {
        let bounds = SNRS_DB.iter().zip(&report.bounds_deg);
        let points = bounds.map(|(snr_db, bounds)| (*snr_db, bounds[k])).collect();
        Series { dashed: true, marked: false, ..line(name, points) }
    });
    let panel = Panel {
        title: "one target".into(),
        logarithmic: [false, true],
        ..panel(SNR, "root mean square error / deg", methods.into_iter().chain(bounds))
    };
    draw(&[panel], 1)
}

/// Figure 8: both angles within 1 deg.
fn success(report: &DoaReport) -> String {
    let across = match report.axis {
        Axis::Snr => SNR,
        Axis::PowerDifference => "power of the second target over the first / dB",
    };
    let panels = PAIRS.map(|(two, which)| Panel {
        title: format!("two targets {which}"),
        y_limits: Some([0.0, 1.02]),
        ..panel(
            across,
            "share within 1 deg",
            lines(report, |k| report.over(two, k, |m| m.success).collect()).into_iter(),
        )
    });
    draw(&panels, 2)
}

/// Figure 9: accuracy of rounded angles by allowed deviation, all pairs and close ones.
fn deviation(report: &DoaReport) -> String {
    let snr_db = SNRS_DB[2];
    let mut panels = vec![];
    for close in [false, true] {
        for (two, which) in PAIRS {
            let kind = if close { "close pairs" } else { "all pairs" };
            let condition = report.at(two, snr_db);
            let lines = lines(report, |k| {
                let result = condition.and_then(|c| c.methods.get(k)).and_then(Option::as_ref);
                let shares = result.map(|m| if close { m.close_within } else { m.within });
                DEVIATIONS_DEG.into_iter().zip(shares.into_iter().flatten()).collect()
            });
            panels.push(Panel {
                title: format!("{kind} {which}, {snr_db} dB"),
                y_limits: Some([0.0, 1.02]),
                ..panel("allowed deviation / deg", "share within", lines.into_iter())
            });
        }
    }
    draw(&panels, 2)
}

fn panel(x: &str, y: &str, series: impl Iterator<Item = Series>) -> Panel {
    Panel { x: x.into(), y: y.into(), series: series.collect(), ..Panel::default() }
}

fn line(name: &str, points: Vec<(f64, f64)>) -> Series {
    Series { name: name.into(), points, dashed: false, marked: true }
}
