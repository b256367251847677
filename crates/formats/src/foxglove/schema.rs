//! JSON Schemas of described messages, in the part of JSON Schema that viewers read: a type a value, numbers of a name by `oneOf`,
//! no null, no lists of lists.

use boresight_options::{Kind, NumberType, Record, naming};
use serde_json::{Map, Value, json};

/// How fields are called outside Rust.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spelling {
    /// As in Rust: messages of Foxglove's own schemas.
    Same,
    /// As results are called outside Rust.
    JavaScript,
}

impl Spelling {
    fn of(self, name: &str) -> String {
        match self {
            Self::Same => name.into(),
            Self::JavaScript => naming::javascript(name),
        }
    }
}

/// The schema of a record, without the fields in `left_out`.
pub(super) fn of(kind: &Kind, title: &str, spelling: Spelling, left_out: &[&str]) -> Value {
    let mut schema = match kind {
        Kind::Record(of) => record(of, spelling, left_out),
        other => value(other, spelling),
    };
    schema["title"] = title.into();
    schema
}

fn record(record: &Record, spelling: Spelling, left_out: &[&str]) -> Value {
    let mut properties = Map::new();
    let mut required: Vec<Value> = vec![];
    add_fields(record, spelling, left_out, &mut properties, &mut required);
    json!({ "type": "object", "description": record.doc, "properties": properties, "required": required })
}

fn add_fields(
    record: &Record,
    spelling: Spelling,
    left_out: &[&str],
    properties: &mut Map<String, Value>,
    required: &mut Vec<Value>,
) {
    for field in record.fields.iter().filter(|field| !left_out.contains(&field.name)) {
        if let (true, Kind::Record(inner)) = (field.flat, field.kind) {
            add_fields(inner, spelling, left_out, properties, required);
            continue;
        }
        let name = spelling.of(field.name);
        let mut schema = value(&field.kind, spelling);
        schema["description"] = field.doc.into();
        // A number of our own messages may be infinite, and is then left out.
        let may_lack = field.may_be_absent
            || matches!(field.kind, Kind::Optional(_))
            || spelling == Spelling::JavaScript && field.kind == Kind::Number;
        if !may_lack {
            required.push(name.clone().into());
        }
        properties.insert(name, schema);
    }
}

fn value(kind: &Kind, spelling: Spelling) -> Value {
    match kind {
        Kind::Number => json!({ "type": "number" }),
        Kind::Whole | Kind::Seed => json!({ "type": "integer", "minimum": 0 }),
        Kind::Truth => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Choice(choice) => {
            let names: Vec<&str> = choice.variants.iter().map(|(name, _)| *name).collect();
            json!({ "type": "string", "enum": names })
        }
        Kind::Record(of) => record(of, spelling, &[]),
        Kind::Optional(inner) => value(inner, spelling),
        Kind::Numbers(of) => {
            let is_real = matches!(of, NumberType::F64 | NumberType::F32);
            let item = if is_real { "number" } else { "integer" };
            json!({ "type": "array", "items": { "type": item } })
        }
        Kind::List(inner) | Kind::Tuple(inner, _) => {
            json!({ "type": "array", "items": value(innermost(inner), spelling) })
        }
        Kind::Special(special) => serde_json::from_str(special.schema).unwrap_or(json!({})),
    }
}

/// What is in a list, or in the lists in it.
fn innermost(kind: &'static Kind) -> &'static Kind {
    match kind {
        Kind::List(inner) | Kind::Tuple(inner, _) => innermost(inner),
        other => other,
    }
}
