//! Options and results that describe themselves (`boresight_options`), carried over the
//! boundary by serde: objects are read and written here, in the names and units of JavaScript, and
//! every leaf by serde-wasm-bindgen.

mod known;
mod names;
mod read;
mod refusal;
mod walk;
mod write;

pub use known::Known;
pub use names::property;
pub use read::{Reader, read, read_named, read_optional};
pub use write::{write, write_all};
