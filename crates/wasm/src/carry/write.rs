//! Results as plain JavaScript objects with typed arrays of their own.

use super::names::{Property, property};
use boresight_core::describe::NumberType;
use boresight_core::describe::columns::number_type;
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
    value.serialize(Writer::default()).unwrap_or(JsValue::UNDEFINED)
}

/// Results as a list of plain objects.
pub fn write_all<T: Serialize>(values: impl IntoIterator<Item = T>) -> Array {
    values.into_iter().map(|value| write(&value)).collect()
}

// Setting a property of a fresh plain object cannot fail, and costs half of what `Reflect.set` does.
#[wasm_bindgen]
extern "C" {
    type Plain;

    #[wasm_bindgen(method, structural, indexing_setter)]
    fn set(this: &Plain, key: &JsValue, value: &JsValue);
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

/// How a value is written.
#[derive(Clone, Copy, Default)]
struct Writer<'a> {
    is_angle: bool,
    /// Where the value's fields stand among those of another object.
    into: Option<&'a Object>,
    /// Which numbers the bytes are that come next.
    column: Option<NumberType>,
}

const LEAVES: serde_wasm_bindgen::Serializer =
    serde_wasm_bindgen::Serializer::new().serialize_missing_as_null(true);

macro_rules! leaves {
    ($($method:ident($type:ty))*) => {$(
        fn $method(self, value: $type) -> Written<JsValue> {
            LEAVES.$method(value).map_err(|_| Unwritable)
        }
    )*};
}

impl<'a> Serializer for Writer<'a> {
    type Ok = JsValue;
    type Error = Unwritable;
    type SerializeSeq = List;
    type SerializeTuple = List;
    type SerializeTupleStruct = serde::ser::Impossible<JsValue, Unwritable>;
    type SerializeTupleVariant = serde::ser::Impossible<JsValue, Unwritable>;
    type SerializeMap = Entries;
    type SerializeStruct = Fields<'a>;
    type SerializeStructVariant = serde::ser::Impossible<JsValue, Unwritable>;

    leaves! {
        serialize_bool(bool)
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32) serialize_i64(i64)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_u64(u64)
        serialize_f32(f32) serialize_char(char) serialize_str(&str)
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    fn serialize_f64(self, value: f64) -> Written<JsValue> {
        Ok(if self.is_angle { value.to_degrees() } else { value }.into())
    }

    fn serialize_bytes(self, bytes: &[u8]) -> Written<JsValue> {
        Ok(match self.column {
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
        })
    }

    fn serialize_none(self) -> Written<JsValue> {
        Ok(JsValue::NULL)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Written<JsValue> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Written<JsValue> {
        Ok(JsValue::NULL)
    }

    fn serialize_unit_struct(self, _: &'static str) -> Written<JsValue> {
        Ok(JsValue::NULL)
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
    ) -> Written<JsValue> {
        Ok(property(variant).key.clone())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        value: &T,
    ) -> Written<JsValue> {
        // The bytes of the numbers come next.
        value.serialize(Writer { column: number_type(name).or(self.column), ..self })
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: &T,
    ) -> Written<JsValue> {
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
        Ok(Fields { own: self.into.is_none().then(Object::new), into: self.into })
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
        let writer = Writer { is_angle: self.is_angle, ..Writer::default() };
        self.array.push(&value.serialize(writer)?);
        Ok(())
    }
}

impl SerializeSeq for List {
    type Ok = JsValue;
    type Error = Unwritable;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        self.push(value)
    }

    fn end(self) -> Written<JsValue> {
        Ok(self.array.into())
    }
}

impl SerializeTuple for List {
    type Ok = JsValue;
    type Error = Unwritable;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        self.push(value)
    }

    fn end(self) -> Written<JsValue> {
        Ok(self.array.into())
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

    // These are once for all types of values, which keeps the module small.
    #[inline(never)]
    fn place(&self, field: &'static str) -> (Writer<'_>, Option<&'static Property>) {
        if field.starts_with("..") {
            return (Writer { into: self.object(), ..Writer::default() }, None);
        }
        let property = property(field);
        (Writer { is_angle: property.is_angle, ..Writer::default() }, Some(property))
    }

    #[inline(never)]
    fn set(&self, property: Option<&Property>, value: &JsValue) {
        if let (Some(object), Some(property)) = (self.object(), property) {
            object.unchecked_ref::<Plain>().set(&property.key, value);
        }
    }
}

impl SerializeStruct for Fields<'_> {
    type Ok = JsValue;
    type Error = Unwritable;

    fn serialize_field<T: Serialize + ?Sized>(
        &mut self,
        field: &'static str,
        value: &T,
    ) -> Written<()> {
        let (writer, property) = self.place(field);
        let value = value.serialize(writer)?;
        self.set(property, &value);
        Ok(())
    }

    fn end(self) -> Written<JsValue> {
        Ok(self.own.map_or(JsValue::UNDEFINED, Into::into))
    }
}

/// A map as an object.
struct Entries {
    object: Object,
    key: JsValue,
    is_angle: bool,
}

impl SerializeMap for Entries {
    type Ok = JsValue;
    type Error = Unwritable;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Written<()> {
        self.key = key.serialize(Writer::default())?;
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Written<()> {
        let value = value.serialize(Writer { is_angle: self.is_angle, ..Writer::default() })?;
        self.object.unchecked_ref::<Plain>().set(&self.key, &value);
        Ok(())
    }

    fn end(self) -> Written<JsValue> {
        Ok(self.object.into())
    }
}
