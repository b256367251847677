//! Options that describe themselves as flags: `iaa.threshold_db` is `--iaa-threshold DB`.

use boresight_options::{At, Choice, Described, Field, Kind, Naming, Record, naming};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};

/// Options that stand on the command line.
pub trait OnCommandLine: Described + Default + Serialize + DeserializeOwned + Clone {
    /// Where they stand in the help.
    const HEADING: &'static str;
    /// What the names of their flags begin with; empty for nothing.
    const PREFIX: &'static str = "";
    /// Fields that have to be given, by their name in Rust.
    const REQUIRED: &'static [&'static str] = &[];
    /// Fields that a command fills by other means, by their name in Rust.
    const ELSEWHERE: &'static [&'static str] = &[];
}

/// Options read from flags, those not given at their defaults.
#[derive(Debug, Clone, Default)]
pub struct Flags<T> {
    /// The options.
    pub options: T,
    given: Vec<&'static str>,
}

impl<T> Flags<T> {
    /// Options that come from elsewhere, none of them by a flag.
    pub fn of(options: T) -> Self {
        Self { options, given: vec![] }
    }

    /// Whether a field that stands directly in the options was given, by its name in Rust.
    pub fn given(&self, field: &str) -> bool {
        self.given.contains(&field)
    }

    /// Names in Rust of the fields that stand directly in the options and were given.
    pub fn all_given(&self) -> &[&'static str] {
        &self.given
    }

    /// Whether any field that stands directly in the options was given.
    pub fn is_given(&self) -> bool {
        !self.given.is_empty()
    }
}

/// One flag and the field it sets.
pub struct Flag<'a> {
    prefix: &'static str,
    /// Path of fields; the last is the field itself.
    path: Vec<&'static Field>,
    /// The field.
    pub field: &'static Field,
    default: Option<&'a Value>,
}

impl Flag<'_> {
    /// Its name without the dashes, and whether giving it says no to what is true by default.
    pub fn name(&self) -> (String, bool) {
        let own = self.named().map(naming::flag);
        let prefix = (!self.prefix.is_empty()).then(|| self.prefix.to_owned());
        let name = prefix.into_iter().chain(own).collect::<Vec<_>>().join("-");
        let says_no = self.default == Some(&Value::Bool(true));
        (if says_no { format!("no-{name}") } else { name }, says_no)
    }

    /// Returns the names in Rust of the fields in the path that are not flat.
    fn named(&self) -> impl Iterator<Item = &'static str> {
        self.path.iter().filter(|field| !field.flat).map(|field| field.name)
    }

    /// Whether it stands directly in the options, under one of these names.
    fn is_one_of(&self, names: &[&str]) -> bool {
        let mut own = self.named();
        own.next().is_some_and(|name| names.contains(&name)) && own.next().is_none()
    }

    fn arg(&self, heading: &'static str) -> Arg {
        let (name, _) = self.name();
        let arg = Arg::new(name.clone()).long(name).help_heading(heading);
        let help = self.help();
        match self.kind() {
            Kind::Truth => arg.action(ArgAction::SetTrue).help(help),
            Kind::Choice(choice) => {
                arg.value_parser(names_of(choice)).hide_possible_values(false).help(help)
            }
            kind => arg.value_name(self.value_name(&kind)).allow_hyphen_values(true).help(help),
        }
    }

    fn kind(&self) -> Kind {
        match self.field.kind {
            Kind::Optional(kind) => *kind,
            kind => kind,
        }
    }

    fn value_name(&self, kind: &Kind) -> String {
        let unit = naming::unit(self.field.name).to_uppercase();
        let one = match kind {
            Kind::Special(special) => special.flag,
            _ if !unit.is_empty() => &unit,
            Kind::Whole | Kind::Tuple(Kind::Whole, _) => "N",
            Kind::Seed => "SEED",
            Kind::Text => "NAME",
            _ => "X",
        };
        match kind {
            Kind::Tuple(_, length) => vec![one; *length].join(","),
            Kind::List(_) => "NAME,...".into(),
            _ => one.into(),
        }
    }

    fn help(&self) -> String {
        let doc = self.field.doc.trim_end_matches('.');
        let default = self.default.and_then(|value| text(self.field, value));
        match default {
            Some(default) if self.kind() != Kind::Truth => format!("{doc} [default: {default}]"),
            _ => doc.into(),
        }
    }

    /// What was given for it, in the units of Rust.
    fn value(&self, matches: &ArgMatches) -> Result<Option<Value>, clap::Error> {
        let (name, says_no) = self.name();
        let kind = self.kind();
        if kind == Kind::Truth {
            return Ok(matches.get_flag(&name).then_some(Value::Bool(!says_no)));
        }
        let Some(given) = matches.get_one::<String>(&name) else { return Ok(None) };
        let wrong = |expected: &str| {
            let what = format!("--{name} is {given:?}; expected {expected}\n");
            clap::Error::raw(ErrorKind::ValueValidation, what)
        };
        let one =
            |text: &str, kind: &Kind| self.read(text, kind).ok_or_else(|| wrong(&kind.expected()));
        if let Kind::List(_) = kind {
            let names = given.split(',').map(str::trim).filter(|name| !name.is_empty());
            return Ok(Some(names.collect()));
        }
        if let Kind::Tuple(of, length) = kind {
            let parts: Vec<&str> = given.split(',').collect();
            if parts.len() != length {
                return Err(wrong(&format!("{length} numbers with a comma between")));
            }
            return parts
                .into_iter()
                .map(|part| one(part, of))
                .collect::<Result<_, _>>()
                .map(|list| Some(Value::Array(list)));
        }
        one(given, &kind).map(Some)
    }

    /// A value in the units of Rust.
    fn read(&self, text: &str, kind: &Kind) -> Option<Value> {
        Some(match kind {
            Kind::Number => {
                let number: f64 = text.trim().parse().ok()?;
                let is_angle = naming::is_angle(self.field.name);
                Value::Number(Number::from_f64(if is_angle {
                    number.to_radians()
                } else {
                    number
                })?)
            }
            Kind::Whole | Kind::Seed => text.trim().parse::<u64>().ok()?.into(),
            Kind::Special(_) => text.parse::<u64>().map_or_else(|_| text.into(), Value::from),
            _ => text.into(),
        })
    }

    /// Puts a value, given as text, where it belongs; nothing if it cannot be read.
    pub fn put(&self, values: &mut Value, text: &str) -> Option<()> {
        set(values, &self.path, self.read(text, &self.kind())?);
        Some(())
    }
}

/// The names of a choice, with their meaning.
pub fn names<T: Described>() -> PossibleValuesParser {
    match T::KIND {
        Kind::Choice(choice) => names_of(choice),
        _ => PossibleValuesParser::new(Vec::<PossibleValue>::new()),
    }
}

fn names_of(choice: &Choice) -> PossibleValuesParser {
    let variants = choice.variants.iter();
    PossibleValuesParser::new(variants.map(|(name, doc)| PossibleValue::new(*name).help(*doc)))
}

/// What stands on the command line for each field of a record, without defaults.
pub fn fields_of<T: Described>() -> Vec<Flag<'static>> {
    flags(record::<T>(), None, &Place::default())
}

/// A default as one would give it; nothing where there is none.
fn text(field: &Field, value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => {
            let number = number.as_f64()?;
            let is_angle = naming::is_angle(field.name);
            Some(if is_angle { naming::in_degrees(number) } else { number }.to_string())
        }
        Value::String(text) => Some(text.clone()),
        Value::Array(items) => items
            .iter()
            .map(|item| text(field, item))
            .collect::<Option<Vec<_>>>()
            .filter(|all| !all.is_empty())
            .map(|all| all.join(",")),
        _ => None,
    }
}

/// Where a record stands among the flags.
#[derive(Clone, Default)]
struct Place {
    prefix: &'static str,
    /// Path of fields to the record.
    above: Vec<&'static Field>,
    elsewhere: &'static [&'static str],
}

/// The flags of a record.
fn flags<'a>(record: &'static Record, defaults: Option<&'a Value>, place: &Place) -> Vec<Flag<'a>> {
    let mut all = vec![];
    for field in record.fields.iter().filter(|field| !place.elsewhere.contains(&field.name)) {
        let path = [&place.above[..], &[field]].concat();
        let default = defaults.and_then(|defaults| defaults.get(field.name));
        let kind = match field.kind {
            // Any of an optional record's flags gives it, with the others at their defaults.
            Kind::Optional(record @ Kind::Record(_)) => *record,
            kind => kind,
        };
        match kind {
            Kind::Record(inner) => {
                all.extend(flags(inner, default, &Place { above: path, ..place.clone() }));
            }
            Kind::List(kind) if *kind != Kind::Text => {}
            Kind::Numbers(_) => {}
            _ => all.push(Flag { prefix: place.prefix, path, field, default }),
        }
    }
    all
}

/// All flags of options.
fn flags_of<T: OnCommandLine>(defaults: Option<&Value>) -> Vec<Flag<'_>> {
    let place = Place { prefix: T::PREFIX, above: vec![], elsewhere: T::ELSEWHERE };
    flags(record::<T>(), defaults, &place)
}

fn record<T: Described>() -> &'static Record {
    match T::KIND {
        Kind::Record(record) => record,
        _ => &Record { name: "", doc: "", fields: &[] },
    }
}

impl<T: OnCommandLine> Args for Flags<T> {
    fn augment_args(command: Command) -> Command {
        let defaults = serde_json::to_value(T::default()).ok();
        command.args(
            flags_of::<T>(defaults.as_ref())
                .iter()
                .map(|flag| flag.arg(T::HEADING).required(flag.is_one_of(T::REQUIRED))),
        )
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<T: OnCommandLine> FromArgMatches for Flags<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let raw = |error: &dyn std::fmt::Display| {
            clap::Error::raw(ErrorKind::ValueValidation, format!("{error}\n"))
        };
        let defaults = serde_json::to_value(T::default()).map_err(|error| raw(&error))?;
        let mut values = defaults.clone();
        let mut given = vec![];
        for flag in flags_of::<T>(Some(&defaults)) {
            if let Some(value) = flag.value(matches)? {
                set(&mut values, &flag.path, value);
                if let [own] = flag.path[..] {
                    given.push(own.name);
                }
            }
        }
        let options: T = serde_json::from_value(values).map_err(|error| raw(&error))?;
        let above = if T::PREFIX.is_empty() { String::new() } else { format!("--{}", T::PREFIX) };
        let at = At::named(Naming::CommandLine, &above);
        options.check(None, &at).map_err(|error| raw(&error))?;
        Ok(Self { options, given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn set(values: &mut Value, path: &[&Field], value: Value) {
    match path {
        [] => *values = value,
        [field, rest @ ..] => {
            if !values.is_object() {
                *values = Value::Object(Map::new());
            }
            if let Value::Object(fields) = values {
                set(fields.entry(field.name).or_insert(Value::Null), rest, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_options::{differing_fields, lies_in};
    use clap::Parser;
    use std::fmt::Debug;

    #[derive(Debug, Parser)]
    struct Line<T: OnCommandLine + Debug + Send + Sync + 'static> {
        #[command(flatten)]
        flags: Flags<T>,
    }

    fn parse<T: OnCommandLine + Debug + Send + Sync + 'static>(
        arguments: &[&str],
    ) -> Result<T, clap::Error> {
        let line = [&["boresight"], arguments].concat();
        Line::<T>::try_parse_from(line).map(|line| line.flags.options)
    }

    /// Every flag in turn: a legal value that is not the default changes its field, and no other.
    fn every_flag<T: OnCommandLine + Debug + Send + Sync + 'static>(fewest: usize) {
        let defaults = serde_json::to_value(T::default()).unwrap();
        let all = flags_of::<T>(Some(&defaults));
        assert!(all.len() >= fewest, "{}", all.len());
        let required: Vec<String> =
            all.iter().filter(|flag| flag.is_one_of(T::REQUIRED)).map(dashed).collect();
        for flag in &all {
            let name = dashed(flag);
            let others = required.iter().filter(|other| **other != name);
            let others: Vec<&str> = others.flat_map(|other| [&**other, "0"]).collect();
            let mut has_changed = false;
            for value in values(flag) {
                let given = if value.is_empty() { vec![&*name] } else { vec![&*name, &*value] };
                let line = [&others[..], &given].concat();
                let changed: T = parse(&line).unwrap_or_else(|error| panic!("{line:?}: {error}"));
                let differing = differing_fields(&T::default(), &changed);
                // One of the names of a choice is the default.
                if !differing.is_empty() {
                    let path: Vec<&str> = flag.path.iter().map(|field| field.name).collect();
                    let own = path.join(".");
                    // A flag of a record that is absent by default adds the record.
                    let above = &path[..path.len() - 1];
                    let added = above.iter().try_fold(&defaults, |value, name| value.get(*name));
                    let is_added = !above.is_empty() && added.is_none_or(Value::is_null);
                    let record = above.join(".");
                    let is_its_own =
                        |field: &String| lies_in(field, &own) || (is_added && *field == record);
                    assert!(differing.iter().all(is_its_own), "{line:?}: {differing:?}");
                    has_changed = true;
                }
            }
            assert!(has_changed, "{name} changes nothing");
        }
    }

    fn dashed(flag: &Flag<'_>) -> String {
        format!("--{}", flag.name().0)
    }

    fn values(flag: &Flag<'_>) -> Vec<String> {
        let (low, high) = flag.field.range.map_or((0.0, 10.0), |range| (range.low, range.high));
        let high = if high.is_finite() { high } else { low + 10.0 };
        let number = low + 0.37 * (high - low);
        let whole = number.max(low + 1.0).floor();
        match flag.kind() {
            Kind::Truth => vec![String::new()],
            Kind::Number => vec![number.to_string()],
            // One of the two is not the default.
            Kind::Whole | Kind::Seed => vec![whole.to_string(), (whole + 1.0).to_string()],
            Kind::Choice(choice) => {
                choice.variants.iter().map(|(name, _)| (*name).into()).collect()
            }
            Kind::Tuple(Kind::Number, length) => vec![vec![number.to_string(); length].join(",")],
            Kind::Tuple(_, length) => vec![vec![whole.to_string(); length].join(",")],
            _ => vec!["3".into(), "aic".into()],
        }
    }

    #[test]
    fn every_flag_sets_its_own_field() {
        every_flag::<boresight_pipeline::AngleOptions>(28);
        every_flag::<boresight_pipeline::ChainOptions>(16);
        every_flag::<boresight_array_calibration::CalibrationOptions>(5);
        every_flag::<boresight_pipeline::regions::RegionChainOptions>(19);
        every_flag::<boresight_mounting::CalibrationOptions>(19);
        every_flag::<boresight_mounting::SignOptions>(2);
        every_flag::<boresight_simulate::DriveOptions>(19);
        every_flag::<boresight_simulate::SnapshotRequest>(10);
        every_flag::<boresight_simulate::SceneSampling>(4);
        every_flag::<boresight_simulate::CubeRequest>(8);
        every_flag::<boresight_image::ViewGridOptions>(3);
        every_flag::<boresight_formats::TopicOptions>(3);
    }

    #[test]
    fn errors_name_the_flag_in_its_unit() {
        type Angle = boresight_pipeline::AngleOptions;
        for (given, expected) in [
            (
                ["--field-of-view", "120"],
                "--field-of-view is 120; expected a number from 0.1 to 90",
            ),
            (["--iaa-threshold", "-1"], "--iaa-threshold is -1; expected a number from 0 to 300"),
            (["--iaa-iterations", "1.5"], "--iaa-iterations is \"1.5\"; expected a whole number"),
            (["--sources", "many"], "unknown variant `many`"),
        ] {
            let error = parse::<Angle>(&given).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        type Chain = boresight_pipeline::ChainOptions;
        let error = parse::<Chain>(&["--cfar-guard-cells", "4"]).unwrap_err().to_string();
        assert!(error.contains("expected 2 numbers with a comma between"), "{error}");
    }
}
