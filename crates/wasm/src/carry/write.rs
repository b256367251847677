//! Results as plain JavaScript objects with typed arrays of their own.

use super::names::{Property, property};
use boresight_options::columns::number_type;
use boresight_options::{FLAT_NEWTYPE, NumberType};
use js_sys::{Array, Float32Array, Float64Array, Int8Array, Object, Uint8Array, Uint32Array};
use serde::ser::{
    Serialize, SerializeMap, SerializeSeq, SerializeStruct, SerializeTuple, Serializer,
};
use std::borrow::Cow;
use std::fmt::{Display, Formatter};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

/// A result as a plain object. What serde cannot write, of which there is none, becomes undefined.
pub fn write<T: Serialize + ?Sized>(value: &T) -> JsValue {
    value.serialize(Writer::default()).ok().flatten().unwrap_or(JsValue::UNDEFINED)
}

/// Results as a list of plain objects.
pub fn write_all<T: Serialize>(values: impl IntoIterator<Item = T>) -> Array {
    values.into_iter().map(|value| write(&value)).collect()
}

// Setting a property of a fresh plain object cannot fail, and costs half of what `Reflect.set` does. A number that is set as
// one costs half again of what it does as a value.
#[wasm_bindgen]
extern "C" {
    type Plain;

    #[wasm_bindgen(method, structural, indexing_setter)]
    fn set(this: &Plain, key: &JsValue, value: &JsValue);

    #[wasm_bindgen(method, structural, indexing_setter)]
    fn set_number(this: &Plain, key: &JsValue, value: f64);

    type Fresh;

    #[wasm_bindgen(method, js_name = push)]
    fn push_number(this: &Fresh, value: f64);
}

/// What no result is: an enum with data, or what serde_wasm_bindgen refuses.
#[derive(Debug)]
struct Unwritable;

impl Display for Unwritable {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str("a value that cannot be written")
    }
}

impl std::error::Error for Unwritable {}

impl serde::ser::Error for Unwritable {
    fn custom<T: Display>(_: T) -> Self {
        Self
    }
}

type Written<T> = Result<T, Unwritable>;

/// Where a value goes.
#[derive(Clone, Copy, Default)]
enum Place<'a> {
    /// To whoever asked.
    #[default]
    Answer,
    Property(&'a Object, &'a JsValue),
    Item(&'a Array),
    /// Its fields go among those of another object.
    Spread(&'a Object),
}

impl Place<'_> {
    fn put(self, value: &JsValue) {
        match self {
            Self::Property(object, key) => object.unchecked_ref::<Plain>().set(key, value),
            Self::Item(array) => {
                array.push(value);
            }
            Self::Answer | Self::Spread(_) => {}
        }
    }
}

/// How a value is written.
#[derive(Clone, Copy, Default)]
struct Writer<'a> {
    is_angle: bool,
    place: Place<'a>,
    /// Which numbers the bytes are that come next.
    column: Option<NumberType>,
}

impl Writer<'_> {
    /// Returns the writer for the value in a newtype: a flat struct, or the bytes of numbers.
    // Once for all types of values, which keeps the module small.
    #[inline(never)]
    fn inside(self, name: &str) -> Self {
        match self.place {
            Place::Property(object, _) if name == FLAT_NEWTYPE => {
                Writer { place: Place::Spread(object), ..self }
            }
            _ => Writer { column: number_type(name).or(self.column), ..self },
        }
    }
}

const LEAVES: serde_wasm_bindgen::Serializer =
    serde_wasm_bindgen::Serializer::new().serialize_missing_as_null(true);

macro_rules! leaves {
    ($($method:ident($type:ty))*) => {$(
        fn $method(self, value: $type) -> Written<Answer> {
            LEAVES.$method(value).map(Some).map_err(|_| Unwritable)
        }
    )*};
}

macro_rules! numbers {
    ($($method:ident($type:ty))*) => {$(
        fn $method(self, value: $type) -> Written<Answer> {
            self.serialize_f64(value.into())
        }
    )*};
}

/// A value that has still to be put in its place; none where it is there.
type Answer = Option<JsValue>;

impl<'a> Serializer for Writer<'a> {
    type Ok = Answer;
    type Error = Unwritable;
    type SerializeSeq = List;
    type SerializeTuple = List;
    type SerializeTupleStruct = serde::ser::Impossible<Answer, Unwritable>;
    type SerializeTupleVariant = serde::ser::Impossible<Answer, Unwritable>;
    type SerializeMap = Entries;
    type SerializeStruct = Fields<'a>;
    type SerializeStructVariant = serde::ser::Impossible<Answer, Unwritable>;

    leaves! {
        serialize_bool(bool) serialize_i64(i64) serialize_char(char) serialize_str(&str)
    }

    numbers! {
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_f32(f32)
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    fn serialize_u64(self, value: u64) -> Written<Answer> {
        match u32::try_from(value) {
            Ok(value) => self.serialize_u32(value),
            Err(_) => LEAVES.serialize_u64(value).map(Some).map_err(|_| Unwritable),
        }
    }

    fn serialize_f64(self, value: f64) -> Written<Answer> {
        let value = if self.is_angle { value.to_degrees() } else { value };
        match self.place {
            Place::Property(object, key) => {
                object.unchecked_ref::<Plain>().set_number(key, value);
            }
            Place::Item(array) => array.unchecked_ref::<Fresh>().push_number(value),
            Place::Answer | Place::Spread(_) => return Ok(Some(value.into())),
        }
        Ok(None)
    }

    fn serialize_bytes(self, bytes: &[u8]) -> Written<Answer> {
        Ok(Some(match self.column {
            Some(NumberType::F64) if self.is_angle => {
                let radians: Cow<'_, [f64]> = numbers(bytes);
                let degrees: Vec<f64> =
                    radians.iter().map(|radians| radians.to_degrees()).collect();
                Float64Array::new_from_slice(&degrees).into()
            }
            Some(NumberType::F64) => Float64Array::new_from_slice(&numbers(bytes)).into(),
            Some(NumberType::F32) => Float32Array::new_from_slice(&numbers(bytes)).into(),
            Some(NumberType::U32) => Uint32Array::new_from_slice(&numbers(bytes)).into(),
            Some(NumberType::I8) => Int8Array::new_from_slice(&numbers(bytes)).into(),
            Some(NumberType::U8) | None => Uint8Array::new_from_slice(bytes).into(),
        }))
    }

    fn serialize_none(self) -> Written<Answer> {
        Ok(Some(JsValue::NULL))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Written<Answer> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Written<Answer> {
        self.serialize_none()
    }

    fn serialize_unit_struct(self, _: &'static str) -> Written<Answer> {
        self.serialize_none()
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
    ) -> Written<Answer> {
        Ok(Some(property(variant).key.clone()))
    }

    #[inline(always)]
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        value: &T,
    ) -> Written<Answer> {
        value.serialize(self.inside(name))
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: &T,
    ) -> Written<Answer> {
        Err(Unwritable)
    }

    fn serialize_seq(self, _: Option<usize>) -> Written<List> {
        Ok(List { array: Array::new(), is_angle: self.is_angle })
    }

    fn serialize_tuple(self, _: usize) -> Written<List> {
        self.serialize_seq(None)
    }

    fn serialize_tuple_struct(
        self,
        _: &'static str,
        _: usize,
    ) -> Written<Self::SerializeTupleStruct> {
        Err(Unwritable)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Written<Self::SerializeTupleVariant> {
        Err(Unwritable)
    }

    fn serialize_map(self, _: Option<usize>) -> Written<Entries> {
        Ok(Entries { object: Object::new(), key: JsValue::NULL, is_angle: self.is_angle })
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Written<Fields<'a>> {
        Ok(match self.place {
            Place::Spread(into) => Fields { own: None, into: Some(into) },
            _ => Fields { own: Some(Object::new()), into: None },
        })
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Written<Self::SerializeStructVariant> {
        Err(Unwritable)
    }
}

/// Bytes as what they were.
fn numbers<T: bytemuck::Pod>(bytes: &[u8]) -> Cow<'_, [T]> {
    let unaligned =
        || bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect();
    bytemuck::try_cast_slice(bytes).map_or_else(|_| Cow::Owned(unaligned()), Cow::Borrowed)
}

/// A list of values.
struct List {
    array: Array,
    is_angle: bool,
}

impl List {
    fn push<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        let place = Place::Item(&self.array);
        let writer = Writer { is_angle: self.is_angle, place, ..Writer::default() };
        if let Some(value) = value.serialize(writer)? {
            place.put(&value);
        }
        Ok(())
    }
}

impl SerializeSeq for List {
    type Ok = Answer;
    type Error = Unwritable;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        self.push(value)
    }

    fn end(self) -> Written<Answer> {
        Ok(Some(self.array.into()))
    }
}

impl SerializeTuple for List {
    type Ok = Answer;
    type Error = Unwritable;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        self.push(value)
    }

    fn end(self) -> Written<Answer> {
        Ok(Some(self.array.into()))
    }
}

/// A struct as an object.
struct Fields<'a> {
    own: Option<Object>,
    into: Option<&'a Object>,
}

impl Fields<'_> {
    fn object(&self) -> Option<&Object> {
        self.own.as_ref().or(self.into)
    }

    // Once for all types of values, which keeps the module small.
    #[inline(never)]
    fn writer(&self, field: &'static str) -> Writer<'_> {
        let Some(object) = self.object() else { return Writer::default() };
        let Property { key, is_angle, .. } = property(field);
        let place = Place::Property(object, key);
        Writer { is_angle: *is_angle, place, ..Writer::default() }
    }
}

impl SerializeStruct for Fields<'_> {
    type Ok = Answer;
    type Error = Unwritable;

    fn serialize_field<T: Serialize + ?Sized>(
        &mut self,
        field: &'static str,
        value: &T,
    ) -> Written<()> {
        let writer = self.writer(field);
        if let Some(value) = value.serialize(writer)? {
            writer.place.put(&value);
        }
        Ok(())
    }

    fn end(self) -> Written<Answer> {
        Ok(self.own.map(Into::into))
    }
}

/// A map as an object.
struct Entries {
    object: Object,
    key: JsValue,
    is_angle: bool,
}

impl SerializeMap for Entries {
    type Ok = Answer;
    type Error = Unwritable;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Written<()> {
        self.key = key.serialize(Writer::default())?.unwrap_or(JsValue::UNDEFINED);
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        let place = Place::Property(&self.object, &self.key);
        let writer = Writer { is_angle: self.is_angle, place, ..Writer::default() };
        if let Some(value) = value.serialize(writer)? {
            place.put(&value);
        }
        Ok(())
    }

    fn end(self) -> Written<Answer> {
        Ok(Some(self.object.into()))
    }
}
