//! What is printed of a calibration.

use super::Calibrated;
use crate::error::CliError;
use crate::files::Files;
use boresight_formats::json;
use boresight_report::{About, Fact, Radar, facts};
use jiff::Timestamp;
use serde_json::{Value, json};

/// Length of the segments that trajectories are compared over, m.
const SEGMENT_M: f64 = 50.0;

/// The result as JSON.
pub(super) fn json(result: &Calibrated) -> Value {
    let Calibrated { sensor, options, estimate: e, track, joint, outlook, .. } = result;
    let error = track.error_m(e.angle_rad, options, SEGMENT_M).map(|estimated| {
        let nominal =
            options.nominal_rad.and_then(|angle| track.error_m(angle, options, SEGMENT_M));
        json!({ "segmentM": SEGMENT_M, "estimatedM": estimated, "nominalM": nominal })
    });
    let further = json!({
        "sensor": sensor,
        "joint": joint,
        "method": options.method.name(),
        "motion": options.motion_method().name(),
        "nominalDeg": options.nominal_rad.map(f64::to_degrees),
        "covariance": e.covariance,
        "trajectoryError": error,
        "outlook": outlook.as_ref().map(json::result),
    });
    json::beside(e, further)
}

/// The report as a page of HTML.
pub(super) fn page(results: &[Calibrated], files: &Files) -> Result<String, CliError> {
    let about = About {
        made: Timestamp::now().strftime("%Y-%m-%d %H:%M UTC").to_string(),
        version: env!("CARGO_PKG_VERSION").into(),
        asked: std::env::args().collect::<Vec<_>>().join(" "),
        sources: files.sources()?,
    };
    let radars: Vec<Radar> = results
        .iter()
        .map(|result| Radar {
            sensor: result.sensor,
            joint: result.joint,
            options: &result.options,
            estimate: &result.estimate,
            outlook: result.outlook.as_ref(),
            recorder: &result.recorder,
        })
        .collect();
    Ok(boresight_report::page(&about, &radars))
}

/// The result as text.
pub(super) fn text(result: &Calibrated) -> String {
    let Calibrated { sensor, options, estimate: e, track, joint, outlook, .. } = result;
    let mut text = format!(
        "sensor       {sensor}, {}{}\n",
        options.method.title(),
        if *joint { ", with all radars" } else { "" },
    );
    for Fact { name, value } in facts(e) {
        text += &format!("{name:13}{value}\n");
    }
    if let Some(error) = track.error_m(e.angle_rad, options, SEGMENT_M) {
        text += &format!("trajectory   {error:.2} m off at the end of {SEGMENT_M} m, on average");
        let nominal =
            options.nominal_rad.and_then(|angle| track.error_m(angle, options, SEGMENT_M));
        if let Some(error) = nominal {
            text += &format!("; {error:.2} m by the nominal angle");
        }
        text += "\n";
    }
    if let Some(outlook) = outlook {
        text += &format!("next         {}\n", outlook.advice);
    }
    for remark in &e.remarks {
        text += &format!("warning      {remark}\n");
    }
    text
}
