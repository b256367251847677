//! Names of properties as JavaScript strings, each made once: handing text across the boundary
//! costs more than the property itself.

use boresight_core::describe::naming;
use std::cell::RefCell;
use std::collections::HashMap;
use wasm_bindgen::JsValue;

/// A property of an object.
pub struct Property {
    /// Its name in JavaScript.
    pub name: String,
    /// The same, on the other side.
    pub key: JsValue,
    /// Whether it holds degrees where Rust has radians.
    pub is_angle: bool,
}

thread_local! {
    static PROPERTIES: RefCell<HashMap<&'static str, &'static Property>> =
        RefCell::new(HashMap::new());
}

/// The property of a field, by the field's name in Rust.
pub fn property(field: &'static str) -> &'static Property {
    PROPERTIES.with_borrow_mut(|properties| {
        let known: &mut &'static Property = properties.entry(field).or_insert_with(|| {
            let name = naming::javascript(field);
            let key = JsValue::from_str(&name);
            // There are as many as the source names fields.
            Box::leak(Box::new(Property { name, key, is_angle: naming::is_angle(field) }))
        });
        *known
    })
}
