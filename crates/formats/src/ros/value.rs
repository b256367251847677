//! Messages as values.

use super::definition::{Definitions, Field, Kind, Many};
use super::encoding::{Encoding, Malformed, NumberKind, Reader};
use std::borrow::Cow;

/// Deepest nesting of types.
const MAX_DEPTH: usize = 32;
/// Most values in one message, lists of numbers counting as one.
const MAX_VALUES: usize = 1 << 22;

/// A value of a message.
#[derive(Debug, Clone, PartialEq)]
pub enum Value<'a> {
    /// A number, or a truth as 0 or 1.
    Number(f64),
    /// Text.
    Text(Cow<'a, str>),
    /// Many numbers.
    Numbers(Numbers<'a>),
    /// Many values.
    List(Vec<Value<'a>>),
    /// The values of a type's fields, in order.
    Struct(Vec<Value<'a>>),
}

/// Many numbers, as they stand in the message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers<'a> {
    /// Their bytes.
    pub bytes: &'a [u8],
    /// What each is.
    pub kind: NumberKind,
    /// The order of bytes in each.
    pub is_big_endian: bool,
}

impl Numbers<'_> {
    /// They one after another.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let each = self.bytes.chunks_exact(self.kind.size());
        each.filter_map(|bytes| self.kind.read(bytes, self.is_big_endian))
    }
}

impl<'a> Value<'a> {
    /// The value a path of [`Definitions::path`] leads to.
    pub fn at(&self, path: &[usize]) -> Option<&Self> {
        path.iter().try_fold(self, |value, &place| match value {
            Self::Struct(fields) => fields.get(place),
            _ => None,
        })
    }

    /// The number a path leads to.
    pub fn number(&self, path: &[usize]) -> Option<f64> {
        match self.at(path)? {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The text a path leads to.
    pub fn text(&self, path: &[usize]) -> Option<&str> {
        match self.at(path)? {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The values of the list a path leads to.
    pub fn list(&self, path: &[usize]) -> &[Self] {
        match self.at(path) {
            Some(Self::List(values)) => values,
            _ => &[],
        }
    }

    /// The bytes a path leads to.
    pub fn bytes(&self, path: &[usize]) -> Option<&'a [u8]> {
        match self.at(path)? {
            Self::Numbers(numbers) if numbers.kind.size() == 1 => Some(numbers.bytes),
            _ => None,
        }
    }
}

/// Decodes a message.
///
/// # Errors
/// What is wrong with it, in words. Bytes behind the message are no error: DDS pads.
pub fn decode<'a>(
    definitions: &Definitions,
    message: &'a [u8],
    encoding: Encoding,
) -> Result<Value<'a>, Malformed> {
    let mut decoder = Decoder { reader: Reader::new(message, encoding)?, definitions, values: 0 };
    decoder.of_type(0, 0)
}

struct Decoder<'a, 'd> {
    reader: Reader<'a>,
    definitions: &'d Definitions,
    values: usize,
}

impl<'a> Decoder<'a, '_> {
    fn of_type(&mut self, place: usize, depth: usize) -> Result<Value<'a>, Malformed> {
        if depth > MAX_DEPTH {
            return Err("its types are nested too deeply");
        }
        let fields = &self.definitions.get(place).fields;
        if fields.is_empty() && self.reader.encoding == Encoding::Cdr {
            // What has no fields has one for the sake of its languages.
            self.reader.number(NumberKind::U8)?;
        }
        let values =
            fields.iter().map(|field| self.field(field, depth)).collect::<Result<_, _>>()?;
        Ok(Value::Struct(values))
    }

    fn field(&mut self, field: &Field, depth: usize) -> Result<Value<'a>, Malformed> {
        let count = match field.many {
            Many::One => return self.one(field.kind, depth),
            Many::Fixed(count) => count,
            Many::Sequence => self.reader.length()?,
        };
        if let Kind::Number(kind) = field.kind {
            let bytes = self.reader.numbers(kind, count)?;
            return Ok(Value::Numbers(Numbers {
                bytes,
                kind,
                is_big_endian: self.reader.is_big_endian,
            }));
        }
        let values = (0..count).map(|_| self.one(field.kind, depth)).collect::<Result<_, _>>()?;
        Ok(Value::List(values))
    }

    fn one(&mut self, kind: Kind, depth: usize) -> Result<Value<'a>, Malformed> {
        self.values += 1;
        if self.values > MAX_VALUES {
            return Err("it holds too many values");
        }
        match kind {
            Kind::Number(kind) => self.reader.number(kind).map(Value::Number),
            Kind::Text => self.reader.text().map(Value::Text),
            Kind::WideText => self.reader.wide_text().map(Value::Text),
            Kind::Struct(place) => self.of_type(place, depth + 1),
        }
    }
}
