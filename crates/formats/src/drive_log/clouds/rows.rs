//! Rows of a table of JSON, one after the other: the tables of nuScenes take gigabytes.

use crate::error::FormatError;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, IgnoredAny, SeqAccess, Visitor};
use std::fmt::Formatter;
use std::io::{BufReader, Read};
use std::marker::PhantomData;

/// Hands each row of an array to `each`; fields that a row does not name are skipped.
pub(super) fn each_row<T: DeserializeOwned>(
    file: &'static str,
    reader: impl Read,
    each: impl FnMut(T),
) -> Result<(), FormatError> {
    let wrong = |error: serde_json::Error| FormatError::Json {
        file,
        expected: "an array of rows as nuScenes has them",
        given: error.to_string(),
    };
    let mut json = serde_json::Deserializer::from_reader(BufReader::new(reader));
    Rows { each, row: PhantomData::<T> }.deserialize(&mut json).map_err(wrong)?;
    json.end().map_err(wrong)
}

struct Rows<F, T> {
    each: F,
    row: PhantomData<T>,
}

impl<'de, T: DeserializeOwned, F: FnMut(T)> DeserializeSeed<'de> for Rows<F, T> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de, T: DeserializeOwned, F: FnMut(T)> Visitor<'de> for Rows<F, T> {
    type Value = ();

    fn expecting(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut rows: A) -> Result<(), A::Error> {
        while let Some(row) = rows.next_element()? {
            (self.each)(row);
        }
        while rows.next_element::<IgnoredAny>()?.is_some() {}
        Ok(())
    }
}
