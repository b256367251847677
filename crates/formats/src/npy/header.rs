//! The header: a Python dictionary literal with `descr`, `fortran_order` and `shape`.

use super::read::malformed;
use crate::error::FormatError;

/// Most axes an array may have, as in NumPy 1.
const MAX_AXES: usize = 32;

/// What the header says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub descr: String,
    pub fortran_order: bool,
    pub shape: Vec<usize>,
}

/// Walks over the text of the header.
struct Scanner<'a> {
    text: &'a [u8],
    at: usize,
    base: usize,
}

impl Header {
    /// Parses the dictionary, which stands at byte `base` of the file.
    pub fn parse(text: &[u8], base: usize) -> Result<Self, FormatError> {
        let mut scanner = Scanner { text, at: 0, base };
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        scanner.expect(b'{', "a dictionary")?;
        while !scanner.take(b'}') {
            let key = scanner.string("a key in quotes")?;
            scanner.expect(b':', "a colon")?;
            match key.as_str() {
                "descr" => descr = Some(scanner.string("the name of a plain number type")?),
                "fortran_order" => fortran_order = Some(scanner.boolean()?),
                "shape" => shape = Some(scanner.tuple()?),
                _ => return Err(scanner.error("descr, fortran_order or shape", &key)),
            }
            if !scanner.take(b',') {
                scanner.expect(b'}', "a comma or the end of the dictionary")?;
                break;
            }
        }
        let missing = |key: &str| malformed(base, "header", format!("the key {key}"), "none");
        Ok(Self {
            descr: descr.ok_or_else(|| missing("descr"))?,
            fortran_order: fortran_order.ok_or_else(|| missing("fortran_order"))?,
            shape: shape.ok_or_else(|| missing("shape"))?,
        })
    }
}

impl Scanner<'_> {
    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn error(&self, expected: &str, given: &str) -> FormatError {
        malformed(self.base + self.at, "header", expected, given)
    }

    fn unexpected(&mut self, expected: &str) -> FormatError {
        let given = match self.peek() {
            Some(byte) if byte.is_ascii_graphic() => char::from(byte).to_string(),
            Some(byte) => format!("byte {byte:#04x}"),
            None => "the end of the header".into(),
        };
        self.error(expected, &given)
    }

    fn expect(&mut self, byte: u8, expected: &str) -> Result<(), FormatError> {
        if self.take(byte) { Ok(()) } else { Err(self.unexpected(expected)) }
    }

    fn string(&mut self, expected: &str) -> Result<String, FormatError> {
        let quote = match self.peek() {
            Some(quote @ (b'\'' | b'"')) => quote,
            _ => return Err(self.unexpected(expected)),
        };
        let begin = self.at + 1;
        let rest = self.text.get(begin..).unwrap_or_default();
        let length = rest
            .iter()
            .take(64)
            .position(|&byte| byte == quote)
            .ok_or_else(|| self.error("a closing quote within 64 characters", "none"))?;
        self.at = begin + length + 1;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }

    fn boolean(&mut self) -> Result<bool, FormatError> {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        for (word, value) in [("True", true), ("False", false)] {
            if rest.starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(value);
            }
        }
        Err(self.unexpected("True or False"))
    }

    fn tuple(&mut self) -> Result<Vec<usize>, FormatError> {
        let mut lengths = vec![];
        self.expect(b'(', "a tuple")?;
        while !self.take(b')') {
            lengths.push(self.length()?);
            if lengths.len() > MAX_AXES {
                return Err(self.error("at most 32 axes", "more"));
            }
            if !self.take(b',') {
                self.expect(b')', "a comma or the end of the tuple")?;
                break;
            }
        }
        Ok(lengths)
    }

    fn length(&mut self) -> Result<usize, FormatError> {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        if digits == 0 {
            return Err(self.unexpected("the length of an axis"));
        }
        let text = String::from_utf8_lossy(&rest[..digits.min(24)]);
        let value = text
            .parse()
            .map_err(|_| self.error("the length of an axis that memory can hold", &text))?;
        self.at += digits;
        // Python 2 wrote long integers with an L.
        self.take(b'L');
        Ok(value)
    }
}
