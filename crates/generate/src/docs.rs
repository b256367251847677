//! The page of all options.

use crate::catalogue::{Entry, shown};
use crate::values;
use boresight_options::{Kind, Record, naming};
use serde_json::Value;
use std::collections::BTreeSet;

/// A table for each kind of options.
pub fn options(entries: &[Entry]) -> String {
    let mut text = String::from(
        "<!-- Written by `npm run generate` from the descriptions in Rust; not edited by hand. -->\n\n\
         # Options\n\n\
         Names are those of JavaScript. On the command line `fieldOfViewDeg` is `--field-of-view DEG`, and\n\
         `iaa.thresholdDb` is `--iaa-threshold DB`; what is true by default has a flag that begins with `--no-`.\n\
         Angles are in degrees, everything else in SI units. The same descriptions are a JSON Schema,\n\
         `boresight/schema.json`, from which a dashboard can build a form.\n",
    );
    for entry in entries {
        text += &format!("\n## {}\n\n{}\n\n", entry.title, entry.record.doc);
        text += "| option | what it is | allowed | default |\n| --- | --- | --- | --- |\n";
        text += &rows("", entry.record, Some(&entry.defaults));
    }
    text
}

fn rows(prefix: &str, record: &'static Record, defaults: Option<&Value>) -> String {
    let mut text = String::new();
    for one in shown(record, defaults) {
        let name = format!("{prefix}{}", naming::javascript(one.field.name));
        if let Kind::Record(inner) = one.field.kind {
            text += &rows(&format!("{name}."), inner, one.default);
            continue;
        }
        let unit = naming::unit(one.field.name);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let allowed = match (one.field.range, one.field.kind) {
            (Some(range), _) => format!("{}{unit}", values::range(range)),
            (None, Kind::Choice(choice)) => choices(choice.variants),
            (None, Kind::Optional(Kind::Choice(choice))) => choices(choice.variants),
            (None, kind) => kind.expected(),
        };
        let default = one.default.and_then(|value| values::in_user_units(one.field, value));
        let default = match default {
            Some(Value::String(text)) => format!("`{text}`"),
            Some(value) => value.to_string().replace(',', ", "),
            None if one.field.required => "required".into(),
            None => String::new(),
        };
        let default = if one.field.required { "required".into() } else { default };
        text += &format!(
            "| `{name}` | {} | {allowed} | {default} |\n",
            one.field.doc.replace('|', "\\|")
        );
    }
    text
}

/// A table for each record that functions return, those within records after them.
pub fn results(results: &[(&str, Vec<Kind>)]) -> String {
    let mut text = String::from(
        "<!-- Written by `npm run generate` from the descriptions in Rust; not edited by hand. -->\n\n\
         # Results\n\n\
         What functions return, in the names of JavaScript; the command line's `--json` has the same. Angles\n\
         are in degrees, everything else in SI units: the unit is in the name.\n",
    );
    let mut known = BTreeSet::new();
    for (title, kinds) in results {
        text += &format!("\n## {title}\n");
        for kind in kinds {
            tables(kind, &mut known, &mut text);
        }
    }
    text
}

fn tables(kind: &Kind, known: &mut BTreeSet<&'static str>, text: &mut String) {
    match kind {
        Kind::Optional(inner) | Kind::List(inner) | Kind::Tuple(inner, _) => {
            tables(inner, known, text);
        }
        Kind::Choice(choice) if known.insert(choice.name) => {
            *text += &format!("\n### {}\n\n{}\n\n", choice.name, choice.doc);
            *text += "| name | meaning |\n| --- | --- |\n";
            for (name, doc) in choice.variants {
                *text += &format!("| `{name}` | {doc} |\n");
            }
        }
        Kind::Record(record) if known.insert(record.name) => {
            *text += &format!("\n### {}\n\n{}\n\n", record.name, record.doc);
            *text += "| field | what it is | type |\n| --- | --- | --- |\n";
            let fields = shown(record, None);
            for one in &fields {
                let name = naming::javascript(one.field.name);
                let absent = if one.field.may_be_absent { ", may be absent" } else { "" };
                let of = type_of(&one.field.kind);
                *text += &format!("| `{name}` | {} | {of}{absent} |\n", one.field.doc);
            }
            for one in fields {
                tables(&one.field.kind, known, text);
            }
        }
        _ => {}
    }
}

fn type_of(kind: &Kind) -> String {
    match kind {
        Kind::Number => "number".into(),
        Kind::Whole | Kind::Seed => "whole number".into(),
        Kind::Truth => "true or false".into(),
        Kind::Text => "text".into(),
        Kind::Numbers(_) => "numbers".into(),
        Kind::Choice(choice) => choice.name.into(),
        Kind::Record(record) => record.name.into(),
        Kind::Optional(inner) => format!("{} or null", type_of(inner)),
        Kind::List(inner) => format!("list of {}", type_of(inner)),
        Kind::Tuple(inner, length) => format!("{length} of {}", type_of(inner)),
        Kind::Special(special) => format!("`{}`", special.typescript.replace('|', "\\|")),
    }
}

fn choices(variants: &[(&str, &str)]) -> String {
    variants.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
