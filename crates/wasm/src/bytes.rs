//! The contents of files.

use crate::complex::zeros;
use crate::error::Fallible;
use crate::read::{Read, wrong_type};
use js_sys::{ArrayBuffer, Uint8Array};
use wasm_bindgen::{JsCast, JsValue};

/// Contents of a binary file: a `Uint8Array` or an `ArrayBuffer`.
pub struct Bytes(pub Vec<u8>);

impl Read for Bytes {
    const EXPECTED: &'static str = "a Uint8Array or an ArrayBuffer";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let array = match (value.dyn_ref::<Uint8Array>(), value.dyn_ref::<ArrayBuffer>()) {
            (Some(array), _) => array.clone(),
            (_, Some(buffer)) if buffer.byte_length() == 0 => return Ok(Self(vec![])),
            (_, Some(buffer)) => Uint8Array::new(buffer),
            _ => return Err(wrong_type(path, Self::EXPECTED, value)),
        };
        // A detached array has no length, and copying from it throws.
        if array.length() == 0 {
            return Ok(Self(vec![]));
        }
        let mut bytes = zeros(path, array.length() as usize, 0)?;
        array.copy_to(&mut bytes);
        Ok(Self(bytes))
    }
}

/// Contents of a text file: a string, or its bytes.
pub struct Text(pub Vec<u8>);

impl Read for Text {
    const EXPECTED: &'static str = "a string, a Uint8Array or an ArrayBuffer";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if let Some(text) = value.as_string() {
            return Ok(Self(text.into_bytes()));
        }
        match Bytes::read(value, path) {
            Ok(bytes) => Ok(Self(bytes.0)),
            Err(_) => Err(wrong_type(path, Self::EXPECTED, value)),
        }
    }
}
