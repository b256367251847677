//! The plots of a report.

use crate::Recorder;
use boresight_calibrate::{AngleEstimate, CalibrationOptions};
use boresight_plot::{Axes, Panel, PlotError, Series, draw};

/// The angle against time with its standard deviation, the nominal angle and the limits of the alarm.
pub(crate) fn angle(
    recorder: &Recorder,
    e: &AngleEstimate,
    options: &CalibrationOptions,
) -> Result<String, PlotError> {
    let last = e.angle_rad.to_degrees();
    let sigma = Some(e.sigma_rad.to_degrees()).filter(|sigma| sigma.is_finite()).unwrap_or(1.0);
    let nominal = options.nominal_rad.map(f64::to_degrees);
    let alarm = options.alarm_rad.to_degrees();
    let off = nominal.map_or(0.0, |nominal| (last - nominal).abs() + alarm);
    let reach = 1.15 * off.max(4.0 * sigma).max(0.2);
    let limits = [last - reach, last + reach];
    let shown = |y: f64| (limits[0]..=limits[1]).contains(&y);
    let end_s = recorder.history().last().map_or(1.0, |point| point[0]);
    let curve = |name: &str, dashed: bool, of: &dyn Fn([f64; 3]) -> f64| Series {
        name: name.into(),
        points: recorder
            .history()
            .map(|point| (point[0], of(point)))
            .filter(|(_, y)| shown(*y))
            .collect(),
        dashed,
        marked: false,
    };
    let level = |name: &str, dashed: bool, y: f64| Series {
        name: name.into(),
        points: if shown(y) { vec![(0.0, y), (end_s, y)] } else { vec![] },
        dashed,
        marked: false,
    };
    let mut series = vec![
        curve("angle", false, &|[_, angle, _]| angle),
        curve("one standard deviation more", true, &|[_, angle, sigma]| angle + sigma),
        curve("and less", true, &|[_, angle, sigma]| angle - sigma),
    ];
    if let Some(nominal) = nominal {
        series.push(level("nominal", false, nominal));
        series.push(level("limits", true, nominal - alarm));
        series.push(level("", true, nominal + alarm));
    }
    let panel = Panel {
        title: "Angle as the drive went".into(),
        x: "time / s".into(),
        y: "angle / deg".into(),
        axes: Axes::Linear,
        y_limits: Some(limits),
        series,
    };
    draw(&[panel], 1)
}

/// Speed and yaw rate of the car against time.
pub(crate) fn drive(recorder: &Recorder) -> Result<String, PlotError> {
    let panel = |which: usize, title: &str, y: &str| Panel {
        title: title.into(),
        x: "time / s".into(),
        y: y.into(),
        axes: Axes::Linear,
        y_limits: None,
        series: vec![Series {
            name: "as measured".into(),
            points: recorder
                .states()
                .map(|point| (point[0], point[which]))
                .filter(|(_, y)| y.is_finite())
                .collect(),
            dashed: false,
            marked: false,
        }],
    };
    let panels = [panel(1, "Speed", "speed / (m/s)"), panel(2, "Yaw rate", "yaw rate / (deg/s)")];
    draw(&panels, 2)
}
