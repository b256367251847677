//! What is printed of a calibration.

use super::Calibrated;
use super::track::SEGMENT_M;
use crate::json;
use boresight_calibrate::AngleEstimate;
use serde_json::{Value, json};

/// The result as JSON.
pub(super) fn json(result: &Calibrated) -> Value {
    let Calibrated { sensor, options, estimate: e, track, joint } = result;
    let error = track.error_m(e.angle_rad, options).map(|estimated| {
        let nominal = options.nominal_rad.and_then(|angle| track.error_m(angle, options));
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
    });
    json::beside(e, further)
}

/// What was estimated of the car beside the angle.
fn car(e: &AngleEstimate) -> String {
    let line = |name: &str, value: f64, sigma: f64, digits: usize, unit: &str| {
        if sigma > 0.0 {
            format!("{name:13}{value:.digits$} +- {sigma:.digits$}{unit}\n")
        } else {
            String::new()
        }
    };
    [
        line(
            "slip",
            e.slip_gradient_rad.to_degrees(),
            e.slip_gradient_sigma_rad.to_degrees(),
            3,
            " deg/(m/s^2)",
        ),
        line("delay", 1e3 * e.delay_s, 1e3 * e.delay_sigma_s, 0, " ms"),
        line("speed scale", e.speed_scale, e.speed_scale_sigma, 4, ""),
        e.changed_s.map_or(String::new(), |time| format!("changed      at {time:.1} s\n")),
    ]
    .concat()
}

/// The result as text.
pub(super) fn text(result: &Calibrated) -> String {
    let Calibrated { sensor, options, estimate: e, track, joint } = result;
    let within = |value: String, sigma: f64, digits: usize| {
        if sigma == f64::INFINITY {
            format!("{value}, not determined")
        } else {
            format!("{value} +- {sigma:.digits$}")
        }
    };
    let angle = within(format!("{:.3}", e.angle_rad.to_degrees()), e.sigma_rad.to_degrees(), 3);
    let scale = within(format!("{:.4}", e.scale), e.scale_sigma, 4);
    let bias =
        within(format!("{:.3}", e.bias_radps.to_degrees()), e.bias_sigma_radps.to_degrees(), 3);
    let f = e.frames;
    let mut text = format!(
        "sensor       {sensor}, {}{}\nangle        {angle} deg\nscale        {scale}\nbias         {bias} deg/s\n\
{}inliers      {:.1} %\nframes       {} of {} used; {} standing, {} slow, {} turning, {} sparse, {} off the measured \
         speed, {} without motion\nconverged    {}\n",
        options.method.title(),
        if *joint { ", with all radars" } else { "" },
        car(e),
        100.0 * e.inlier_share,
        f.used,
        f.given,
        f.standing,
        f.slow,
        f.turning,
        f.sparse,
        f.off_speed,
        f.without_motion,
        if e.converged { "yes" } else { "no" },
    );
    if let Some(error) = track.error_m(e.angle_rad, options) {
        text += &format!("trajectory   {error:.2} m off at the end of {SEGMENT_M} m, on average");
        let nominal = options.nominal_rad.and_then(|angle| track.error_m(angle, options));
        if let Some(error) = nominal {
            text += &format!("; {error:.2} m by the nominal angle");
        }
        text += "\n";
    }
    for remark in &e.remarks {
        text += &format!("warning      {remark}\n");
    }
    text
}
