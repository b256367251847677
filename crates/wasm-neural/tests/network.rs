//! A network as JavaScript meets it, without the TypeScript around it.

#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used)]

#[allow(dead_code)]
#[path = "../../wasm/tests/all/support.rs"]
mod support;

use boresight_core::presets::preset;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction};
use boresight_wasm_neural::Network;
use js_sys::{Float64Array, Uint8Array};
use support::{get, json, text, with};
use wasm_bindgen::JsValue;
use wasm_bindgen_test::wasm_bindgen_test;

const ONNX: &[u8] = include_bytes!("../../../models/learned-pursuit.onnx");
const CARD: &str = include_str!("../../../models/learned-pursuit.json");

fn load(onnx: &[u8], options: &str) -> Result<Network, JsValue> {
    let onnx = Uint8Array::new_from_slice(onnx);
    Network::new(&onnx.into(), &CARD.into(), &json(options)).map_err(JsValue::from)
}

/// A snapshot of waves of amplitude 1 from these azimuths.
fn input(array: &Array, azimuths_deg: &[f64]) -> JsValue {
    let wave = |degrees: &f64| steering_vector(array, Direction::azimuth(degrees.to_radians()));
    let waves = azimuths_deg.iter().map(wave);
    let sum = waves.reduce(|sum, wave| sum + wave).unwrap();
    let data: Vec<f64> = sum.iter().flat_map(|z: &Complex64| [z.re, z.im]).collect();
    let snapshots = json(&format!(r#"{{ "shape": [{}, 1] }}"#, sum.len()));
    let snapshots = with(snapshots, "data", Float64Array::new_from_slice(&data));
    with(json("{}"), "snapshots", snapshots)
}

#[wasm_bindgen_test]
fn a_network_finds_the_angles_of_clean_snapshots() {
    let array = preset("lrr48").unwrap();
    let mut network = load(ONNX, r#"{ "array": "lrr48" }"#).unwrap();
    assert_eq!(text(&network.describe(), "kind"), "learned-pursuit");
    let truth = [-20.0, 15.0];
    let estimate = network.estimate(&input(&array, &truth)).unwrap();
    let sources = js_sys::Array::from(&get(&estimate, "sources"));
    let mut found: Vec<f64> =
        sources.iter().map(|source| get(&source, "azimuthDeg").as_f64().unwrap()).collect();
    found.sort_by(f64::total_cmp);
    assert_eq!(found.len(), 2, "{found:?}");
    for (found, truth) in found.iter().zip(truth) {
        // A fifth of the beam's width.
        assert!((found - truth).abs() < 0.2, "{found} for {truth}");
    }
}

#[wasm_bindgen_test]
fn a_file_that_is_cut_or_none_is_refused_and_the_next_one_loads() {
    let code = |onnx: &[u8]| text(&load(onnx, "{}").err().unwrap(), "code");
    assert_eq!(code(b"not a network"), "not-onnx");
    assert_eq!(code(&ONNX[..ONNX.len() / 2]), "truncated-file");
    let mut network = load(ONNX, "{}").unwrap();
    let error: JsValue = network.estimate(&json(r#"{ "snapshots": 1 }"#)).unwrap_err().into();
    assert!(!text(&error, "what").is_empty() && !text(&error, "expected").is_empty());
    assert!(!text(&network.describe(), "inputs.0.name").is_empty());
}
