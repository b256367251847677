//! One of several parts that work is split into.

use boresight_core::InputError;
use boresight_math::error::check_range;
use std::fmt::{Display, Formatter};
use std::str::FromStr;

/// Every `of`-th piece of numbered work, so that all parts take about as long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    number: u64,
    of: u64,
}

impl Part {
    /// All of the work.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Part `number`, from 1, of `of`.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] unless `number` is within 1 and `of`, and `of` at most a million.
    pub fn new(number: u64, of: u64) -> Result<Self, InputError> {
        check_range("parts", of as f64, 1.0, 1e6)?;
        check_range("number of the part", number as f64, 1.0, of as f64)?;
        Ok(Self { number, of })
    }

    /// Whether it holds a piece, by its number from 0.
    #[must_use]
    pub fn contains(&self, piece: u64) -> bool {
        piece % self.of == self.number - 1
    }

    /// Name of the file of its records: `NAME.jsonl` of the whole, otherwise `NAME-1-of-4.jsonl`.
    #[must_use]
    pub fn file_name(&self, name: &str) -> String {
        match *self {
            Self::WHOLE => format!("{name}.jsonl"),
            Self { number, of } => format!("{name}-{number}-of-{of}.jsonl"),
        }
    }
}

impl Display for Part {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Part {
    type Err = InputError;

    /// From `1/4`.
    fn from_str(text: &str) -> Result<Self, InputError> {
        let malformed = || InputError::Malformed {
            what: "part".into(),
            expected: "K/N, such as 1/4".into(),
            given: text.into(),
        };
        let (number, of) = text.split_once('/').ok_or_else(malformed)?;
        let number_of = |text: &str| text.parse::<u64>().map_err(|_| malformed());
        Self::new(number_of(number)?, number_of(of)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;

    #[test]
    fn parts_hold_every_piece_once() {
        let mut all: Vec<(u64, u64)> = vec![];
        for number in 1..=3 {
            let part = Part::new(number, 3).unwrap();
            all.extend((0..10).filter(|&piece| part.contains(piece)).map(|piece| (piece, number)));
        }
        all.sort_unstable();
        let numbers: Vec<u64> = all.into_iter().map(|(_, number)| number).collect();
        assert_eq!(numbers, [1, 2, 3, 1, 2, 3, 1, 2, 3, 1]);
    }

    #[test]
    fn a_part_is_within_the_whole() {
        for (text, what) in [
            ("0/3", "number of the part"),
            ("4/3", "number of the part"),
            ("1/0", "parts"),
            ("1/2000000", "parts"),
            ("1", "part"),
            ("a/3", "part"),
            ("1/-3", "part"),
        ] {
            assert_eq!(text.parse::<Part>().unwrap_err().details().what, what, "{text}");
        }
        assert_eq!("2/7".parse(), Part::new(2, 7));
        assert_eq!(Part::new(2, 7).unwrap().file_name("a"), "a-2-of-7.jsonl");
        assert_eq!(Part::WHOLE.file_name("a"), "a.jsonl");
    }
}
