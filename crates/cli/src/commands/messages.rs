//! The messages of a topic of a recording, as lines of JSON.

use crate::error::CliError;
use crate::files::Files;
use boresight_formats::mcap::{Channel, McapSink, McapStream, Message, Schema};
use boresight_formats::ros::{Definitions, Encoding, Field, Kind, Value, decode};
use serde_json::{Map, json};
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

/// Bytes read from a file at a time.
const PIECE: usize = 1 << 20;

struct Lines<'a> {
    topic: &'a str,
    decoders: BTreeMap<u16, Result<(Definitions, Encoding), String>>,
    text: String,
}

impl McapSink for Lines<'_> {
    fn channel(&mut self, channel: &Channel, schema: Option<&Schema>) -> bool {
        if channel.topic != self.topic {
            return false;
        }
        let decoder = schema.and_then(|schema| {
            let encoding = Encoding::of_names(&channel.encoding, &schema.encoding)?;
            Some((Definitions::parse(&schema.data)?, encoding))
        });
        let why = || format!("encoded as {:?}, which is not read", channel.encoding);
        self.decoders.insert(channel.id, decoder.ok_or_else(why));
        true
    }

    fn message(&mut self, message: Message<'_>) -> bool {
        let Some(decoder) = self.decoders.get(&message.channel) else { return false };
        let value = decoder.as_ref().map_err(Clone::clone).and_then(|(definitions, encoding)| {
            let value = decode(definitions, message.data, *encoding).map_err(str::to_owned)?;
            Ok(as_json(definitions, 0, &value))
        });
        let line = match value {
            Ok(value) => json!({ "logTimeNs": message.log_time_ns, "message": value }),
            Err(error) => json!({ "logTimeNs": message.log_time_ns, "error": error }),
        };
        self.text += &format!("{line}\n");
        true
    }
}

/// A value of a type by the names of its fields; what is not finite becomes null.
fn as_json(definitions: &Definitions, of: usize, value: &Value<'_>) -> serde_json::Value {
    match value {
        Value::Number(number) => (*number).into(),
        Value::Text(text) => text.as_ref().into(),
        Value::Numbers(numbers) => numbers.iter().collect(),
        Value::List(values) => values.iter().map(|value| as_json(definitions, of, value)).collect(),
        Value::Struct(values) => {
            let fields = definitions.get(of).fields.iter().zip(values);
            let of_kind = |field: &Field| match field.kind {
                Kind::Struct(of) => of,
                _ => 0,
            };
            let named = fields.map(|(field, value)| {
                (field.name.clone(), as_json(definitions, of_kind(field), value))
            });
            named.collect::<Map<_, _>>().into()
        }
    }
}

/// The messages of a topic.
pub fn run(path: &Path, topic: &str, files: &Files) -> Result<String, CliError> {
    let failed = |error| CliError::File { action: "read", path: path.into(), error };
    let mut file = files.open(path)?;
    let mut lines = Lines { topic, decoders: BTreeMap::new(), text: String::new() };
    let mut stream = McapStream::default();
    let mut piece = vec![0; PIECE];
    loop {
        let count = file.read(&mut piece).map_err(failed)?;
        if count == 0 {
            break;
        }
        stream.push(piece.get(..count).unwrap_or_default(), &mut lines)?;
    }
    stream.finish(&mut lines);
    if lines.decoders.is_empty() {
        let names: Vec<_> = stream.channels().map(|(channel, ..)| &*channel.topic).collect();
        return Err(CliError::Option {
            option: "--messages",
            expected: format!("one of {}", names.join(", ")),
            given: format!("{topic:?}"),
        });
    }
    Ok(lines.text)
}
