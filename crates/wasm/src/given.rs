//! What JavaScript hands over, asked in ways that cannot throw into WebAssembly.
//!
//! An exception that passes through WebAssembly runs no destructor of Rust's, so that the instance's memory cannot be
//! trusted from then on. Proxies, getters and objects with a foreign prototype can throw anywhere, and answer
//! otherwise when asked again: what is here asks once, and lengths of typed arrays are the engine's, not a property's.

use crate::error::{BindingError, Fallible, MOST_KEYS};
use js_sys::{Array, Function, Reflect, Uint8Array};
use std::thread::LocalKey;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(catch, js_namespace = Array, js_name = isArray)]
    fn is_array_or_throws(value: &JsValue) -> Result<bool, JsValue>;

    #[wasm_bindgen(catch, js_namespace = Object, js_name = keys)]
    fn keys_or_throws(value: &JsValue) -> Result<Array, JsValue>;

    /// What engines themselves say of a typed array; it throws for anything else.
    #[wasm_bindgen(js_namespace = ["Int8Array", "prototype"], js_name = __lookupGetter__)]
    fn typed_getter(name: &str) -> Function;

    /// The same of a buffer.
    #[wasm_bindgen(js_namespace = ["ArrayBuffer", "prototype"], js_name = __lookupGetter__)]
    fn buffer_getter(name: &str) -> Function;

    #[wasm_bindgen(catch, js_namespace = ["Int8Array", "prototype", "set"], js_name = call)]
    fn set_f64(to: &mut [f64], from: &JsValue) -> Result<(), JsValue>;

    #[wasm_bindgen(catch, js_namespace = ["Int8Array", "prototype", "set"], js_name = call)]
    fn set_f32(to: &mut [f32], from: &JsValue) -> Result<(), JsValue>;

    #[wasm_bindgen(catch, js_namespace = ["Int8Array", "prototype", "set"], js_name = call)]
    fn set_u8(to: &mut [u8], from: &JsValue) -> Result<(), JsValue>;
}

thread_local! {
    static LENGTH: JsValue = JsValue::from_str("length");
    static TYPED_LENGTH: Function = typed_getter("length");
    static BUFFER_LENGTH: Function = buffer_getter("byteLength");
}

/// Whether this is an array; a proxy of nothing is none.
pub fn is_array(value: &JsValue) -> bool {
    is_array_or_throws(value).unwrap_or(false)
}

/// Whether this is an object and neither an array nor a function.
pub fn is_plain(value: &JsValue) -> bool {
    value.is_object() && !is_array(value) && !value.is_function()
}

/// Items that an array says it has.
pub fn length(array: &JsValue) -> Option<u32> {
    let length = LENGTH.with(|name| Reflect::get(array, name)).ok()?.as_f64()?;
    (length.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&length))
        .then_some(length as u32)
}

/// An item of an array; `path` names it in errors.
pub fn item(array: &JsValue, index: u32, path: &dyn Fn() -> String) -> Fallible<JsValue> {
    Reflect::get_u32(array, index).map_err(|_| throws(path()))
}

/// The names of an object's own properties; `path` names the object in errors.
///
/// # Errors
/// [`BindingError::TooManyKeys`] above [`MOST_KEYS`]: each name that is read takes memory here.
pub fn keys(object: &JsValue, path: &dyn Fn() -> String) -> Fallible<Array> {
    let keys = keys_or_throws(object).map_err(|_| throws(path()))?;
    match keys.length() {
        0..=MOST_KEYS => Ok(keys),
        given => {
            let path = path();
            // An argument as a whole has no path.
            let what = if path.is_empty() { "object".into() } else { path };
            Err(BindingError::TooManyKeys { what, given })
        }
    }
}

/// The error for what throws when it is read.
pub fn throws(what: String) -> BindingError {
    let given = "a property that throws".into();
    BindingError::Type { what, expected: "a value".into(), given }
}

/// What the numbers of typed arrays are read as.
pub trait Number: Clone {
    /// What memory is filled with before.
    const ZERO: Self;

    /// Copies all numbers of a typed array; throws where they are too many, or no numbers.
    fn set(to: &mut [Self], from: &JsValue) -> Result<(), JsValue>;
}

macro_rules! numbers {
    ($($number:ty, $set:ident;)*) => {$(
        impl Number for $number {
            const ZERO: Self = 0 as $number;

            fn set(to: &mut [Self], from: &JsValue) -> Result<(), JsValue> {
                $set(to, from)
            }
        }
    )*};
}

numbers! { f64, set_f64; f32, set_f32; u8, set_u8; }

/// A copy of the numbers of a typed array `A` as `T`, none of a detached one; nothing where this is no such array. `what` names
/// it in errors.
///
/// # Errors
/// [`BindingError::TooLarge`] where memory does not hold it.
#[inline]
pub fn numbers<A: JsCast, T: Number>(
    value: &JsValue,
    what: &dyn Fn() -> String,
) -> Fallible<Option<Vec<T>>> {
    if value.is_instance_of::<A>() { copied(value, what) } else { Ok(None) }
}

#[inline(never)]
fn copied<T: Number>(value: &JsValue, what: &dyn Fn() -> String) -> Fallible<Option<Vec<T>>> {
    let Some(length) = engine_length(&TYPED_LENGTH, value) else { return Ok(None) };
    let mut numbers = zeros(what, length, T::ZERO)?;
    // From a detached one nothing can be copied.
    Ok((length == 0 || T::set(&mut numbers, value).is_ok()).then_some(numbers))
}

/// The same of a buffer's bytes.
///
/// # Errors
/// As [`numbers`].
pub fn buffer(value: &JsValue, what: &dyn Fn() -> String) -> Fallible<Option<Vec<u8>>> {
    match engine_length(&BUFFER_LENGTH, value) {
        None => Ok(None),
        // A view of a detached buffer would throw.
        Some(0) => Ok(Some(vec![])),
        Some(_) => copied(&Uint8Array::new(value), what),
    }
}

fn engine_length(getter: &'static LocalKey<Function>, value: &JsValue) -> Option<usize> {
    let length = getter.with(|getter| getter.call0(value)).ok()?;
    length.as_f64().map(|length| length as usize)
}

/// `len` copies of `zero`, or an error where memory does not hold them.
pub fn zeros<T: Clone>(what: &dyn Fn() -> String, len: usize, zero: T) -> Fallible<Vec<T>> {
    let mut numbers = Vec::new();
    numbers.try_reserve_exact(len).map_err(|_| BindingError::TooLarge {
        what: what(),
        given: len.saturating_mul(size_of::<T>()),
    })?;
    numbers.resize(len, zero);
    Ok(numbers)
}
