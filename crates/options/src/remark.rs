//! What a reader of a result should know: a stable name for programs, and a sentence.

use crate::description::Described;
use crate::flat::Flat;
use serde::{Serialize, Serializer};
use std::fmt::Display;

/// Something to know of a result; not an error.
#[derive(Debug, Clone, PartialEq, Eq, Described, Serialize)]
#[option(name = "Warning")]
pub struct Remark {
    /// A stable name for programs, in kebab case.
    pub code: &'static str,
    /// What a reader should know.
    pub message: String,
}

impl Remark {
    /// A remark of a stable name.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }
}

/// What becomes a [`Remark`] in a result: its own text is the message.
pub trait Coded: Display {
    /// A stable name for programs, in kebab case.
    fn code(&self) -> &'static str;

    /// The remark.
    fn remark(&self) -> Remark {
        Remark::new(self.code(), self.to_string())
    }
}

/// Serializes a value as its remark, which is [`Flat`].
///
/// # Errors
/// Those of the serializer.
pub fn serialize_flat<T: Coded, S: Serializer>(
    coded: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    Flat(coded.remark()).serialize(serializer)
}

/// Serializes a list as remarks.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<T: Coded, S: Serializer>(coded: &[T], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(coded.iter().map(Coded::remark))
}
