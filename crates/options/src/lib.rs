//! What options and results are, said once: by the definition of their type.
//!
//! `#[derive(Described)]` turns a struct or an enum into a description: names, documentation,
//! types, ranges and defaults. From it come the check of an option ([`check`]), what the command
//! line and JavaScript call it ([`naming`]), and, through `crates/generate`, TypeScript types, JSON
//! Schemas and the tables of the docs. Values are carried by serde, in the names and units of
//! Rust; whoever stands between Rust and its users renames and converts by [`naming`].
//!
//! ```
//! use boresight_options::{Described, Naming, check};
//! use serde::{Deserialize, Serialize};
//!
//! /// A lamp.
//! #[derive(Described, Serialize, Deserialize)]
//! #[serde(default)]
//! struct Lamp {
//!     /// Half width of its beam.
//!     #[option(default = 0.5, range = 1.0..=90.0)]
//!     beam_rad: f64,
//! }
//!
//! check(&Lamp::default(), Naming::Rust).unwrap();
//! let error = check(&Lamp { beam_rad: 2.0 }, Naming::JavaScript).unwrap_err();
//! assert!(error.to_string().starts_with("beamDeg is 114.59"));
//! assert!(error.to_string().ends_with("expected a number from 1 to 90"));
//! ```

mod check;
pub mod columns;
pub mod decibels;
pub mod description;
mod difference;
mod flat;
mod kinds;
mod named;
pub mod naming;
pub mod remark;
pub mod shaped;

// What `Described` derives names the crate from outside.
#[allow(unused_extern_crates)]
extern crate self as boresight_options;

pub use boresight_math::InputError;
pub use check::{At, Naming, check};
pub use description::{Choice, Described, Field, Kind, NumberType, Range, Record, Special, doc};
pub use difference::{differing_fields, lies_in};
pub use flat::{FLAT_NEWTYPE, Flat};
pub use named::Named;
pub use remark::Remark;
