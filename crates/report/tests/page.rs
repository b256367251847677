//! The page of a short drive.

#![allow(clippy::unwrap_used)]

use boresight_core::{Detection, Random};
use boresight_mounting::{CalibrationOptions, Calibrator, FrameInput, Method};
use boresight_report::{About, Radar, Recorder, Source, facts, page, sentence};

const YAW: f64 = 0.4;

/// A car on a road with bends, for a minute, seen by a radar at (3.8, 0.5).
fn drive(mut each: impl FnMut(FrameInput)) {
    let mut random = Random::new(1, 0);
    for i in 0..800 {
        let time_s = f64::from(i) / 13.0;
        let (v, w) = (12.0, 0.1 * (0.5 * time_s).sin());
        let (sin, cos) = YAW.sin_cos();
        let car = [v - w * 0.5, w * 3.8];
        let own = [cos * car[0] + sin * car[1], cos * car[1] - sin * car[0]];
        let detections: Vec<Detection> = (0..60)
            .map(|_| {
                let azimuth = random.uniform(-1.0, 1.0);
                let rate = -own[0] * azimuth.cos() - own[1] * azimuth.sin();
                Detection {
                    azimuth_rad: (azimuth + 0.006 * random.normal()) as f32,
                    range_rate_mps: (rate + 0.08 * random.normal()) as f32,
                    range_m: f32::NAN,
                    rcs_dbsm: f32::NAN,
                }
            })
            .collect();
        each(FrameInput {
            time_s,
            detections: &detections,
            yaw_rate_radps: Some(w),
            speed_mps: Some(v),
        });
    }
}

fn options(nominal: f64) -> CalibrationOptions {
    CalibrationOptions {
        method: Method::Recursive,
        x_m: 3.8,
        y_m: 0.5,
        nominal_rad: Some(nominal),
        slip_gradient_rad: 0.0,
        ..CalibrationOptions::default()
    }
}

fn report(nominal: f64) -> String {
    let options = options(nominal);
    let mut calibrator = Calibrator::new(options).unwrap();
    let mut recorder = Recorder::default();
    drive(|frame| {
        let outcome = calibrator.add(frame).unwrap();
        recorder.add(&frame, &outcome);
        recorder.look(frame.time_s, &calibrator.estimate());
    });
    let estimate = calibrator.estimate();
    let outlook = calibrator.outlook();
    let about = About {
        made: "2026-01-02".into(),
        version: "9.9".into(),
        asked: "boresight calibrate <a>&b".into(),
        sources: vec![Source { name: "<x>.csv".into(), bytes: 3, sha256: "ba78".into() }],
    };
    let radar = Radar {
        sensor: 3,
        joint: false,
        options: &options,
        estimate: &estimate,
        outlook: outlook.as_ref(),
        recorder: &recorder,
    };
    page(&about, &[radar])
}

#[test]
fn a_page_says_what_came_out_and_where_from() {
    let html = report(YAW + 0.003);
    assert!(html.contains("Pass: aligned") && html.contains("1.00 deg are allowed"), "{html}");
    assert!(html.contains("<tr><th>Angle</th><td>22.9"), "{html}");
    assert!(html.contains("0.73 km") || html.contains("0.74 km"), "{html}");
    assert!(html.contains("angle / deg") && html.contains("yaw rate / (deg/s)"));
    // Nothing of the caller's is read as HTML, and nothing is asked for from elsewhere.
    assert!(html.contains("&lt;x&gt;.csv") && html.contains("&lt;a&gt;&amp;b"));
    assert!(!html.contains("<x>") && !html.contains("src=") && !html.contains("href="));
    assert!(!html.contains("NaN") && !html.contains("inf"), "{html}");
    assert_eq!(html.matches("<section>").count(), html.matches("</section>").count());
}

#[test]
fn verdicts_are_those_of_the_estimate() {
    assert!(report(YAW + 0.05).contains("Fail: misaligned"));
    assert!(report(YAW + 1.001_f64.to_radians()).contains("Undecided"));
}

#[test]
fn a_drive_without_a_frame_has_a_page_too() {
    let options = options(YAW);
    let estimate = Calibrator::new(options).unwrap().estimate();
    let radar = Radar {
        sensor: 1,
        joint: false,
        options: &options,
        estimate: &estimate,
        outlook: None,
        recorder: &Recorder::default(),
    };
    let html = page(&About::default(), &[radar]);
    assert!(html.contains("does not tell the angle") && html.contains("Undecided"), "{html}");
    assert!(facts(&estimate).iter().any(|fact| fact.value.contains("not determined")));
    let none = CalibrationOptions { nominal_rad: None, ..options };
    assert_eq!(sentence(&estimate, &none), None);
}
