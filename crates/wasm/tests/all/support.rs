//! Values of JavaScript, made and looked into.

use js_sys::{Array, JSON, Reflect};
use wasm_bindgen::{JsCast, JsValue};

/// What a text of JSON says.
pub fn json(text: &str) -> JsValue {
    JSON::parse(text).unwrap()
}

/// The value at a path, such as `scans.timeS`.
pub fn get(value: &JsValue, path: &str) -> JsValue {
    path.split('.').fold(value.clone(), |value, key| Reflect::get(&value, &key.into()).unwrap())
}

/// The text at a path.
pub fn text(value: &JsValue, path: &str) -> String {
    get(value, path).as_string().unwrap()
}

/// The numbers of an array, typed or plain, at a path.
pub fn numbers(value: &JsValue, path: &str) -> Vec<f64> {
    Array::from(&get(value, path)).iter().map(|number| number.as_f64().unwrap()).collect()
}

/// An object with one more field.
pub fn with(object: JsValue, key: &str, value: impl Into<JsValue>) -> JsValue {
    Reflect::set(object.unchecked_ref(), &key.into(), &value.into()).unwrap();
    object
}
