//! Options out of JavaScript objects, with errors that name the field.

use crate::carry::{Known, Reader, read_named};
use crate::error::{BindingError, Fallible};
use crate::given;
use boresight_core::InputError;
use boresight_options::{At, Described, Naming};
use js_sys::{BigInt, Object};
use serde::de::DeserializeOwned;
use wasm_bindgen::{JsCast, JsValue};

/// Most items of an array: a longer one, which may well be empty, would not fit into memory.
pub const MOST_ITEMS: u32 = 1 << 22;

/// Largest integer a JavaScript number holds exactly.
const MAX_SAFE_INTEGER: f64 = 9_007_199_254_740_991.0;

/// A value that can be read from JavaScript; `path` names it in errors.
pub trait Read: Sized {
    /// What is accepted, in words.
    const EXPECTED: &'static str;

    /// Reads a value that is not `undefined`.
    fn read(value: &JsValue, path: &str) -> Fallible<Self>;
}

/// The fields of an options object. [`Fields::finish`] refuses fields nobody asked for.
pub struct Fields {
    object: Object,
    path: String,
    known: Known,
}

impl Fields {
    /// Reads `value`, which must be a plain object; `path` is its name in errors, empty for the
    /// argument itself.
    pub fn new(value: &JsValue, path: &str) -> Fallible<Self> {
        if !given::is_plain(value) {
            let what = if path.is_empty() { "options" } else { path };
            return Err(wrong_type(what, "an object", value));
        }
        Ok(Self {
            object: value.clone().unchecked_into(),
            path: path.into(),
            known: Known::default(),
        })
    }

    /// Options that may be left out altogether.
    pub fn of_optional(value: &JsValue) -> Fallible<Self> {
        if value.is_undefined() { Self::new(&Object::new(), "") } else { Self::new(value, "") }
    }

    /// Path of a field in errors.
    pub fn path_of(&self, name: &str) -> String {
        if self.path.is_empty() { name.into() } else { [&self.path, ".", name].concat() }
    }

    /// The raw value of a field; nothing if absent or `undefined`.
    pub fn raw(&mut self, name: &'static str) -> Fallible<Option<JsValue>> {
        self.known.get(&self.object, name).map_err(|_| given::throws(self.path_of(name)))
    }

    /// A field that may be absent.
    pub fn optional<T: Read>(&mut self, name: &'static str) -> Fallible<Option<T>> {
        match self.raw(name)? {
            Some(value) => T::read(&value, &self.path_of(name)).map(Some),
            None => Ok(None),
        }
    }

    /// A field that must be there.
    pub fn required<T: Read>(&mut self, name: &'static str) -> Fallible<T> {
        self.optional(name)?.ok_or_else(|| BindingError::Missing {
            what: self.path_of(name),
            expected: T::EXPECTED.into(),
        })
    }

    /// A field of a described type that may be absent.
    pub fn described<T: DeserializeOwned + Described>(
        &mut self,
        name: &'static str,
    ) -> Fallible<Option<T>> {
        let path = self.path_of(name);
        self.raw(name)?.map(|value| read_named(&value, &path)).transpose()
    }

    /// A field of a described type that must be there.
    pub fn described_required<T: DeserializeOwned + Described>(
        &mut self,
        name: &'static str,
    ) -> Fallible<T> {
        self.described(name)?.ok_or_else(|| BindingError::Missing {
            what: self.path_of(name),
            expected: T::KIND.expected(),
        })
    }

    /// Reads a described struct whose fields stand among those of this object.
    pub fn spread<T: DeserializeOwned + Described>(&mut self) -> Fallible<T> {
        Reader::spread(&self.object, At::named(Naming::JavaScript, &self.path), &self.known)
    }

    /// The fields of an object in a field; nothing if absent.
    pub fn object(&mut self, name: &'static str) -> Fallible<Option<Self>> {
        match self.raw(name)? {
            Some(value) => Self::new(&value, &self.path_of(name)).map(Some),
            None => Ok(None),
        }
    }

    /// Refuses fields that were not asked for, unless they are `undefined`.
    pub fn finish(self) -> Fallible<()> {
        self.known.refuse_others(&self.object, &At::named(Naming::JavaScript, &self.path))
    }
}

/// The error for a value of the wrong type.
pub fn wrong_type(what: &str, expected: &str, value: &JsValue) -> BindingError {
    BindingError::Type { what: what.into(), expected: expected.into(), given: describe(value) }
}

/// One of a list of names.
pub fn choice<T: Copy>(value: &JsValue, path: &str, choices: &[(&str, T)]) -> Fallible<T> {
    let names = || choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let Some(given) = value.as_string() else {
        return Err(wrong_type(path, &format!("one of {}", names()), value));
    };
    match choices.iter().find(|(name, _)| *name == given) {
        Some((_, choice)) => Ok(*choice),
        None => Err(InputError::Unknown {
            what: path.into(),
            expected: names(),
            given: shortened(&given),
        }
        .into()),
    }
}

/// How many items an array has; `path` names it in errors.
pub fn item_count(value: &JsValue, path: &dyn Fn() -> String) -> Fallible<u32> {
    if !given::is_array(value) {
        return Err(wrong_type(&path(), "an array", value));
    }
    given::length(value).filter(|&length| length <= MOST_ITEMS).ok_or_else(|| {
        wrong_type(&path(), &format!("an array of at most {MOST_ITEMS} items"), value)
    })
}

/// The items of an array with their paths.
pub fn items(value: &JsValue, path: &str) -> Fallible<Vec<(JsValue, String)>> {
    let path_of = |index: u32| [path, "[", &index.to_string(), "]"].concat();
    let read = |index| Ok((given::item(value, index, &|| path_of(index))?, path_of(index)));
    (0..item_count(value, &|| path.into())?).map(read).collect()
}

/// A value in words, short enough for a message.
fn describe(value: &JsValue) -> String {
    if let Some(number) = value.as_f64() {
        return number.to_string();
    }
    if let Some(text) = value.as_string() {
        return format!("{:?}", shortened(&text));
    }
    match value {
        value if value.is_null() => "null".into(),
        value if value.is_undefined() => "undefined".into(),
        value if value.is_function() => "a function".into(),
        value if given::is_array(value) => match given::length(value) {
            Some(length) => format!("an array of {length}"),
            None => "an array without a length".into(),
        },
        value if value.is_object() => "an object".into(),
        value => match value.as_bool() {
            Some(truth) => truth.to_string(),
            None => value.js_typeof().as_string().unwrap_or_default(),
        },
    }
}

pub(crate) fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}

impl Read for f64 {
    const EXPECTED: &'static str = "a number";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let Some(given) = value.as_f64() else {
            return Err(wrong_type(path, Self::EXPECTED, value));
        };
        if !given.is_finite() {
            let what = path.into();
            return Err(
                InputError::OutOfRange { what, expected: "a finite number".into(), given }.into()
            );
        }
        Ok(given)
    }
}

impl Read for usize {
    const EXPECTED: &'static str = "a whole number";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let given = value.as_f64().ok_or_else(|| wrong_type(path, Self::EXPECTED, value))?;
        if given.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&given) {
            return Ok(given as usize);
        }
        let expected = format!("a whole number from 0 to {}", u32::MAX);
        Err(InputError::OutOfRange { what: path.into(), expected, given }.into())
    }
}

/// A seed: a whole number or a `bigint`.
impl Read for u64 {
    const EXPECTED: &'static str = "a whole number or a bigint from 0 to 2^64 - 1";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if let Some(given) = value.as_f64() {
            if given.fract() == 0.0 && (0.0..=MAX_SAFE_INTEGER).contains(&given) {
                return Ok(given as u64);
            }
            let expected = "a whole number from 0 to 2^53 - 1, or a bigint".into();
            return Err(InputError::OutOfRange { what: path.into(), expected, given }.into());
        }
        value
            .dyn_ref::<BigInt>()
            .and_then(|big| u64::try_from(big.clone()).ok())
            .ok_or_else(|| wrong_type(path, Self::EXPECTED, value))
    }
}

impl Read for bool {
    const EXPECTED: &'static str = "true or false";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        value.as_bool().ok_or_else(|| wrong_type(path, Self::EXPECTED, value))
    }
}

impl Read for String {
    const EXPECTED: &'static str = "a string";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        value.as_string().ok_or_else(|| wrong_type(path, Self::EXPECTED, value))
    }
}

impl<T: Read, const N: usize> Read for [T; N] {
    const EXPECTED: &'static str = "an array of numbers";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let items = items(value, path)?;
        let given = items.len();
        let read: Vec<T> =
            items.iter().map(|(item, path)| T::read(item, path)).collect::<Fallible<_>>()?;
        read.try_into().map_err(|_| {
            let expected = format!("[{N}]");
            InputError::Shape { what: path.into(), expected, given: vec![given] }.into()
        })
    }
}

impl<T: Read> Read for Vec<T> {
    const EXPECTED: &'static str = "an array";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        items(value, path)?.iter().map(|(item, path)| T::read(item, path)).collect()
    }
}
