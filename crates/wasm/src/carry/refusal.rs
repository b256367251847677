//! Why a value was refused, in one word of memory: serde passes it through every field of every struct.

use crate::error::BindingError;
use boresight_core::InputError;
use boresight_options::At;
use serde::de::{Expected, Unexpected};
use std::fmt::{Debug, Display};
use thiserror::Error;

/// A [`BindingError`] on the heap.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct ReadError(Box<BindingError>);

impl ReadError {
    /// Says where the value was that serde refused, which it does not know itself.
    #[must_use]
    pub fn at(self, at: &At<'_>) -> Self {
        (*self.0).at(at).into()
    }
}

impl From<BindingError> for ReadError {
    fn from(error: BindingError) -> Self {
        Self(Box::new(error))
    }
}

impl From<ReadError> for BindingError {
    fn from(error: ReadError) -> Self {
        *error.0
    }
}

impl serde::de::Error for ReadError {
    fn custom<T: Display>(message: T) -> Self {
        let (expected, given) = (message.to_string(), "another".into());
        BindingError::Type { what: String::new(), expected, given }.into()
    }

    fn invalid_type(given: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let (expected, given) = (expected.to_string(), given.to_string());
        BindingError::Type { what: String::new(), expected, given }.into()
    }

    fn invalid_value(given: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(given, expected)
    }

    fn unknown_variant(given: &str, expected: &'static [&'static str]) -> Self {
        let (what, expected, given) = (String::new(), expected.join(", "), given.into());
        BindingError::from(InputError::Unknown { what, expected, given }).into()
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        BindingError::UnknownField { what: field.into(), expected: expected.join(", ") }.into()
    }

    fn missing_field(field: &'static str) -> Self {
        let what = super::names::property(field).name.clone();
        BindingError::Missing { what, expected: "a value".into() }.into()
    }
}
