//! JSON Schemas, from which a dashboard can build a form.

use crate::catalogue::{Entry, shown};
use crate::values::{in_user_units, plain};
use boresight_options::{Field, Kind, Record, Special, naming};
use serde_json::{Map, Value, json};

/// One document that defines all options under `$defs`.
pub fn document(entries: &[Entry]) -> Result<String, serde_json::Error> {
    let mut definitions = Map::new();
    for entry in entries {
        definitions.insert(entry.name.into(), record(entry.record, Some(&entry.defaults))?);
    }
    let document = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Options of Boresight",
        "$defs": definitions,
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

/// One document that defines all results under `$defs`, with the records and choices that they hold.
pub fn results_document(results: &[(&str, Vec<Kind>)]) -> Result<String, serde_json::Error> {
    let mut definitions = Map::new();
    for kind in results.iter().flat_map(|(_, kinds)| kinds) {
        result(kind, &mut definitions)?;
    }
    let document = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Results of Boresight",
        "$defs": definitions,
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

/// The schema of a value of a result; records and choices are added to the definitions.
fn result(kind: &Kind, definitions: &mut Map<String, Value>) -> Result<Value, serde_json::Error> {
    let of_number = |name: &str| json!({ "type": name });
    Ok(match kind {
        Kind::Number => of_number("number"),
        Kind::Whole | Kind::Seed => of_number("integer"),
        Kind::Truth => of_number("boolean"),
        Kind::Text => of_number("string"),
        Kind::Numbers(_) => json!({ "type": "array", "items": { "type": "number" } }),
        Kind::Choice(choice) => {
            let variants = choice.variants.iter();
            let all: Vec<Value> =
                variants.map(|(name, doc)| json!({ "const": name, "description": doc })).collect();
            definitions
                .insert(choice.name.into(), json!({ "description": choice.doc, "oneOf": all }));
            reference(choice.name)
        }
        Kind::Record(record) => {
            if !definitions.contains_key(record.name) {
                // Before its fields, which may refer to it.
                definitions.insert(record.name.into(), Value::Null);
                let schema = result_record(record, definitions)?;
                definitions.insert(record.name.into(), schema);
            }
            reference(record.name)
        }
        Kind::Optional(inner) => {
            json!({ "anyOf": [result(inner, definitions)?, { "type": "null" }] })
        }
        Kind::List(inner) => json!({ "type": "array", "items": result(inner, definitions)? }),
        Kind::Tuple(inner, length) => json!({
            "type": "array",
            "items": result(inner, definitions)?,
            "minItems": length,
            "maxItems": length,
        }),
        Kind::Special(Special { schema: "{}", typescript, .. }) => {
            json!({ "x-typescript": typescript })
        }
        Kind::Special(special) => serde_json::from_str(special.schema)?,
    })
}

fn result_record(
    record: &'static Record,
    definitions: &mut Map<String, Value>,
) -> Result<Value, serde_json::Error> {
    let (mut properties, mut required) = (Map::new(), vec![]);
    for one in shown(record, None) {
        let name = naming::javascript(one.field.name);
        // A value that may be absent is not null.
        let kind = match one.field.kind {
            Kind::Optional(inner) if one.field.may_be_absent => *inner,
            kind => kind,
        };
        let mut schema = result(&kind, definitions)?;
        if let Value::Object(schema) = &mut schema {
            schema.insert("description".into(), one.field.doc.into());
            let unit = naming::unit(one.field.name);
            if !unit.is_empty() {
                schema.insert("x-unit".into(), unit.into());
            }
        }
        if !one.field.may_be_absent {
            required.push(Value::from(name.clone()));
        }
        properties.insert(name, schema);
    }
    Ok(json!({
        "type": "object",
        "description": record.doc,
        "properties": properties,
        "required": required,
    }))
}

fn reference(name: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{name}") })
}

fn record(record: &'static Record, defaults: Option<&Value>) -> Result<Value, serde_json::Error> {
    let mut properties = Map::new();
    let mut required = vec![];
    for one in shown(record, defaults) {
        let name = naming::javascript(one.field.name);
        if one.field.required {
            required.push(Value::from(name.clone()));
        }
        properties.insert(name, property(one.field, one.default)?);
    }
    let mut schema = Map::new();
    schema.insert("type".into(), "object".into());
    schema.insert("description".into(), record.doc.into());
    schema.insert("properties".into(), properties.into());
    if !required.is_empty() {
        schema.insert("required".into(), required.into());
    }
    schema.insert("additionalProperties".into(), false.into());
    Ok(schema.into())
}

fn property(field: &'static Field, default: Option<&Value>) -> Result<Value, serde_json::Error> {
    let mut schema = kind(field, &field.kind, default)?;
    if let Value::Object(schema) = &mut schema {
        schema.insert("description".into(), field.doc.into());
        let unit = naming::unit(field.name);
        if !unit.is_empty() {
            schema.insert("x-unit".into(), unit.into());
        }
        // On the command line; within a record after that of the record and a dash.
        schema.insert("x-flag".into(), naming::flag(field.name).into());
        if let Some(value) = default.and_then(|value| in_user_units(field, value)) {
            schema.insert("default".into(), value);
        }
    }
    Ok(schema)
}

fn kind(
    field: &'static Field,
    of: &Kind,
    default: Option<&Value>,
) -> Result<Value, serde_json::Error> {
    Ok(match of {
        Kind::Number => limited(field, "number"),
        Kind::Whole | Kind::Seed => limited(field, "integer"),
        Kind::Truth => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Choice(choice) => {
            let variants = choice.variants.iter();
            json!({ "title": choice.name, "oneOf": variants
                .map(|(name, doc)| json!({ "const": name, "description": doc }))
                .collect::<Vec<_>>() })
        }
        Kind::Record(inner) => record(inner, default)?,
        Kind::Optional(inner) => kind(field, inner, default)?,
        Kind::Numbers(_) => json!({ "type": "array", "items": { "type": "number" } }),
        Kind::List(inner) => json!({ "type": "array", "items": kind(field, inner, None)? }),
        Kind::Tuple(inner, length) => json!({
            "type": "array",
            "items": kind(field, inner, None)?,
            "minItems": length,
            "maxItems": length,
        }),
        Kind::Special(special) => serde_json::from_str(special.schema)?,
    })
}

fn limited(field: &Field, name: &str) -> Value {
    let mut schema = Map::new();
    schema.insert("type".into(), name.into());
    match field.range {
        Some(range) => {
            let least = if range.above_low { "exclusiveMinimum" } else { "minimum" };
            schema.insert(least.into(), plain(range.low));
            if range.high.is_finite() {
                schema.insert("maximum".into(), plain(range.high));
            }
        }
        None if name == "integer" => {
            schema.insert("minimum".into(), 0.into());
        }
        None => {}
    }
    schema.into()
}
