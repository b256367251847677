//! The plots of a report.

use crate::chart::{Chart, Mark, SIZE};
use crate::recorder::Recorder;
use boresight_mounting::{AngleEstimate, CalibrationOptions};
use maud::{Markup, html};

/// The angle against time with its standard deviation, the nominal angle and the limits of the alarm.
pub(crate) fn angle(
    recorder: &Recorder,
    e: &AngleEstimate,
    options: &CalibrationOptions,
    id: &str,
) -> Markup {
    let last = e.angle_rad.to_degrees();
    let sigma = Some(e.sigma_rad.to_degrees()).filter(|sigma| sigma.is_finite()).unwrap_or(1.0);
    let nominal = options.nominal_rad.map(f64::to_degrees);
    let alarm = options.alarm_rad.to_degrees();
    let off = nominal.map_or(0.0, |nominal| (last - nominal).abs() + alarm);
    let reach = 1.15 * off.max(4.0 * sigma).max(0.2);
    let told = || recorder.history().filter(|[_, _, sigma]| sigma.is_finite());
    let mut marks = vec![
        Mark::Band(
            "band",
            told().map(|[time, angle, sigma]| [time, angle - sigma, angle + sigma]).collect(),
        ),
        Mark::Line("line", told().map(|[time, angle, _]| [time, angle]).collect()),
    ];
    if let Some(nominal) = nominal {
        marks.push(Mark::Level("level", nominal));
        marks.push(Mark::Level("limit", nominal - alarm));
        marks.push(Mark::Level("limit", nominal + alarm));
    }
    Chart {
        title: "Angle against time, with its standard deviation, the nominal angle and the limits"
            .into(),
        axes: ["time / s", "angle / deg"],
        logarithmic: [false; 2],
        limits: Some([last - reach, last + reach]),
        size: SIZE,
        marks,
    }
    .svg(id)
}

/// Speed and yaw rate of the car against time.
pub(crate) fn drive(recorder: &Recorder, id: &str) -> Markup {
    let chart = |which: usize, title: &str, y: &'static str| {
        let points = recorder.states().map(|point| [point[0], point[which]]).collect();
        Chart {
            title: title.into(),
            axes: ["time / s", y],
            logarithmic: [false; 2],
            limits: None,
            size: SIZE,
            marks: vec![Mark::Line("line", points)],
        }
        .svg(&format!("{id}-{which}"))
    };
    html! {
        (chart(1, "Speed against time", "speed / (m/s)"))
        (chart(2, "Yaw rate against time", "yaw rate / (deg/s)"))
    }
}
