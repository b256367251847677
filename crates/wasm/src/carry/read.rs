//! Options out of JavaScript objects.

use super::known::Known;
use super::names::property;
use super::refusal::ReadError;
use super::walk::{Entries, FieldsOf, Items};
use crate::error::{BindingError, Fallible};
use crate::given;
use crate::read::{item_count, shortened, wrong_type};
use boresight_core::InputError;
use boresight_options::{At, Described, Kind, Naming};
use js_sys::{Object, Reflect};
use serde::de::value::StringDeserializer;
use serde::de::{DeserializeOwned, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;
use wasm_bindgen::{JsCast, JsValue};

/// Reads an argument and checks it against its description. Fields that it does not know are
/// refused; those that are `undefined` count as absent.
pub fn read<T: DeserializeOwned + Described>(value: &JsValue) -> Fallible<T> {
    read_named(value, "")
}

/// The same for options that may be left out altogether.
pub fn read_optional<T: DeserializeOwned + Described + Default>(value: &JsValue) -> Fallible<T> {
    if value.is_undefined() { Ok(T::default()) } else { read(value) }
}

/// The same for a value that has a name in errors.
pub fn read_named<T: DeserializeOwned + Described>(value: &JsValue, name: &str) -> Fallible<T> {
    let at = At::named(Naming::JavaScript, name);
    if let Some(object) = value.dyn_ref::<Object>() {
        check_required(object, &T::KIND, &at)?;
    }
    let (value, kind) = (value.clone(), Some(&T::KIND));
    let read = T::deserialize(Reader { value, at, is_angle: false, kind, known: None })?;
    read.check(None, &at)?;
    Ok(read)
}

/// Refuses an object without the fields that options have to name.
fn check_required(object: &Object, kind: &Kind, at: &At<'_>) -> Fallible<()> {
    let Kind::Record(record) = kind else { return Ok(()) };
    for field in record.fields {
        if field.flat {
            check_required(object, &field.kind, at)?;
        } else if field.required {
            let value = Reflect::get(object, &property(field.name).key);
            if value.is_ok_and(|value| value.is_undefined()) {
                let expected = field.kind.expected();
                return Err(BindingError::Missing { what: at.field(field.name).path(), expected });
            }
        }
    }
    Ok(())
}

pub(super) type Reading<T> = Result<T, ReadError>;

/// A value on its way into Rust.
pub struct Reader<'a> {
    pub(super) value: JsValue,
    pub(super) at: At<'a>,
    pub(super) is_angle: bool,
    /// Description of the value; `None` for values in maps, which have none.
    pub(super) kind: Option<&'static Kind>,
    /// Where the value's fields stand among those of another object: all names that this one has.
    pub(super) known: Option<&'a Known>,
}

impl<'a> Reader<'a> {
    /// Reads a struct whose fields stand among others of an object, which the caller holds against
    /// `known` once all are read.
    pub fn spread<T: DeserializeOwned + Described>(
        object: &Object,
        at: At<'a>,
        known: &'a Known,
    ) -> Fallible<T> {
        check_required(object, &T::KIND, &at)?;
        let (value, kind) = (object.clone().into(), Some(&T::KIND));
        let read = T::deserialize(Reader { value, at, is_angle: false, kind, known: Some(known) })?;
        read.check(None, &at)?;
        Ok(read)
    }

    fn wrong_type(&self, expected: &str) -> ReadError {
        wrong_type(&self.name(), expected, &self.value).into()
    }

    fn out_of_range(&self, expected: &str, given: f64) -> ReadError {
        BindingError::from(InputError::OutOfRange {
            what: self.at.path(),
            expected: expected.into(),
            given,
        })
        .into()
    }

    /// What serde-wasm-bindgen reads of the value.
    fn leaf(&self) -> serde_wasm_bindgen::Deserializer {
        serde_wasm_bindgen::Deserializer::from(self.value.clone())
    }

    #[inline(never)]
    fn items(&self) -> Reading<Items<'_>> {
        let length = item_count(&self.value, &|| self.name())?;
        let kind = self.kind.and_then(Kind::item);
        Ok(Items::new(&self.value, length, &self.at, self.is_angle, kind))
    }

    fn number(&self) -> Reading<f64> {
        let given = self.value.as_f64().ok_or_else(|| self.wrong_type("a number"))?;
        if !given.is_finite() {
            return Err(self.out_of_range("a finite number", given));
        }
        Ok(if self.is_angle { given.to_radians() } else { given })
    }

    /// How the value is called in errors.
    fn name(&self) -> String {
        let path = self.at.path();
        if path.is_empty() { "options".into() } else { path }
    }

    // What follows is no part of the functions that read each struct, which there are many of.
    #[inline(never)]
    fn fields<'b>(
        &'b self,
        names: &'static [&'static str],
        own: &'b Known,
    ) -> Reading<FieldsOf<'b>> {
        if !given::is_plain(&self.value) {
            return Err(self.wrong_type("an object"));
        }
        let known = self.known.unwrap_or(own);
        let record = self.kind.and_then(Kind::record);
        Ok(FieldsOf::new(self.value.unchecked_ref(), names, record, &self.at, known))
    }

    #[inline(never)]
    fn choice(&self, names: &[&str]) -> Reading<StringDeserializer<ReadError>> {
        match self.value.as_string() {
            Some(name) => Ok(shortened(&name).into_deserializer()),
            None => Err(self.wrong_type(&format!("one of {}", names.join(", ")))),
        }
    }

    #[inline(never)]
    fn check_length(&self, expected: usize) -> Reading<()> {
        let given = self.items()?.length();
        if given == expected {
            return Ok(());
        }
        let (what, expected) = (self.at.path(), format!("[{expected}]"));
        Err(BindingError::from(InputError::Shape { what, expected, given: vec![given] }).into())
    }

    #[inline(never)]
    fn refuse_others(&self, own: &Known) -> Reading<()> {
        if self.known.is_none() {
            own.refuse_others(self.value.unchecked_ref(), &self.at)?;
        }
        Ok(())
    }

    fn whole<'de, V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        let is_number = self.value.as_f64();
        // Only what Rust keeps in 64 bits, as seeds, may need more than a number holds.
        let is_seed = is_number.is_none() && std::any::type_name::<V::Value>() == "u64";
        if is_number.is_none() && !(is_seed && self.value.is_bigint()) {
            let or = if is_seed { " or a bigint" } else { "" };
            return Err(self.wrong_type(&format!("a whole number{or}")));
        }
        let expected = "a whole number from 0 to 2^53 - 1, or a bigint up to 2^64 - 1";
        serde::Deserializer::deserialize_u64(self.leaf(), visitor).map_err(|_| match is_number {
            Some(given) => self.out_of_range(expected, given),
            None => self.wrong_type(expected),
        })
    }
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        let placed = |error: ReadError| error.at(&self.at);
        if let Some(number) = self.value.as_f64() {
            if number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number) {
                return visitor.visit_u64(number as u64).map_err(placed);
            }
            return visitor.visit_f64(number).map_err(placed);
        }
        if let Some(text) = self.value.as_string() {
            return visitor.visit_string(text).map_err(placed);
        }
        if given::is_array(&self.value) {
            return self.deserialize_seq(visitor);
        }
        if given::is_plain(&self.value) {
            return self.deserialize_map(visitor);
        }
        let expected = Expected(&visitor).to_string();
        Err(self.wrong_type(&expected))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        let truth = self.value.as_bool().ok_or_else(|| self.wrong_type("true or false"))?;
        visitor.visit_bool(truth)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        visitor.visit_f64(self.number()?)
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_i32<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        let number = self.number()?;
        if number.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number) {
            return visitor.visit_i32(number as i32);
        }
        Err(self.out_of_range("a whole number of 32 bits", number))
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.whole(visitor)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.whole(visitor)
    }

    fn deserialize_u16<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.whole(visitor)
    }

    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.whole(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        let text = self.value.as_string().ok_or_else(|| self.wrong_type("a string"))?;
        visitor.visit_string(text).map_err(|error: ReadError| error.at(&self.at))
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        self.deserialize_string(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Reading<V::Value> {
        let name = self.choice(variants)?;
        visitor.visit_enum(name).map_err(|error| error.at(&self.at))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        if self.value.is_undefined() || self.value.is_null() {
            return visitor.visit_none();
        }
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Reading<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        visitor.visit_seq(self.items()?)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Reading<V::Value> {
        self.check_length(len)?;
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        if !given::is_plain(&self.value) {
            return Err(self.wrong_type("an object"));
        }
        let entries = Entries::new(self.value.unchecked_ref(), &self.at, self.is_angle)?;
        visitor.visit_map(entries).map_err(|error| error.at(&self.at))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Reading<V::Value> {
        let own = Known::default();
        let found = self.fields(fields, &own)?;
        let read = visitor.visit_map(found).map_err(|error| error.at(&self.at))?;
        self.refuse_others(&own)?;
        Ok(read)
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Reading<V::Value> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        i8 i16 i64 i128 u128 char bytes byte_buf unit unit_struct tuple_struct identifier
    }
}

/// What a visitor expects, in words.
struct Expected<'a, V>(&'a V);

impl<'de, V: Visitor<'de>> std::fmt::Display for Expected<'_, V> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.expecting(f)
    }
}
