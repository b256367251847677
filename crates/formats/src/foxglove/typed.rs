//! Channels of described types, and their messages.

use super::Channel;
use super::schema::{self, Spelling};
use crate::json;
use boresight_options::Described;
use boresight_options::naming::javascript;
use serde::Serialize;
use serde_json::Value;

const JSON: &str = "json";
const JSON_SCHEMA: &str = "jsonschema";

fn channel<T: Described>(
    topic: String,
    name: &'static str,
    spelling: Spelling,
    left_out: &[&str],
) -> Channel {
    Channel {
        topic,
        encoding: JSON,
        schema_name: name,
        schema_encoding: JSON_SCHEMA,
        schema: schema::of(&T::KIND, name, spelling, left_out).to_string().into(),
        lasting: false,
    }
}

/// A channel of messages of one of Foxglove's own schemas; [`encode`] writes them.
#[must_use]
pub fn known<T: Described>(topic: String, name: &'static str) -> Channel {
    channel::<T>(topic, name, Spelling::Same, &[])
}

/// A channel of messages of our own, in names and units outside Rust and without the fields in `left_out`;
/// [`encode_own`] writes them.
#[must_use]
pub fn own<T: Described>(topic: String, name: &'static str, left_out: &[&str]) -> Channel {
    channel::<T>(topic, name, Spelling::JavaScript, left_out)
}

impl Channel {
    /// The same, with messages that hold until the next.
    #[must_use]
    pub fn lasting(self) -> Self {
        Self { lasting: true, ..self }
    }
}

/// A message of one of Foxglove's own schemas.
#[must_use]
pub fn encode(message: &impl Serialize) -> Vec<u8> {
    // No message has keys that are no text, which alone cannot be written.
    serde_json::to_vec(message).unwrap_or_default()
}

/// A message of our own; what is not known or not finite is left out, and lists in a list follow one another.
#[must_use]
pub fn encode_own(message: &(impl Serialize + Described), left_out: &[&str]) -> Vec<u8> {
    let mut value = json::result(message);
    if let Value::Object(fields) = &mut value {
        fields.retain(|name, _| !left_out.iter().any(|out| javascript(out) == *name));
    }
    encode(&plain(value))
}

fn plain(value: Value) -> Value {
    match value {
        Value::Object(fields) => fields
            .into_iter()
            .filter(|(_, value)| !value.is_null())
            .map(|(name, value)| (name, plain(value)))
            .collect(),
        Value::Array(items) => {
            let mut all = vec![];
            for item in items.into_iter().map(plain) {
                match item {
                    Value::Array(inner) => all.extend(inner),
                    other => all.push(other),
                }
            }
            Value::Array(all)
        }
        other => other,
    }
}
