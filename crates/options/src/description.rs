//! The description of a type: what its values are called, look like, and may be.

use crate::check::At;
pub use boresight_derive::Described;
use boresight_math::InputError;

/// What a description says in words. WebAssembly has none of it: whoever uses a module finds it in what
/// is generated, and it would be a tenth of what is downloaded.
#[must_use]
pub const fn doc(text: &'static str) -> &'static str {
    if cfg!(target_family = "wasm") { "" } else { text }
}

/// A type that says what it is.
pub trait Described {
    /// What values of it look like.
    const KIND: Kind;

    /// What a list of them looks like.
    const LIST: Kind = Kind::List(&Self::KIND);

    /// Whether a field of this type is flattened outside Rust; only of [`Flat`](crate::Flat).
    const FLAT: bool = false;

    /// Checks the value and what it holds against the ranges of their descriptions; `range` is that
    /// of the field it stands in, `at` its place in errors.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for the first number out of its range.
    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        let _ = (range, at);
        Ok(())
    }
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number from 0.
    Whole,
    /// A whole number from 0 that may need 64 bits, such as a seed.
    Seed,
    /// True or false.
    Truth,
    /// Text.
    Text,
    /// Many numbers, in an array of their type.
    Numbers(NumberType),
    /// One of several names.
    Choice(&'static Choice),
    /// Fields.
    Record(&'static Record),
    /// A value, or none.
    Optional(&'static Kind),
    /// Any number of values.
    List(&'static Kind),
    /// A fixed number of values.
    Tuple(&'static Kind, usize),
    /// What only its own reader and writer know.
    Special(&'static Special),
}

impl Kind {
    /// Returns the record of a struct, or of an optional one.
    #[must_use]
    pub const fn record(&self) -> Option<&'static Record> {
        match self {
            Self::Record(record) => Some(record),
            Self::Optional(kind) => kind.record(),
            _ => None,
        }
    }

    /// Returns the kind of the items of a list, or of an optional one.
    #[must_use]
    pub const fn item(&self) -> Option<&'static Self> {
        match self {
            Self::List(kind) | Self::Tuple(kind, _) => Some(kind),
            Self::Optional(kind) => kind.item(),
            _ => None,
        }
    }

    /// What is accepted, in words.
    #[must_use]
    pub fn expected(&self) -> String {
        match self {
            Self::Number => "a number".into(),
            Self::Whole => "a whole number".into(),
            Self::Seed => "a whole number or a bigint".into(),
            Self::Truth => "true or false".into(),
            Self::Text => "a string".into(),
            Self::Numbers(_) | Self::List(_) | Self::Tuple(..) => "an array".into(),
            Self::Choice(choice) => {
                let names: Vec<&str> = choice.variants.iter().map(|(name, _)| *name).collect();
                format!("one of {}", names.join(", "))
            }
            Self::Record(_) => "an object".into(),
            Self::Optional(kind) => kind.expected(),
            Self::Special(special) => special.expected.into(),
        }
    }
}

/// The type of many numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberType {
    /// `f64`
    F64,
    /// `f32`
    F32,
    /// `u32`
    U32,
    /// `u8`
    U8,
    /// `i8`
    I8,
}

/// An enum without data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Name of the type in Rust.
    pub name: &'static str,
    /// What it chooses.
    pub doc: &'static str,
    /// Name and meaning of each.
    pub variants: &'static [(&'static str, &'static str)],
}

/// A struct.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// Name of the type in Rust.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its fields in order.
    pub fields: &'static [Field],
}

/// A field of a struct.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// Its name as serde has it, in Rust's writing.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// What its values are.
    pub kind: Kind,
    /// Whether its type is [`Flat`](crate::Flat): outside Rust the fields of its value are among those
    /// of the record.
    pub flat: bool,
    /// The numbers it may have; of angles in degrees.
    pub range: Option<Range>,
    /// Whether a result may come without it.
    pub may_be_absent: bool,
    /// Whether options have to name it.
    pub required: bool,
}

/// Numbers from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The least.
    pub low: f64,
    /// The greatest; infinite for none.
    pub high: f64,
    /// Whether `low` itself is excluded.
    pub above_low: bool,
}

/// A value whose reader and writer are written by hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Special {
    /// What is accepted, in words.
    pub expected: &'static str,
    /// Its type in TypeScript.
    pub typescript: &'static str,
    /// Its JSON Schema.
    pub schema: &'static str,
    /// What a flag of the command line takes, such as `N|aic|mdl`; empty where no flag can.
    pub flag: &'static str,
}

impl Special {
    /// What only TypeScript has a name for, with its JSON Schema.
    #[must_use]
    pub const fn in_typescript(typescript: &'static str, schema: &'static str) -> Self {
        Self { expected: typescript, typescript, schema, flag: "" }
    }
}
