//! Names of properties as JavaScript strings, each made once: handing text across the boundary
//! costs more than the property itself.

use boresight_options::naming;
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
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

/// A name by where it stands in memory: what the source names has its place, often several.
type Place = (usize, usize);

/// Mixes a place and a length, which need no hash that withstands hostile keys.
#[derive(Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_usize(usize::from(*byte)));
    }

    fn write_usize(&mut self, number: usize) {
        const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
        self.0 = (self.0 ^ number as u64).wrapping_mul(ODD).rotate_left(32);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

thread_local! {
    static PROPERTIES: RefCell<HashMap<Place, &'static Property, BuildHasherDefault<Mixed>>> =
        RefCell::default();
}

/// The property of a field, by the field's name in Rust.
pub fn property(field: &'static str) -> &'static Property {
    PROPERTIES.with_borrow_mut(|properties| {
        let place = (field.as_ptr() as usize, field.len());
        let known: &mut &'static Property = properties.entry(place).or_insert_with(|| {
            let name = naming::javascript(field);
            let key = JsValue::from_str(&name);
            // There are as many as the source names fields.
            Box::leak(Box::new(Property { name, key, is_angle: naming::is_angle(field) }))
        });
        *known
    })
}
