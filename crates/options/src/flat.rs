//! Fields that are flattened outside Rust.

use crate::check::At;
use crate::description::{Described, Kind, Range};
use boresight_math::InputError;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt::{Debug, Formatter};
use std::ops::{Deref, DerefMut};

/// A nested struct whose fields are among those of the outer struct outside Rust: in JavaScript,
/// JSON, flags, schemas and Python.
///
/// serde's own `flatten` writes structs as maps, which makes the WebAssembly modules larger. With this
/// type the struct stays nested for serde. The code that converts names and units for users also
/// flattens. It recognizes a flat field by [`Field::flat`](crate::Field::flat), or by the name of the
/// newtype, [`FLAT_NEWTYPE`].
///
/// ```
/// use boresight_options::{Described, Flat, Kind};
/// use serde::Serialize;
///
/// /// A place.
/// #[derive(Described, Serialize)]
/// struct Place {
///     /// Distance.
///     range_m: f64,
/// }
///
/// /// A target: `{ rangeM, powerDb }` in JavaScript.
/// #[derive(Described, Serialize)]
/// struct Target {
///     /// Where it is.
///     place: Flat<Place>,
///     /// Its power.
///     power_db: f64,
/// }
///
/// let target = Target { place: Place { range_m: 4.0 }.into(), power_db: 0.0 };
/// assert_eq!(target.place.range_m, 4.0);
/// let Kind::Record(record) = Target::KIND else { panic!("a struct") };
/// assert!(record.fields[0].flat && !record.fields[1].flat);
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Flat<T>(pub T);

/// The name under which serde writes a [`Flat`] as a newtype.
pub const FLAT_NEWTYPE: &str = "flat struct";

impl<T> Deref for Flat<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Flat<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T> From<T> for Flat<T> {
    fn from(value: T) -> Self {
        Self(value)
    }
}

/// Formats the struct without a name for the newtype.
impl<T: Debug> Debug for Flat<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

// Inlined, since every type has its own copy, which would make the WebAssembly modules larger.
impl<T: Serialize> Serialize for Flat<T> {
    #[inline(always)]
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_newtype_struct(FLAT_NEWTYPE, &self.0)
    }
}

// Without a visitor of newtypes for the same reason.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for Flat<T> {
    #[inline(always)]
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self)
    }
}

impl<T: Described> Described for Flat<T> {
    const KIND: Kind = T::KIND;
    const FLAT: bool = true;

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        self.0.check(range, at)
    }
}
