//! The points of a point cloud.

use super::header::{FORMAT, Header, PcdData, PcdField, PcdNumber, wrong};
use super::lzf;
use crate::error::FormatError;
use std::borrow::Cow;

/// A point cloud, read column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct PointCloud<'a> {
    header: Header,
    body: Body<'a>,
}

#[derive(Debug, Clone, PartialEq)]
enum Body<'a> {
    /// Numbers of all points, one point after the other.
    Text(Vec<f64>),
    /// Records.
    Rows(&'a [u8]),
    /// Columns.
    Columns(Cow<'a, [u8]>),
}

impl<'a> PointCloud<'a> {
    /// Reads a file whose header is checked against what follows before anything is allocated by it.
    ///
    /// # Errors
    /// [`FormatError::Binary`] with the position of what is wrong.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let header = Header::parse(bytes)?;
        let rest = &bytes[header.offset..];
        let length = header.points.checked_mul(header.point_bytes());
        let cut = |expected: String| {
            wrong(header.offset, "the points", expected, format!("{} bytes", rest.len()))
        };
        let body = match header.data {
            PcdData::Ascii => Body::Text(text(&header, rest)?),
            PcdData::Binary => {
                let rows = length.and_then(|length| rest.get(..length));
                Body::Rows(rows.ok_or_else(|| {
                    cut(format!("{} points of {} bytes", header.points, header.point_bytes()))
                })?)
            }
            PcdData::BinaryCompressed => {
                let word = |at: usize| {
                    let word = rest.get(at..at + 4)?.try_into().ok()?;
                    usize::try_from(u32::from_le_bytes(word)).ok()
                };
                let packed = word(0).zip(word(4)).and_then(|(packed, unpacked)| {
                    Some((rest.get(8..packed.checked_add(8)?)?, unpacked))
                });
                let (packed, unpacked) =
                    packed.ok_or_else(|| cut("the packed bytes that their length says".into()))?;
                if Some(unpacked) != length {
                    let expected = format!(
                        "that of {} points of {} bytes",
                        header.points,
                        header.point_bytes()
                    );
                    return Err(wrong(
                        header.offset + 4,
                        "length of the unpacked points",
                        expected,
                        unpacked.to_string(),
                    ));
                }
                let columns = lzf::unpack(packed, unpacked).map_err(|(at, given)| {
                    wrong(
                        header.offset + 8 + at,
                        "the packed points",
                        format!("{unpacked} bytes"),
                        given,
                    )
                })?;
                Body::Columns(columns.into())
            }
        };
        Ok(Self { header, body })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.header.points
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.header.points == 0
    }

    /// The fields, in the order of the file.
    pub fn fields(&self) -> &[PcdField] {
        &self.header.fields
    }

    /// How the points are stored.
    pub fn data(&self) -> PcdData {
        self.header.data
    }

    /// The first number of a field in each point; `None` where there is no such field. Integers beyond 2^53 are rounded.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let fields = &self.header.fields;
        let place = fields.iter().position(|field| field.name == name && field.count > 0)?;
        let field = &fields[place];
        let before = &fields[..place];
        let bytes_before: usize = before.iter().map(PcdField::bytes).sum();
        let points = self.header.points;
        Some(match &self.body {
            Body::Text(numbers) => {
                let (at, step): (usize, usize) = (
                    before.iter().map(|field| field.count).sum(),
                    fields.iter().map(|field| field.count).sum(),
                );
                numbers.iter().skip(at).step_by(step).copied().collect()
            }
            Body::Rows(bytes) => bytes
                .chunks_exact(self.header.point_bytes())
                .map(|row| number(field, &row[bytes_before..]))
                .collect(),
            Body::Columns(bytes) => bytes[bytes_before * points..]
                .chunks_exact(field.bytes())
                .take(points)
                .map(|bytes| number(field, bytes))
                .collect(),
        })
    }

    /// The same, or an error with the fields there are.
    ///
    /// # Errors
    /// [`FormatError::Binary`].
    pub fn need(&self, name: &str) -> Result<Vec<f64>, FormatError> {
        self.column(name).ok_or_else(|| self.lacks(name))
    }

    /// The error for a cloud without a field.
    pub(crate) fn lacks(&self, expected: &str) -> FormatError {
        let names: Vec<&str> =
            self.fields().iter().take(24).map(|field| field.name.as_str()).collect();
        FormatError::Binary {
            format: FORMAT,
            offset: 0,
            what: "FIELDS".into(),
            expected: format!("{expected} among them"),
            given: names.join(" ").chars().take(200).collect(),
        }
    }
}

/// A number of a field, whose bytes begin with it.
fn number(field: &PcdField, bytes: &[u8]) -> f64 {
    let word = |size: usize| {
        let mut word = [0; 8];
        word[..size].copy_from_slice(&bytes[..size]);
        u64::from_le_bytes(word)
    };
    let bits = word(field.size);
    match (field.number, field.size) {
        (PcdNumber::Float, 4) => f64::from(f32::from_bits(bits as u32)),
        (PcdNumber::Float, _) => f64::from_bits(bits),
        (PcdNumber::Unsigned, _) => bits as f64,
        (PcdNumber::Signed, size) => {
            let unused = 64 - 8 * size as u32;
            ((bits << unused) as i64 >> unused) as f64
        }
    }
}

/// The numbers of a text body; lines beyond the announced points are refused as those are.
fn text(header: &Header, rest: &[u8]) -> Result<Vec<f64>, FormatError> {
    let numbers: usize = header.fields.iter().map(|field| field.count).sum();
    let body = std::str::from_utf8(rest).map_err(|error| {
        wrong(header.offset + error.valid_up_to(), "the points", "text", "other bytes")
    })?;
    let mut values = Vec::new();
    let mut points = 0;
    for line in body.lines() {
        let at = header.offset + (line.as_ptr() as usize - body.as_ptr() as usize);
        if line.trim().is_empty() {
            continue;
        }
        points += 1;
        let before = values.len();
        for word in line.split_whitespace().take(numbers + 1) {
            let value = word.parse().map_err(|_| wrong(at, "a point", "numbers", word))?;
            values.push(value);
        }
        if values.len() - before != numbers {
            let given = (values.len() - before).to_string();
            return Err(wrong(at, "a point", format!("{numbers} numbers"), given));
        }
        if points > header.points {
            break;
        }
    }
    if points == header.points {
        return Ok(values);
    }
    let given = if points > header.points { "more".into() } else { points.to_string() };
    Err(wrong(header.offset, "the points", header.points.to_string(), given))
}
