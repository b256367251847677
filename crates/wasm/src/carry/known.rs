//! Which fields of an object were asked for, so that others can be refused.

use super::names::property;
use crate::error::{BindingError, Fallible};
use crate::given;
use crate::read::shortened;
use boresight_options::At;
use js_sys::{Object, Reflect};
use std::cell::{Cell, RefCell};
use wasm_bindgen::JsValue;

/// Names of fields that were asked for.
#[derive(Default)]
pub struct Known {
    names: RefCell<Vec<&'static str>>,
    /// How many of them the object has.
    present: Cell<u32>,
}

thread_local! {
    static PLAIN: Object = Object::get_prototype_of(&Object::new().into());
}

impl Known {
    /// The value of a field, by its name in Rust; none where it is `undefined`.
    ///
    /// # Errors
    /// What a property throws.
    pub fn get(&self, object: &Object, field: &'static str) -> Result<Option<JsValue>, JsValue> {
        let property = property(field);
        let value = Reflect::get(object, &property.key)?;
        let value = (!value.is_undefined()).then_some(value);
        let mut names = self.names.borrow_mut();
        if !names.contains(&property.name.as_str()) {
            names.push(&property.name);
            self.present.set(self.present.get() + u32::from(value.is_some()));
        }
        Ok(value)
    }

    /// Refuses fields that were not asked for, unless they are `undefined`.
    ///
    /// # Errors
    /// [`BindingError::UnknownField`] for the first.
    pub fn refuse_others(&self, object: &Object, at: &At<'_>) -> Fallible<()> {
        let keys = given::keys(object, &|| at.path())?;
        // As many as there are without looking at each: none else, unless some are inherited.
        if keys.length() == self.present.get() {
            let prototype = Reflect::get_prototype_of(object);
            if prototype.is_ok_and(|own| PLAIN.with(|plain| own == *plain)) {
                return Ok(());
            }
        }
        let known = self.names.borrow();
        for key in &keys.to_vec() {
            let name = key.as_string().unwrap_or_default();
            if known.contains(&name.as_str()) {
                continue;
            }
            let given = Reflect::get(object, key).unwrap_or(JsValue::NULL);
            if !given.is_undefined() {
                let name = if name.is_empty() { "\"\"".into() } else { shortened(&name) };
                let above = at.path();
                let what = if above.is_empty() { name } else { format!("{above}.{name}") };
                return Err(BindingError::UnknownField { what, expected: known.join(", ") });
            }
        }
        Ok(())
    }
}
