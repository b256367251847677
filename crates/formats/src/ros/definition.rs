//! Definitions of messages: `ros2msg` and `ros1msg`, the texts of the types that a message holds behind
//! its own, each after a line of `=` and a line `MSG: package/Type`.

use super::encoding::NumberKind;
use std::collections::BTreeMap;

/// Most types, and fields of all types, that a definition may have.
const MOST: usize = 1 << 16;

/// The type of a message and those it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Definitions {
    types: Vec<Definition>,
}

/// A type.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Definition {
    /// Its name, such as `std_msgs/Header`; that of the message itself is empty.
    pub name: String,
    /// Its fields in order.
    pub fields: Vec<Field>,
}

/// A field.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// How many of these.
    pub many: Many,
}

/// What a field holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number or a truth.
    Number(NumberKind),
    /// Text of one-byte units.
    Text,
    /// Text of two- or four-byte units.
    WideText,
    /// A type, by its place among [`Definitions::get`].
    Struct(usize),
}

/// How many values a field has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Many {
    /// One.
    One,
    /// Always so many.
    Fixed(usize),
    /// As many as the message says.
    Sequence,
}

impl Definitions {
    /// Reads the text of a definition; `None` where a type is missing or a line is none.
    pub fn parse(text: &[u8]) -> Option<Self> {
        let text = String::from_utf8_lossy(text);
        let mut sections = vec![(String::new(), vec![])];
        let mut fields = 0;
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if let Some(name) = line.strip_prefix("MSG:") {
                sections.push((short(name.trim()), vec![]));
            } else if !line.is_empty() && line.bytes().any(|byte| byte != b'=') {
                fields += 1;
                let (_, lines) = sections.last_mut()?;
                lines.push(line.to_owned());
            }
            if fields.max(sections.len()) > MOST {
                return None;
            }
        }
        let mut places = BTreeMap::new();
        for (place, (name, _)) in sections.iter().enumerate() {
            places.entry(name.clone()).or_insert(place);
        }
        // What every message may use without saying what it is.
        let mut types = vec![Definition::default(); sections.len()];
        for (name, parts) in [
            ("builtin_interfaces/Time", [("sec", NumberKind::I32), ("nanosec", NumberKind::U32)]),
            (
                "builtin_interfaces/Duration",
                [("sec", NumberKind::I32), ("nanosec", NumberKind::U32)],
            ),
            ("time", [("sec", NumberKind::U32), ("nanosec", NumberKind::U32)]),
            ("duration", [("sec", NumberKind::I32), ("nanosec", NumberKind::I32)]),
        ] {
            places.entry(name.to_owned()).or_insert(types.len());
            let fields = parts.map(|(name, kind)| Field {
                name: name.into(),
                kind: Kind::Number(kind),
                many: Many::One,
            });
            types.push(Definition { name: name.into(), fields: fields.into() });
        }
        for (place, (name, lines)) in sections.into_iter().enumerate() {
            let package = name.rsplit_once('/').map_or("", |(package, _)| package).to_owned();
            let mut fields = vec![];
            for line in lines {
                fields.extend(field(&line, |kind| find(&places, &package, kind))?);
            }
            *types.get_mut(place)? = Definition { name, fields };
        }
        Some(Self { types })
    }

    /// The type of the message itself.
    pub fn root(&self) -> &Definition {
        self.get(0)
    }

    /// A type by its place.
    pub fn get(&self, place: usize) -> &Definition {
        const NONE: &Definition = &Definition { name: String::new(), fields: vec![] };
        self.types.get(place).unwrap_or(NONE)
    }

    /// The way to a field of fields, such as `header.stamp.sec`, from a type; all but the last have one
    /// value each.
    pub fn path(&self, from: usize, names: &str) -> Option<Vec<usize>> {
        let mut definition = self.get(from);
        let mut path = vec![];
        for name in names.split('.') {
            if let Some(&last) = path.last() {
                match definition.fields.get(last)? {
                    Field { kind: Kind::Struct(place), many: Many::One, .. } => {
                        definition = self.get(*place);
                    }
                    _ => return None,
                }
            }
            path.push(definition.fields.iter().position(|field| field.name == name)?);
        }
        Some(path)
    }
}

/// A name without the `msg` that ROS 2 puts between package and type.
fn short(name: &str) -> String {
    name.replace("/msg/", "/")
}

fn find(places: &BTreeMap<String, usize>, package: &str, kind: &str) -> Option<usize> {
    let kind = short(kind);
    let own = |package: &str| places.get(&format!("{package}/{kind}"));
    let whole = places.get(&kind).filter(|_| !kind.is_empty());
    let found = whole.or_else(|| own(package)).or_else(|| {
        if kind == "Header" {
            return own("std_msgs");
        }
        // Of the message's own package, whose name its definition does not tell.
        let ending = format!("/{kind}");
        places.iter().find(|(name, _)| name.ends_with(&ending)).map(|(_, place)| place)
    });
    found.copied()
}

/// The field a line has; `Some(None)` where it has a constant.
fn field(line: &str, find: impl Fn(&str) -> Option<usize>) -> Option<Option<Field>> {
    let (kind, rest) = line.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let end = rest.find(|c: char| c.is_whitespace() || c == '=').unwrap_or(rest.len());
    let (name, rest) = rest.split_at_checked(end)?;
    if rest.trim_start().starts_with('=') {
        return Some(None);
    }
    let (kind, many) = match kind.split_once('[') {
        None => (kind, Many::One),
        Some((kind, length)) => {
            let length = length.strip_suffix(']')?;
            let is_open = length.is_empty() || length.starts_with("<=");
            (kind, if is_open { Many::Sequence } else { Many::Fixed(length.parse().ok()?) })
        }
    };
    let kind = kind.split("<=").next().unwrap_or(kind);
    let kind = match kind {
        "string" => Kind::Text,
        "wstring" => Kind::WideText,
        _ => match NumberKind::of_name(kind) {
            Some(number) => Kind::Number(number),
            None => Kind::Struct(find(kind)?),
        },
    };
    Some(Some(Field { name: name.into(), kind, many }))
}
