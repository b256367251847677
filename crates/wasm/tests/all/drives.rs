//! Drives as JavaScript meets them: read, simulated, refused.

use crate::support::{json, numbers, text, with};
use boresight_wasm::drive::{drive_scenarios, read_drive, simulate_drive};
use js_sys::{Array, Uint8Array};
use wasm_bindgen::JsValue;
use wasm_bindgen_test::wasm_bindgen_test;

fn files(name: &str, bytes: &[u8]) -> JsValue {
    let file = with(json("{}"), "name", name);
    Array::of1(&with(file, "bytes", Uint8Array::new_from_slice(bytes))).into()
}

fn read(name: &str, bytes: &[u8]) -> JsValue {
    read_drive(&files(name, bytes), &JsValue::UNDEFINED).unwrap()
}

/// What tests/golden/radarscenes/make.py wrote, compressed.
#[wasm_bindgen_test]
fn a_compressed_sequence_is_read() {
    let drive = read("s.h5", include_bytes!("../../../../tests/golden/radarscenes/deflated.h5"));
    assert_eq!(text(&drive, "format"), "radarscenes");
    assert_eq!(numbers(&drive, "scans.sensor"), [1.0, 2.0, 1.0]);
    assert_eq!(numbers(&drive, "detections.rangeM"), [10.5, 20.5, 40.5]);
    let azimuth_deg = numbers(&drive, "detections.azimuthDeg");
    assert_eq!(azimuth_deg, [-0.25_f64, 0.125, 0.75].map(f64::to_degrees));
    assert_eq!(numbers(&drive, "motion.timeS").len(), 10);
}

#[wasm_bindgen_test]
fn a_seed_gives_one_drive() {
    let simulated = |seed: u32| {
        let options = with(json(r#"{ "scenario": "city", "durationS": 2 }"#), "seed", seed);
        simulate_drive(&options, None).unwrap()
    };
    let (drive, again, other) = (simulated(1), simulated(1), simulated(2));
    let rates = |drive: &JsValue| numbers(drive, "detections.rangeRateMps");
    assert!(rates(&drive).len() > 100);
    assert_eq!(rates(&drive), rates(&again));
    assert_ne!(rates(&drive), rates(&other));
    assert_eq!(numbers(&drive, "truth.moving").len(), rates(&drive).len());
    let names: Vec<String> = drive_scenarios().iter().map(|s| text(&s, "name")).collect();
    assert!(names.contains(&"city".to_owned()), "{names:?}");
}

#[wasm_bindgen_test]
fn what_is_wrong_is_said_and_the_next_call_works() {
    let error: JsValue =
        read_drive(&files("s.h5", b"no HDF5"), &JsValue::UNDEFINED).unwrap_err().into();
    assert_eq!(text(&error, "code"), "malformed-hdf5");
    assert!(!text(&error, "message").is_empty());

    let options = json(r#"{ "scenario": "moon" }"#);
    let error: JsValue = simulate_drive(&options, None).unwrap_err().into();
    let parts = ["code", "what", "given"].map(|part| text(&error, part));
    assert_eq!(parts, ["unknown-name", "scenario", "moon"]);

    let drive = read("s.h5", include_bytes!("../../../../tests/golden/radarscenes/contiguous.h5"));
    assert_eq!(numbers(&drive, "scans.timeS").len(), 3);
}
