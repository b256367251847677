//! Fields of a JSON file, with their paths for error messages.

use crate::error::FormatError;
use serde_json::Value;

/// Parses a JSON file; a byte order mark is allowed.
pub fn parse(text: &[u8], file: &'static str) -> Result<Value, FormatError> {
    let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
    serde_json::from_slice(text).map_err(|error| FormatError::Json {
        file,
        expected: "the JSON that mmWave Studio writes",
        given: error.to_string(),
    })
}

/// A field, which may be missing.
#[derive(Clone)]
pub struct Field<'a> {
    /// Names from the root, such as `mmWaveDevices[0].rfConfig`.
    pub path: String,
    /// Its value; `None` where it is missing or null.
    pub value: Option<&'a Value>,
}

impl<'a> Field<'a> {
    /// The whole file.
    pub fn root(value: &'a Value) -> Self {
        Self { path: String::new(), value: Some(value) }
    }

    /// The field at a path of names separated by dots.
    pub fn at(&self, names: &str) -> Self {
        let separator = if self.path.is_empty() { "" } else { "." };
        let value = self
            .value
            .and_then(|value| names.split('.').try_fold(value, |value, name| value.get(name)))
            .filter(|value| !value.is_null());
        Self { path: format!("{}{separator}{names}", self.path), value }
    }

    /// An error about the value.
    pub fn error(&self, expected: impl Into<String>) -> FormatError {
        let given = self.value.map_or("missing".into(), |value| {
            let text = value.to_string();
            let start: String = text.chars().take(40).collect();
            if start.len() < text.len() { start + "..." } else { start }
        });
        FormatError::ConfigField { field: self.path.clone(), expected: expected.into(), given }
    }

    /// The items of a list that must not be empty.
    pub fn items(&self, expected: &str) -> Result<Vec<Self>, FormatError> {
        let items = self.optional_items();
        if items.is_empty() { Err(self.error(expected)) } else { Ok(items) }
    }

    /// The items of a list; none where the field is missing or not a list.
    pub fn optional_items(&self) -> Vec<Self> {
        let items = self.value.and_then(Value::as_array);
        let items = items.into_iter().flatten().enumerate();
        items
            .map(|(k, item)| Self { path: format!("{}[{k}]", self.path), value: Some(item) })
            .collect()
    }

    /// The text of a string.
    pub fn text(&self) -> Option<&'a str> {
        self.value.and_then(Value::as_str)
    }

    /// A number, or a string of one: mmWave Studio writes bit masks as hexadecimal strings.
    pub fn number(&self) -> Result<f64, FormatError> {
        let of_text = |text: &str| match text.trim().strip_prefix("0x") {
            Some(digits) => u32::from_str_radix(digits, 16).ok().map(f64::from),
            None => text.trim().parse().ok().filter(|number: &f64| number.is_finite()),
        };
        let number = match self.value {
            Some(Value::String(text)) => of_text(text),
            value => value.and_then(Value::as_f64),
        };
        number.ok_or_else(|| self.error("a number"))
    }

    /// The numbers of several fields.
    pub fn numbers<const N: usize>(&self, names: [&str; N]) -> Result<[f64; N], FormatError> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = self.at(name).number()?;
        }
        Ok(numbers)
    }

    /// Refuses a value that is not among those allowed; a missing field is allowed.
    pub fn allow(&self, allowed: &[f64], expected: &str) -> Result<(), FormatError> {
        if self.value.is_none() || allowed.contains(&self.number()?) {
            return Ok(());
        }
        Err(self.error(expected))
    }

    /// The same for a string.
    pub fn allow_text(&self, allowed: &str, meaning: &str) -> Result<(), FormatError> {
        if self.value.is_none() || self.text() == Some(allowed) {
            return Ok(());
        }
        Err(self.error(format!("{allowed:?}: {meaning}")))
    }
}
