//! The version of the formats of plans and records.
//!
//! Every release reads the lines of all earlier releases. A line of a later release that this one cannot read correctly states a larger number.

use serde::Deserialize;

/// The version that is written.
pub const SCHEMA: u32 = 1;

/// The version of lines that state none.
pub(crate) fn first() -> u32 {
    1
}

/// The version of a line of a later release, which need not be readable otherwise.
pub(crate) fn newer(line: &[u8]) -> Option<u32> {
    #[derive(Deserialize)]
    struct Versioned {
        schema: u32,
    }
    let found: Versioned = serde_json::from_slice(line).ok()?;
    (found.schema > SCHEMA).then_some(found.schema)
}
