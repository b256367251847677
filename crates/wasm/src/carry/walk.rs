//! What serde walks through: the fields of a struct, the items of an array, the entries of a map.

use super::known::Known;
use super::names::property;
use super::read::{Reader, Reading};
use super::refusal::ReadError;
use crate::given;
use boresight_options::{At, Field, Kind, Record};
use js_sys::{Object, Reflect};
use serde::de::{DeserializeSeed, IntoDeserializer, MapAccess, SeqAccess};
use std::iter::Zip;
use std::ops::RangeFrom;
use std::slice::Iter;
use std::vec::IntoIter;
use wasm_bindgen::JsValue;

/// The fields of a struct out of an object.
pub(super) struct FieldsOf<'a> {
    object: &'a Object,
    /// By their place, which serde takes for a name and compares at no cost.
    fields: Zip<RangeFrom<u64>, Iter<'static, &'static str>>,
    /// Their descriptions; empty without one of the struct.
    described: &'static [Field],
    at: &'a At<'a>,
    known: &'a Known,
    next: Option<Next>,
}

/// A field and the value to read it from: for a flat field, that of the outer struct.
struct Next {
    name: &'static str,
    described: Option<&'static Field>,
    value: JsValue,
}

fn is_flat(described: Option<&Field>) -> bool {
    described.is_some_and(|field| field.flat)
}

impl<'a> FieldsOf<'a> {
    pub fn new(
        object: &'a Object,
        names: &'static [&'static str],
        record: Option<&'static Record>,
        at: &'a At<'a>,
        known: &'a Known,
    ) -> Self {
        let described = record.map_or(&[][..], |record| record.fields);
        Self { object, fields: (0_u64..).zip(names), described, at, known, next: None }
    }

    /// The place of the next field that the object has.
    #[inline(never)]
    fn advance(&mut self) -> Reading<Option<u64>> {
        for (place, &name) in self.fields.by_ref() {
            let described = self.described.iter().find(|field| field.name == name);
            let value = if is_flat(described) {
                Some(self.object.clone().into())
            } else {
                let value = self.known.get(self.object, name);
                value.map_err(|_| given::throws(self.at.field(name).path()))?
            };
            if let Some(value) = value {
                self.next = Some(Next { name, described, value });
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    #[inline(never)]
    fn value(&mut self) -> Reader<'a> {
        let none = Next { name: "", described: None, value: JsValue::UNDEFINED };
        let Next { name, described, value } = self.next.take().unwrap_or(none);
        let is_flat = is_flat(described);
        Reader {
            value,
            at: if is_flat { *self.at } else { self.at.field(name) },
            is_angle: !is_flat && property(name).is_angle,
            kind: described.map(|field| &field.kind),
            known: is_flat.then_some(self.known),
        }
    }
}

impl<'de> MapAccess<'de> for FieldsOf<'_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Reading<Option<K::Value>> {
        match self.advance()? {
            Some(place) => seed.deserialize(place.into_deserializer()).map(Some),
            None => Ok(None),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Reading<V::Value> {
        let reader = self.value();
        let at = reader.at;
        seed.deserialize(reader).map_err(|error| error.at(&at))
    }
}

/// The items of an array.
pub(super) struct Items<'a> {
    array: &'a JsValue,
    length: u32,
    at: &'a At<'a>,
    is_angle: bool,
    kind: Option<&'static Kind>,
    next: u32,
}

impl<'a> Items<'a> {
    pub fn new(
        array: &'a JsValue,
        length: u32,
        at: &'a At<'a>,
        is_angle: bool,
        kind: Option<&'static Kind>,
    ) -> Self {
        Self { array, length, at, is_angle, kind, next: 0 }
    }

    pub fn length(&self) -> usize {
        self.length as usize
    }

    #[inline(never)]
    fn advance(&mut self) -> Reading<Option<Reader<'a>>> {
        if self.next >= self.length {
            return Ok(None);
        }
        let at = self.at.item(self.next as usize);
        let value = given::item(self.array, self.next, &|| at.path())?;
        self.next += 1;
        Ok(Some(Reader { value, at, is_angle: self.is_angle, kind: self.kind, known: None }))
    }
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Reading<Option<T::Value>> {
        let Some(reader) = self.advance()? else { return Ok(None) };
        let at = reader.at;
        seed.deserialize(reader).map_err(|error| error.at(&at)).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some((self.length - self.next) as usize)
    }
}

/// All entries of an object whose keys are not known beforehand.
pub(super) struct Entries<'a> {
    object: &'a Object,
    keys: IntoIter<JsValue>,
    at: &'a At<'a>,
    is_angle: bool,
    next: JsValue,
}

impl<'a> Entries<'a> {
    pub fn new(object: &'a Object, at: &'a At<'a>, is_angle: bool) -> Reading<Self> {
        let keys = given::keys(object, &|| at.path())?.to_vec().into_iter();
        Ok(Self { object, keys, at, is_angle, next: JsValue::UNDEFINED })
    }

    /// The name of the next entry that is not `undefined`.
    #[inline(never)]
    fn advance(&mut self) -> Option<String> {
        let absent =
            |key: &JsValue| Reflect::get(self.object, key).is_ok_and(|value| value.is_undefined());
        self.next = self.keys.find(|key| !absent(key))?;
        Some(self.next.as_string().unwrap_or_default())
    }
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Reading<Option<K::Value>> {
        match self.advance() {
            Some(name) => seed.deserialize(name.into_deserializer()).map(Some),
            None => Ok(None),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Reading<V::Value> {
        let name = self.next.as_string().unwrap_or_default();
        let at = self.at.field(&name);
        let value = Reflect::get(self.object, &self.next).map_err(|_| given::throws(at.path()))?;
        let reader = Reader { value, at, is_angle: self.is_angle, kind: None, known: None };
        seed.deserialize(reader).map_err(|error| error.at(&at))
    }
}
