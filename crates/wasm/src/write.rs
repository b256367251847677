//! Plain JavaScript objects, lists and typed arrays out of results.

use crate::carry::property;
pub use boresight_core::describe::decibels::finite_db;
use boresight_core::{Complex32, Complex64};
use boresight_formats::Remark;
use js_sys::{Array, Float32Array, Float64Array, Object, Reflect};
use wasm_bindgen::JsValue;

/// A plain object under construction.
pub struct Record(Object);

impl Default for Record {
    fn default() -> Self {
        Self::new()
    }
}

impl Record {
    /// An object without fields.
    pub fn new() -> Self {
        Self(Object::new())
    }

    /// Adds a field.
    #[must_use]
    pub fn with(self, name: &'static str, value: impl Into<JsValue>) -> Self {
        // Setting a property of a fresh plain object cannot fail.
        let _ = Reflect::set(&self.0, &property(name).key, &value.into());
        self
    }

    /// Adds a field if there is a value for it.
    #[must_use]
    pub fn with_some(self, name: &'static str, value: Option<impl Into<JsValue>>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }
}

impl From<Record> for JsValue {
    fn from(record: Record) -> Self {
        record.0.into()
    }
}

/// A list of anything.
pub fn list<T: Into<JsValue>>(items: impl IntoIterator<Item = T>) -> Array {
    items.into_iter().map(Into::into).collect()
}

/// Remarks of a reader as warnings.
pub fn remarks(remarks: &[Remark]) -> Array {
    list(
        remarks
            .iter()
            .map(|r| Record::new().with("code", r.code).with("message", r.message.as_str())),
    )
}

/// A `Float64Array` of its own.
pub fn float64(numbers: &[f64]) -> Float64Array {
    Float64Array::new_from_slice(numbers)
}

/// A `Float32Array` of its own.
pub fn float32(numbers: &[f32]) -> Float32Array {
    Float32Array::new_from_slice(numbers)
}

/// Interleaved [re, im] numbers.
pub fn complex64(numbers: &[Complex64]) -> Float64Array {
    float64(&numbers.iter().flat_map(|z| [z.re, z.im]).collect::<Vec<_>>())
}

/// Interleaved [re, im] numbers in single precision.
pub fn complex32(numbers: &[Complex32]) -> Float32Array {
    float32(&numbers.iter().flat_map(|z| [z.re, z.im]).collect::<Vec<_>>())
}

/// Radians to a `Float64Array` in degrees.
pub fn degrees(radians: &[f64]) -> Float64Array {
    float64(&radians.iter().map(|x| x.to_degrees()).collect::<Vec<_>>())
}

/// Powers in dB that stay finite, as [`finite_db`] makes them.
pub fn finite_dbs(powers: &[f64]) -> Float64Array {
    let positive: Vec<f64> = powers.iter().map(|p| p.max(f64::MIN_POSITIVE)).collect();
    float64(&boresight_core::units::powers_to_db(&positive))
}
