//! Many numbers, which JavaScript has as an array of their type, and text formats as a list.
//!
//! A field of a result says so by `#[serde(serialize_with = "columns::serialize")]`; JSON gets a
//! list, a binary serializer a newtype named after the type around the numbers' bytes.

use crate::description::NumberType;
use ndarray::{Array, Dimension};
use serde::ser::{Serialize, Serializer};

/// A type that columns are made of.
pub trait Element: bytemuck::NoUninit + Serialize {
    /// The type for descriptions.
    const TYPE: NumberType;
}

macro_rules! elements {
    ($($type:ty = $number_type:ident),*) => {
        $(impl Element for $type {
            const TYPE: NumberType = NumberType::$number_type;
        })*
    };
}
elements!(f64 = F64, f32 = F32, u32 = U32, u8 = U8, i8 = I8);

const NAMES: [(&str, NumberType); 5] = [
    ("f64 column", NumberType::F64),
    ("f32 column", NumberType::F32),
    ("u32 column", NumberType::U32),
    ("u8 column", NumberType::U8),
    ("i8 column", NumberType::I8),
];

/// The numbers that a newtype of this name holds.
#[must_use]
pub fn number_type(name: &str) -> Option<NumberType> {
    NAMES.iter().find(|(known, _)| *known == name).map(|(_, of)| *of)
}

/// Serializes a column.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<T: Element, S: Serializer>(
    numbers: &[T],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    if serializer.is_human_readable() {
        return serializer.collect_seq(numbers);
    }
    let name = NAMES.iter().find(|(_, of)| *of == T::TYPE).map_or("", |(name, _)| name);
    serializer.serialize_newtype_struct(name, &Bytes(bytemuck::cast_slice(numbers)))
}

/// Serializes a column where there is one.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_some<T: Element, S: Serializer>(
    numbers: &Option<Vec<T>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match numbers {
        Some(numbers) => serialize(numbers, serializer),
        None => serializer.serialize_none(),
    }
}

/// Serializes an array of any shape as a column, the last axis fastest.
///
/// # Errors
/// Those of the serializer.
pub fn serialize_array<T: Element + Clone, D: Dimension, S: Serializer>(
    array: &Array<T, D>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match array.as_slice() {
        Some(numbers) => serialize(numbers, serializer),
        None => serialize(&array.iter().cloned().collect::<Vec<T>>(), serializer),
    }
}

struct Bytes<'a>(&'a [u8]);

impl Serialize for Bytes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self.0)
    }
}
