//! The header of a point cloud.

use crate::error::FormatError;

/// A header is text of a dozen lines: one that is longer than this is none, bytes.
const LONGEST: usize = 1 << 16;
/// Fields of a point, numbers of a field and bytes of a point there may be.
const MOST_FIELDS: usize = 1024;
const MOST_POINT_BYTES: usize = 1 << 16;

pub(super) const FORMAT: &str = "PCD";

pub(super) fn wrong(
    offset: usize,
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl Into<String>,
) -> FormatError {
    let given: String = given.into();
    let given = given.chars().take(60).collect();
    FormatError::Binary {
        format: FORMAT,
        offset,
        what: what.into(),
        expected: expected.into(),
        given,
    }
}

/// How the points of a file are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PcdData {
    /// One line of text a point.
    Ascii,
    /// One record a point.
    Binary,
    /// Column by column, packed by LZF.
    BinaryCompressed,
}

/// What the numbers of a field are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PcdNumber {
    /// Signed integers of 1, 2, 4 or 8 bytes.
    Signed,
    /// Unsigned integers of 1, 2, 4 or 8 bytes.
    Unsigned,
    /// Floating point of 4 or 8 bytes.
    Float,
}

/// A field of the points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PcdField {
    /// Its name; `_` for padding.
    pub name: String,
    /// Bytes of one of its numbers.
    pub size: usize,
    /// What its numbers are.
    pub number: PcdNumber,
    /// How many numbers it has.
    pub count: usize,
}

impl PcdField {
    /// Bytes of the field in a point.
    pub(super) fn bytes(&self) -> usize {
        self.size * self.count
    }
}

/// What the header says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) fields: Vec<PcdField>,
    pub(super) points: usize,
    pub(super) data: PcdData,
    /// Where the points begin.
    pub(super) offset: usize,
}

impl Header {
    /// Bytes of a point.
    pub(super) fn point_bytes(&self) -> usize {
        self.fields.iter().map(PcdField::bytes).sum()
    }

    pub(super) fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        let mut offset = 0;
        let (mut names, mut sizes, mut types, mut counts) = (None, None, None, None);
        let (mut width, mut height, mut points) = (None, None, None);
        loop {
            let rest = &bytes[offset..bytes.len().min(LONGEST)];
            let Some(end) = rest.iter().position(|byte| *byte == b'\n') else {
                return Err(wrong(offset, "the header", "a DATA line at its end", "none"));
            };
            let line = std::str::from_utf8(&rest[..end])
                .map_err(|_| wrong(offset, "the header", "lines of text", "other bytes"))?;
            let at = offset;
            offset += end + 1;
            let mut words = line.split_whitespace();
            let key = words.next().unwrap_or_default();
            let words: Vec<&str> = words.collect();
            if words.len() > MOST_FIELDS {
                let expected = format!("at most {MOST_FIELDS} fields");
                return Err(wrong(at, key, expected, words.len().to_string()));
            }
            let number = || {
                let text = words.first().copied().unwrap_or_default();
                text.parse::<usize>().map_err(|_| wrong(at, key, "a whole number", text))
            };
            match key {
                "" => {}
                comment if comment.starts_with('#') => {}
                "VERSION" => {
                    let version = words.first().copied().unwrap_or_default();
                    if !["0.7", ".7"].contains(&version) {
                        return Err(wrong(at, "VERSION", "0.7", version));
                    }
                }
                "FIELDS" => names = Some(words.iter().map(|word| (*word).to_owned()).collect()),
                "SIZE" => sizes = Some(numbers(at, key, &words)?),
                "COUNT" => counts = Some(numbers(at, key, &words)?),
                "TYPE" => types = Some(words.iter().map(|word| (*word).to_owned()).collect()),
                "WIDTH" => width = Some(number()?),
                "HEIGHT" => height = Some(number()?),
                "POINTS" => points = Some(number()?),
                "VIEWPOINT" => {}
                "DATA" => {
                    let data = match words.first().copied().unwrap_or_default() {
                        "ascii" => PcdData::Ascii,
                        "binary" => PcdData::Binary,
                        "binary_compressed" => PcdData::BinaryCompressed,
                        other => {
                            return Err(wrong(
                                at,
                                "DATA",
                                "ascii, binary or binary_compressed",
                                other,
                            ));
                        }
                    };
                    let fields = fields(at, names, sizes, types, counts)?;
                    let points = match (points, width, height) {
                        (Some(points), ..) => points,
                        (None, Some(width), height) => width.saturating_mul(height.unwrap_or(1)),
                        _ => return Err(wrong(at, "the header", "a POINTS line", "none")),
                    };
                    return Ok(Self { fields, points, data, offset });
                }
                other => return Err(wrong(at, "the header", "a line of PCD 0.7", other)),
            }
        }
    }
}

fn numbers(at: usize, key: &str, words: &[&str]) -> Result<Vec<usize>, FormatError> {
    let number = |word: &&str| word.parse().map_err(|_| wrong(at, key, "whole numbers", *word));
    words.iter().map(number).collect()
}

fn fields(
    at: usize,
    names: Option<Vec<String>>,
    sizes: Option<Vec<usize>>,
    types: Option<Vec<String>>,
    counts: Option<Vec<usize>>,
) -> Result<Vec<PcdField>, FormatError> {
    let none = |what: &str| wrong(at, "the header", format!("a {what} line"), "none");
    let names = names.filter(|names| !names.is_empty()).ok_or_else(|| none("FIELDS"))?;
    let sizes = sizes.ok_or_else(|| none("SIZE"))?;
    let types = types.ok_or_else(|| none("TYPE"))?;
    let counts = counts.unwrap_or_else(|| vec![1; names.len()]);
    for (key, length) in [("SIZE", sizes.len()), ("TYPE", types.len()), ("COUNT", counts.len())] {
        if length != names.len() {
            let expected = format!("one for each of {} fields", names.len());
            return Err(wrong(at, key, expected, length.to_string()));
        }
    }
    let mut fields = Vec::with_capacity(names.len());
    let mut bytes = 0_usize;
    for (((name, size), kind), count) in names.into_iter().zip(sizes).zip(types).zip(counts) {
        let number = match (kind.as_str(), size) {
            ("I", 1 | 2 | 4 | 8) => PcdNumber::Signed,
            ("U", 1 | 2 | 4 | 8) => PcdNumber::Unsigned,
            ("F", 4 | 8) => PcdNumber::Float,
            _ => {
                let expected = "I or U of 1, 2, 4 or 8 bytes, or F of 4 or 8";
                return Err(wrong(
                    at,
                    format!("type of {name}"),
                    expected,
                    format!("{kind} of {size}"),
                ));
            }
        };
        bytes = bytes.saturating_add(size.saturating_mul(count));
        if bytes > MOST_POINT_BYTES {
            let expected = format!("at most {MOST_POINT_BYTES} bytes a point");
            return Err(wrong(at, "COUNT", expected, count.to_string()));
        }
        fields.push(PcdField { name, size, number, count });
    }
    if bytes == 0 {
        return Err(wrong(at, "COUNT", "at least one number a point", "0"));
    }
    Ok(fields)
}
