//! The page of all options.

use crate::catalogue::{Entry, shown};
use crate::values;
use boresight_core::describe::{Kind, Record, naming};
use serde_json::Value;

/// A table for each kind of options.
pub fn page(entries: &[Entry]) -> String {
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

fn choices(variants: &[(&str, &str)]) -> String {
    variants.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
