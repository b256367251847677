//! TypeScript types with their documentation.

use crate::catalogue::{Entry, Shown, shown};
use crate::values;
use boresight_options::{Choice, Kind, NumberType, Record, naming};
use serde_json::Value;
use std::collections::BTreeSet;

const WIDTH: usize = 116;

const HEAD: &str =
    "// Written by `npm run generate` from the descriptions in Rust; not edited by hand.\n";

/// The module of all options, and that of all results.
pub fn modules(entries: &[Entry], results: &[(&str, Vec<Kind>)]) -> [String; 2] {
    let mut options = Types::default();
    for entry in entries {
        options.record(entry.name, entry.record, Some(&entry.defaults));
    }
    let known: Vec<&str> = options.known.iter().copied().collect();
    let mut types = Types { known: options.known, is_result: true, ..Types::default() };
    for kind in results.iter().flat_map(|(_, kinds)| kinds) {
        types.kind(kind, None);
    }
    let names = |text: &str, name: &str| {
        text.split(|c: char| !c.is_alphanumeric()).any(|word| word == name)
    };
    let imported: Vec<&str> = known.into_iter().filter(|name| names(&types.text, name)).collect();
    let import = format!("import type {{ {} }} from './options.js';\n", imported.join(", "));
    [HEAD.to_owned() + &options.text, format!("{HEAD}{import}{}", types.text)]
}

#[derive(Default)]
struct Types {
    text: String,
    known: BTreeSet<&'static str>,
    /// Whether fields are there unless they may be absent, and may be changed by who was given them.
    is_result: bool,
}

impl Types {
    fn record(&mut self, name: &'static str, record: &'static Record, defaults: Option<&Value>) {
        if !self.known.insert(name) {
            return;
        }
        let mut lines = String::new();
        for field in shown(record, defaults) {
            lines += &self.field(&field);
        }
        self.text +=
            &format!("\n{}export interface {name} {{\n{lines}}}\n", comment(record.doc, 0));
    }

    fn field(&mut self, Shown { field, default }: &Shown<'_>) -> String {
        let mut doc = field.doc.to_owned();
        let unit = naming::unit(field.name);
        let range = field.range.map(values::range);
        let default_value = default
            .filter(|_| !field.required)
            .and_then(|value| values::in_user_units(field, value));
        let told: Vec<String> = [
            range.map(|range| format!("{range}{}{unit}", if unit.is_empty() { "" } else { " " })),
            default_value.map(|value| format!("default {}", literal(&value))),
        ]
        .into_iter()
        .flatten()
        .collect();
        if !told.is_empty() {
            doc = format!("{} ({}).", doc.trim_end_matches('.'), told.join("; "));
        }
        let may_be_absent = if self.is_result { field.may_be_absent } else { !field.required };
        let mark = if may_be_absent { "?" } else { "" };
        let mut of = self.kind(&field.kind, *default);
        if self.is_result && !may_be_absent && matches!(field.kind, Kind::Optional(_)) {
            of += " | null";
        }
        format!("{}  {}{mark}: {of};\n", comment(&doc, 2), naming::javascript(field.name))
    }

    fn kind(&mut self, kind: &Kind, default: Option<&Value>) -> String {
        match kind {
            Kind::Number | Kind::Whole => "number".into(),
            Kind::Seed if self.is_result => "number".into(),
            Kind::Seed => "number | bigint".into(),
            Kind::Truth => "boolean".into(),
            Kind::Text => "string".into(),
            Kind::Numbers(of) => match of {
                NumberType::F64 => "Float64Array",
                NumberType::F32 => "Float32Array",
                NumberType::U32 => "Uint32Array",
                NumberType::U8 => "Uint8Array",
                NumberType::I8 => "Int8Array",
            }
            .into(),
            Kind::Choice(choice) => {
                self.choice(choice);
                choice.name.into()
            }
            Kind::Record(record) => {
                let mut inner = Self {
                    text: String::new(),
                    known: std::mem::take(&mut self.known),
                    is_result: self.is_result,
                };
                inner.record(record.name, record, default);
                self.text += &inner.text;
                self.known = inner.known;
                record.name.into()
            }
            Kind::Optional(of) => self.kind(of, default),
            Kind::List(of) => format!("{}{}[]", self.read_only(), self.item(of)),
            Kind::Tuple(of, length) => {
                let all = vec![self.kind(of, None); *length].join(", ");
                format!("{}[{all}]", self.read_only())
            }
            Kind::Special(special) => special.typescript.into(),
        }
    }

    fn read_only(&self) -> &'static str {
        if self.is_result { "" } else { "readonly " }
    }

    fn item(&mut self, kind: &Kind) -> String {
        let of = self.kind(kind, None);
        if of.contains(' ') && !of.starts_with('[') { format!("({of})") } else { of }
    }

    fn choice(&mut self, choice: &'static Choice) {
        if !self.known.insert(choice.name) {
            return;
        }

        let names: Vec<String> =
            choice.variants.iter().map(|(name, _)| format!("'{name}'")).collect();
        let list: String =
            choice.variants.iter().map(|(name, doc)| format!("\n- `{name}`: {doc}")).collect();
        let doc = comment(&format!("{}\n{list}", choice.doc), 0);
        let line = format!("export type {} = {};", choice.name, names.join(" | "));
        let text = if line.len() <= 120 {
            line
        } else {
            format!("export type {} =\n  | {};", choice.name, names.join("\n  | "))
        };
        self.text += &format!("\n{doc}{text}\n");
    }
}

/// A value as TypeScript writes it.
fn literal(value: &Value) -> String {
    match value {
        Value::String(text) => format!("'{text}'"),
        other => other.to_string().replace(',', ", "),
    }
}

/// A documentation comment, wrapped.
fn comment(doc: &str, indent: usize) -> String {
    let pad = " ".repeat(indent);
    let lines: Vec<String> = doc.lines().flat_map(|line| wrapped(line, WIDTH - indent)).collect();
    match &lines[..] {
        [] => String::new(),
        [line] => format!("{pad}/** {line} */\n"),
        lines => {
            let body: String = lines
                .iter()
                .map(|line| format!("{pad} * {line}").trim_end().to_owned() + "\n")
                .collect();
            format!("{pad}/**\n{body}{pad} */\n")
        }
    }
}

fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.len() - 1;
        if !lines[line].is_empty() && lines[line].len() + 1 + word.len() > width {
            lines.push(word.into());
        } else {
            let gap = if lines[line].is_empty() { "" } else { " " };
            lines[line] += &format!("{gap}{word}");
        }
    }
    lines
}
