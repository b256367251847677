//! The contents of files.

use crate::error::Fallible;
use crate::given;
use crate::read::{Fields, Read, wrong_type};
use js_sys::Uint8Array;
use wasm_bindgen::JsValue;

/// Contents of a binary file: a `Uint8Array` or an `ArrayBuffer`.
pub struct Bytes(pub Vec<u8>);

impl Read for Bytes {
    const EXPECTED: &'static str = "a Uint8Array or an ArrayBuffer";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let what = || path.into();
        let bytes = match given::numbers::<Uint8Array, _>(value, &what)? {
            None => given::buffer(value, &what)?,
            bytes => bytes,
        };
        bytes.map(Self).ok_or_else(|| wrong_type(path, Self::EXPECTED, value))
    }
}

/// A file with its name.
pub struct File {
    /// Its name.
    pub name: String,
    /// Its contents.
    pub bytes: Vec<u8>,
}

impl Read for File {
    const EXPECTED: &'static str = "{ name, bytes }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let name = fields.required("name")?;
        let Bytes(bytes) = fields.required("bytes")?;
        fields.finish()?;
        Ok(Self { name, bytes })
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
