//! A drive, served to viewers.
#![allow(clippy::unwrap_used)]

mod viewer;

use boresight_live::foxglove::{Play, ServeOptions};
use serde_json::{Value, json};
use viewer::{Viewer, drive, serve, setup};

const SDK: &str = "foxglove.sdk.v1";
const V1: &str = "foxglove.websocket.v1";
const FAST: f64 = 1e6;

/// Radar 1's angles in the messages of a drive that nobody serves, in order.
fn angles(log: &boresight_core::DriveLog) -> Vec<Value> {
    let mut play = Play::new(log, &[], setup(log, true)).unwrap();
    let channels = play.channels().to_vec();
    let mut out = vec![];
    play.begin(&mut out).unwrap();
    while play.step(&mut out).unwrap() {}
    out.iter()
        .filter(|message| channels[message.channel].topic == "/radar/1/mounting")
        .map(|message| serde_json::from_slice(&message.data).unwrap())
        .collect()
}

#[test]
fn a_viewer_gets_all_messages_in_order_and_the_angle_of_a_calibration() {
    let log = drive(400);
    let expected = angles(&log);
    let counts = serve(&log, ServeOptions { rate: FAST, ..ServeOptions::default() }, |address| {
        let mut viewer = Viewer::new(address, V1);
        assert_eq!(
            viewer.others[0]["capabilities"],
            json!(["time", "parameters", "parametersSubscribe"])
        );
        viewer.subscribe(|_| true);
        viewer.until(|viewer| viewer.of("/radar/1/mounting").len() == expected.len());
        viewer.until(|viewer| viewer.of("/car/motion").len() == log.motion.len());
        for (topic, count) in [
            ("/radar/1/detections", 200),
            ("/radar/2/detections", 200),
            ("/radar/2/frame", 200),
            ("/car/transform", log.motion.len()),
            ("/car/scene", 1),
        ] {
            assert_eq!(viewer.of(topic).len(), count, "{topic}");
        }
        let got: Vec<&Value> = viewer.of("/radar/1/mounting").iter().map(|(_, m)| m).collect();
        assert_eq!(got, expected.iter().collect::<Vec<_>>());
        let last = got[got.len() - 1];
        let nominal_deg = 0.5_f64.to_degrees();
        assert!((last["angleDeg"].as_f64().unwrap() - nominal_deg - 2.0).abs() < 0.05, "{last}");
        assert_eq!(last["alignment"], "misaligned");
        let transform = &viewer.of("/radar/1/transform").last().unwrap().1;
        let turn = 2.0 * transform["rotation"]["z"].as_f64().unwrap().asin().to_degrees();
        assert!((turn - last["angleDeg"].as_f64().unwrap()).abs() < 1e-9, "{transform}");
        let times: Vec<u64> = viewer.of("/radar/2/detections").iter().map(|(t, _)| *t).collect();
        assert!(times.is_sorted() && times[0] == 25_000_000 && times[199] == 9_975_000_000);
        assert!(viewer.playing.is_empty());
    });
    assert_eq!((counts.clients, counts.lost, counts.rejected), (1, 0, 0));
    assert!(counts.sent == counts.published, "{counts:?}");
}

#[test]
fn who_comes_late_gets_what_holds() {
    let log = drive(100);
    let options = ServeOptions { rate: FAST, at_once: true, ..ServeOptions::default() };
    let expected = angles(&log);
    serve(&log, options, |address| {
        let mut viewer = Viewer::new(address, SDK);
        viewer.until(|viewer| viewer.playing.last().is_some_and(|state| state.0 == 3));
        viewer.subscribe(|topic| topic != "/log");
        viewer.until(|viewer| !viewer.of("/car/transform").is_empty());
        viewer.until(|viewer| viewer.of("/radar/1/mounting").len() == 1);
        assert_eq!(viewer.of("/radar/1/mounting")[0].1, expected[expected.len() - 1]);
        viewer.until(|viewer| viewer.of("/radar/2/transform").len() == 1);
        assert!(viewer.of("/radar/1/detections").is_empty() && viewer.of("/car/motion").is_empty());
        assert_eq!(viewer.time_ns, 2_500_000_000);
    });
}

#[test]
fn a_viewer_pauses_seeks_and_plays_on() {
    let log = drive(400);
    let expected = angles(&log);
    let options = ServeOptions { rate: 0.5, ..ServeOptions::default() };
    serve(&log, options, |address| {
        let mut viewer = Viewer::new(address, SDK);
        assert_eq!(viewer.others[0]["dataEndTime"], json!({ "sec": 10, "nsec": 0 }));
        viewer.subscribe(|_| true);
        viewer.until(|viewer| viewer.of("/radar/1/detections").len() == 3);
        viewer.control(1, 0.5, None, "stop");
        viewer.until(|viewer| viewer.playing.last().is_some_and(|state| state.4 == "stop"));
        assert_eq!(viewer.playing.last().unwrap().0, 1);
        let at_pause = viewer.time_ns;
        assert!(at_pause < 2_000_000_000, "{at_pause}");

        // Ahead: all between is calibrated, and not sent.
        viewer.control(1, 0.5, Some(5_000_000_000), "ahead");
        viewer.until(|viewer| viewer.playing.last().is_some_and(|state| state.4 == "ahead"));
        assert_eq!(viewer.playing.last().unwrap(), &(1, 5_000_000_000, 0.5, true, "ahead".into()));
        viewer.until(|viewer| viewer.time_ns == 5_000_000_000);
        let angle = &viewer.of("/radar/1/mounting").last().unwrap().1;
        let before = |angle: &&Value| angle["timestamp"]["sec"].as_u64().unwrap() < 5;
        assert_eq!(Some(angle), expected.iter().rfind(before));
        assert!(viewer.of("/radar/1/detections").len() < 50);

        viewer.control(0, 1e6, None, "on");
        viewer.until(|viewer| viewer.playing.last().is_some_and(|state| state.0 == 3));
        viewer.until(|viewer| {
            viewer.of("/radar/1/mounting").last().unwrap().1 == expected[expected.len() - 1]
        });

        // After the end: to play is to play again.
        let before = viewer.of("/car/scene").len();
        viewer.control(0, 1e6, None, "again");
        viewer.until(|viewer| viewer.of("/car/scene").len() > before);
        viewer.until(|viewer| {
            viewer.playing.last().is_some_and(|state| state.0 == 3 && state.1 == 10_000_000_000)
        });
    });
}

#[test]
fn parameters_are_told_set_and_checked() {
    let log = drive(40);
    let options = ServeOptions { rate: 0.01, ..ServeOptions::default() };
    serve(&log, options, |address| {
        let mut other = Viewer::new(address, V1);
        other.send(&json!({ "op": "subscribeParameterUpdates", "parameterNames": [] }));
        other.send(&json!({ "op": "getParameters", "parameterNames": [], "id": "all" }));
        other.until(|viewer| viewer.others.len() == 2);
        let all = json!([{ "name": "rate", "value": 0.01, "type": "float64" }, { "name": "paused", "value": false }]);
        assert_eq!(
            other.others[1],
            json!({ "op": "parameterValues", "id": "all", "parameters": all })
        );

        let mut viewer = Viewer::new(address, V1);
        let set = |name: &str, value: Value| json!({ "op": "setParameters", "id": "set", "parameters": [{ "name": name, "value": value }] });
        viewer.send(&set("rate", json!(4)));
        viewer.until(|viewer| viewer.others.len() == 2);
        assert_eq!(
            viewer.others[1]["parameters"],
            json!([{ "name": "rate", "value": 4.0, "type": "float64" }])
        );
        other.until(|viewer| viewer.others.len() == 3);
        assert_eq!(other.others[2]["parameters"][0]["value"], 4.0);
        for (name, value) in
            [("rate", json!(0)), ("rate", json!("fast")), ("paused", json!(1)), ("speed", json!(1))]
        {
            let before = viewer.statuses.len();
            viewer.send(&set(name, value));
            viewer.until(|viewer| viewer.statuses.len() > before);
            assert_eq!(viewer.statuses.last().unwrap()["level"], 2);
        }
        let messages: Vec<_> = viewer.statuses.iter().map(|status| &status["message"]).collect();
        assert!(messages[0].as_str().unwrap().contains("from 0.01"));
        assert_eq!(messages[1], "rate is \"fast\"; expected a number");
        assert_eq!(messages[2], "paused is 1; expected true or false");
    });
}

#[test]
fn a_drive_that_repeats_begins_anew() {
    let log = drive(60);
    let options = ServeOptions { rate: 50.0, repeat: true, ..ServeOptions::default() };
    let expected = angles(&log);
    serve(&log, options, |address| {
        let mut viewer = Viewer::new(address, V1);
        viewer.subscribe(|_| true);
        viewer.until(|viewer| viewer.of("/car/scene").len() == 3);
        let got: Vec<&Value> = viewer.of("/radar/1/mounting").iter().map(|(_, m)| m).collect();
        let twice: Vec<&Value> = expected.iter().chain(&expected).collect();
        assert_eq!(got[..twice.len()], twice);
    });
}

#[test]
fn an_address_that_is_taken_is_an_error() {
    let log = drive(2);
    serve(&log, ServeOptions::default(), |address| {
        let taken = ServeOptions { port: address.port(), ..ServeOptions::default() };
        let error = boresight_live::foxglove::Server::bind(taken).unwrap_err();
        assert!(error.to_string().starts_with("cannot listen at 127.0.0.1:"), "{error}");
    });
}
