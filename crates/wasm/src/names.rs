//! Property names as JavaScript strings, each made once: handing text across the boundary costs
//! more than the property itself.

use std::cell::RefCell;
use std::collections::HashMap;
use wasm_bindgen::JsValue;

thread_local! {
    static NAMES: RefCell<HashMap<&'static str, JsValue>> = RefCell::new(HashMap::new());
}

/// The JavaScript string of a property's name.
pub fn name(text: &'static str) -> JsValue {
    NAMES.with_borrow_mut(|names| {
        names.entry(text).or_insert_with(|| JsValue::from_str(text)).clone()
    })
}
