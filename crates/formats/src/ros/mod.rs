//! Messages of ROS, decoded by the text of their definitions, which recordings hold beside them.
//!
//! [`Definitions`] reads the text, [`decode`] the bytes of a message: `cdr` as ROS 2 has it, in either
//! byte order, and `ros1`. Whatever the message, its fields are known by their names.

mod definition;
mod encoding;
#[cfg(test)]
pub(crate) mod made;
#[cfg(test)]
mod tests;
mod value;

pub use definition::{Definition, Definitions, Field, Kind, Many};
pub use encoding::{Encoding, Malformed, NumberKind};
pub use value::{Numbers, Value, decode};
