//! Targets and radars written as `key=value` pairs.

use crate::error::CliError;

/// The values of a target by key; keys not given are absent.
pub struct TargetText<'a> {
    option: &'static str,
    text: &'a str,
    values: Vec<(&'a str, f64)>,
}

impl<'a> TargetText<'a> {
    /// Parses `text`, given for `option`; every key must be one of `keys`, once.
    pub fn parse(option: &'static str, text: &'a str, keys: &[&str]) -> Result<Self, CliError> {
        let mut values: Vec<(&str, f64)> = vec![];
        for pair in text.split(',') {
            let parsed = pair.split_once('=').and_then(|(key, value)| {
                let key = key.trim();
                let fresh = keys.contains(&key) && !values.iter().any(|(known, _)| *known == key);
                Some((key, value.trim().parse().ok()?)).filter(|_| fresh)
            });
            values.push(parsed.ok_or_else(|| CliError::Option {
                option,
                expected: format!(
                    "key=number pairs with commas, keys {}, each once",
                    keys.join(", ")
                ),
                given: format!("{pair:?} in {text:?}"),
            })?);
        }
        Ok(Self { option, text, values })
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<f64> {
        self.values.iter().find(|(known, _)| *known == key).map(|(_, value)| *value)
    }

    /// The value of a key that must be there.
    pub fn need(&self, key: &str) -> Result<f64, CliError> {
        self.get(key).ok_or_else(|| CliError::Option {
            option: self.option,
            expected: format!("{key}=NUMBER among its pairs"),
            given: format!("{:?}", self.text),
        })
    }
}
