//! One command line and its numeric arguments.

use crate::error::FormatError;

/// A command with its arguments.
pub(super) struct Line<'a> {
    /// Line number, counted from 1.
    pub number: usize,
    /// The command.
    pub command: &'a str,
    /// Its arguments.
    pub arguments: Vec<&'a str>,
}

impl<'a> Line<'a> {
    /// Splits a line; `None` if it is blank.
    pub fn of(number: usize, content: &'a str) -> Option<Self> {
        let mut words = content.split_whitespace();
        let command = words.next()?;
        Some(Self { number, command, arguments: words.collect() })
    }

    /// An error about this line.
    pub fn error(
        &self,
        what: impl Into<String>,
        expected: impl Into<String>,
        given: impl Into<String>,
    ) -> FormatError {
        FormatError::Config {
            line: self.number,
            command: clipped(self.command),
            what: what.into(),
            expected: expected.into(),
            given: given.into(),
        }
    }

    /// Checks the number of arguments.
    pub fn count(&self, fewest: usize, most: usize) -> Result<(), FormatError> {
        let given = self.arguments.len();
        if (fewest..=most).contains(&given) {
            return Ok(());
        }
        let expected =
            if fewest == most { fewest.to_string() } else { format!("{fewest} to {most}") };
        Err(self.error("the number of arguments", expected, given.to_string()))
    }

    /// Argument `index` as a number in `low..=high`.
    pub fn number(
        &self,
        index: usize,
        what: &str,
        low: f64,
        high: f64,
    ) -> Result<f64, FormatError> {
        let word = self.word(index, what)?;
        match word.parse::<f64>() {
            Ok(value) if value >= low && value <= high => Ok(value),
            _ => Err(self.error(what, format!("a number from {low} to {high}"), clipped(word))),
        }
    }

    /// Argument `index` as an integer in `low..=high`.
    pub fn integer(
        &self,
        index: usize,
        what: &str,
        low: i64,
        high: i64,
    ) -> Result<i64, FormatError> {
        let word = self.word(index, what)?;
        match word.parse::<i64>() {
            Ok(value) if (low..=high).contains(&value) => Ok(value),
            _ => Err(self.error(what, format!("an integer from {low} to {high}"), clipped(word))),
        }
    }

    /// As [`Line::integer`], not negative.
    pub fn index(&self, index: usize, what: &str, high: i64) -> Result<usize, FormatError> {
        self.integer(index, what, 0, high).map(|value| value.unsigned_abs() as usize)
    }

    fn word(&self, index: usize, what: &str) -> Result<&'a str, FormatError> {
        self.arguments
            .get(index)
            .copied()
            .ok_or_else(|| self.error(what, format!("argument {}", index + 1), "nothing"))
    }
}

/// A word of a file, short enough for a message.
pub(super) fn clipped(word: &str) -> String {
    if word.chars().count() <= 40 {
        return word.into();
    }
    word.chars().take(40).chain("...".chars()).collect()
}
