//! The bindings as JavaScript meets them, without the TypeScript around them.

use crate::support::{get, json, text, with};
use boresight_wasm::{array, capture, estimate, simulate};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::wasm_bindgen_test;

/// Snapshots of one target, with their shape cut to one scene's.
fn snapshots() -> JsValue {
    let options = r#"{ "array": "ula8", "targets": [{ "azimuthDeg": 20 }], "snrDb": 30,
                       "snapshots": 10, "seed": 1 }"#;
    let result = simulate::simulate_snapshots(&json(options)).unwrap();
    let snapshots = with(json(r#"{ "shape": [8, 10] }"#), "data", get(&result, "data"));
    with(json("{}"), "snapshots", snapshots)
}

#[wasm_bindgen_test]
fn an_estimate_is_a_plain_object() {
    let options = json(r#"{ "method": "music", "array": "ula8", "sources": 1 }"#);
    let result = estimate::estimate(&snapshots(), &options).unwrap();
    assert_eq!(text(&result, "method"), "music");
    let azimuth_deg = get(&result, "sources.0.azimuthDeg").as_f64().unwrap();
    assert!((azimuth_deg - 20.0).abs() < 0.5, "{azimuth_deg}");
    let values = get(&result, "spectrum.valuesDb").dyn_into::<js_sys::Float64Array>().unwrap();
    assert_eq!(values.length(), 1024);
    assert_eq!(get(&result, "resolved").as_bool(), Some(true));
}

#[wasm_bindgen_test]
fn an_error_has_its_parts() {
    let options = json(r#"{ "method": "music", "array": "ula8", "iaa": { "iterations": 0.5 } }"#);
    let error: JsValue = estimate::estimate(&snapshots(), &options).unwrap_err().into();
    assert_eq!(text(&error, "code"), "out-of-range");
    assert_eq!(text(&error, "what"), "iaa.iterations");
    assert_eq!(text(&error, "given"), "0.5");
    assert!(text(&error, "message").contains("iaa.iterations"));
}

#[wasm_bindgen_test]
fn options_of_rust_have_the_names_of_javascript_in_errors() {
    let options = json(r#"{ "method": "iaa", "array": "ula8", "gridPoints": 2 }"#);
    let error: JsValue = estimate::estimate(&snapshots(), &options).unwrap_err().into();
    assert_eq!(text(&error, "what"), "gridPoints");
    assert!(text(&error, "message").starts_with("gridPoints is 2"));
}

#[wasm_bindgen_test]
fn arrays_of_a_kind_too_many_are_refused() {
    let error = array::array_geometry(&json(r#"{ "positions": [[0, 0, 0]], "tx": [] }"#));
    let error: JsValue = error.unwrap_err().into();
    assert_eq!(
        (text(&error, "code"), text(&error, "what")),
        ("unknown-option".into(), "array.tx".into())
    );
}

#[wasm_bindgen_test]
fn the_recording_has_its_targets() {
    let bin: &[u8] =
        include_bytes!("../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");
    let cfg = include_str!("../../../../recordings/awr1642/profile.cfg");
    let bytes = js_sys::Uint8Array::new_from_slice(bin);
    let mut capture = capture::Capture::new(&bytes.into(), &cfg.into()).unwrap();
    let result = capture.combine_frames(&JsValue::UNDEFINED, None).unwrap();
    let detections: js_sys::Array = get(&result, "detections").unchecked_into();
    let azimuth_deg_near = |range_m: f64| {
        detections
            .iter()
            .find(|d| (get(d, "rangeM").as_f64().unwrap() - range_m).abs() <= 0.05)
            .map(|d| get(&d, "azimuthDeg").as_f64().unwrap())
            .unwrap()
    };
    assert!((azimuth_deg_near(2.95) + 10.8).abs() <= 1.0);
    assert!((azimuth_deg_near(4.94) - 1.8).abs() <= 3.0);
}
