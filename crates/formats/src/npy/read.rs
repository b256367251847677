//! Reading.

use super::header::Header;
use super::{NpyArray, NpyData};
use crate::error::FormatError;
use boresight_core::{Complex32, Complex64};

const MAGIC: &[u8] = b"\x93NUMPY";

pub(super) fn malformed(
    offset: usize,
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl Into<String>,
) -> FormatError {
    FormatError::Binary {
        format: "npy",
        offset,
        what: what.into(),
        expected: expected.into(),
        given: given.into(),
    }
}

impl NpyArray {
    /// Reads a file.
    ///
    /// # Errors
    /// [`FormatError::Binary`] for a file that is no `.npy` file, holds anything but plain
    /// little-endian numbers, or does not have the length its header gives.
    pub fn parse(bytes: &[u8]) -> Result<Self, FormatError> {
        let (header_at, body_at) = extent(bytes)?;
        let header = Header::parse(&bytes[header_at..body_at], header_at)?;
        let size = item_size(&header.descr).ok_or_else(|| unsupported(header_at, &header.descr))?;
        let count = header.shape.iter().try_fold(1_usize, |n, &length| n.checked_mul(length));
        let expected = count.and_then(|count| count.checked_mul(size));
        let body = &bytes[body_at..];
        if expected != Some(body.len()) {
            return Err(malformed(
                body_at,
                "size of the data",
                format!(
                    "{} bytes for shape {:?} of {}",
                    expected.map_or("more than memory can hold, in".into(), |n| n.to_string()),
                    header.shape,
                    header.descr
                ),
                format!("{} bytes", body.len()),
            ));
        }
        let order = header.fortran_order.then_some(header.shape.as_slice());
        let data = decode(&header.descr, body, order)
            .ok_or_else(|| unsupported(header_at, &header.descr))?;
        if let NpyData::Integer(values) = &data
            && header.descr.ends_with("u8")
            && let Some(k) = values.iter().position(|&value| value < 0)
        {
            let given = (values[k] as u64).to_string();
            return Err(malformed(body_at + 8 * k, "integer", "less than 2^63", given));
        }
        Ok(Self { shape: header.shape, data })
    }
}

fn unsupported(offset: usize, descr: &str) -> FormatError {
    let expected = "one of <f4, <f8, <c8, <c16, |b1, |i1, |u1, <i2, <u2, <i4, <u4, <i8, <u8";
    malformed(offset, "number type", expected, descr)
}

/// Where the header's text begins and where it ends.
fn extent(bytes: &[u8]) -> Result<(usize, usize), FormatError> {
    if !bytes.starts_with(MAGIC) {
        let given: Vec<u8> = bytes.iter().take(6).copied().collect();
        return Err(malformed(0, "magic", "\\x93NUMPY", format!("{given:02x?}")));
    }
    let truncated = |offset| malformed(offset, "header", "its length", "the end of the file");
    let version = *bytes.get(6).ok_or_else(|| truncated(6))?;
    let (length, begin): (usize, usize) = match version {
        1 => match bytes.get(8..10) {
            Some(b) => (usize::from(u16::from_le_bytes([b[0], b[1]])), 10),
            None => return Err(truncated(8)),
        },
        2 | 3 => match bytes.get(8..12) {
            Some(b) => (u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize, 12),
            None => return Err(truncated(8)),
        },
        other => return Err(malformed(6, "version", "1, 2 or 3", other.to_string())),
    };
    match length.checked_add(begin) {
        Some(end) if end <= bytes.len() => Ok((begin, end)),
        _ => Err(malformed(
            8,
            "length of the header",
            format!("at most {}, what is left of the file", bytes.len() - begin),
            length.to_string(),
        )),
    }
}

/// The type without its byte order; `None` for big-endian types.
fn plain(descr: &str) -> Option<&str> {
    let rest = descr.strip_prefix(['<', '|', '='])?;
    let single = matches!(rest, "b1" | "i1" | "u1");
    (single || !descr.starts_with('|')).then_some(rest)
}

fn item_size(descr: &str) -> Option<usize> {
    Some(match plain(descr)? {
        "b1" | "i1" | "u1" => 1,
        "i2" | "u2" => 2,
        "f4" | "i4" | "u4" => 4,
        "f8" | "i8" | "u8" | "c8" => 8,
        "c16" => 16,
        _ => return None,
    })
}

fn decode(descr: &str, body: &[u8], fortran: Option<&[usize]>) -> Option<NpyData> {
    Some(match plain(descr)? {
        "f4" => NpyData::Float32(numbers(body, fortran, f32::from_le_bytes)),
        "f8" => NpyData::Float64(numbers(body, fortran, f64::from_le_bytes)),
        "c8" => NpyData::Complex32(numbers(body, fortran, |b: [u8; 8]| {
            let part = |k: usize| f32::from_le_bytes([b[k], b[k + 1], b[k + 2], b[k + 3]]);
            Complex32::new(part(0), part(4))
        })),
        "c16" => NpyData::Complex64(numbers(body, fortran, |b: [u8; 16]| {
            let part = |k: usize| {
                let mut half = [0; 8];
                half.copy_from_slice(&b[k..k + 8]);
                f64::from_le_bytes(half)
            };
            Complex64::new(part(0), part(8))
        })),
        "b1" | "u1" => NpyData::Integer(numbers(body, fortran, |b: [u8; 1]| i64::from(b[0]))),
        "i1" => NpyData::Integer(numbers(body, fortran, |b| i64::from(i8::from_le_bytes(b)))),
        "i2" => NpyData::Integer(numbers(body, fortran, |b| i64::from(i16::from_le_bytes(b)))),
        "u2" => NpyData::Integer(numbers(body, fortran, |b| i64::from(u16::from_le_bytes(b)))),
        "i4" => NpyData::Integer(numbers(body, fortran, |b| i64::from(i32::from_le_bytes(b)))),
        "u4" => NpyData::Integer(numbers(body, fortran, |b| i64::from(u32::from_le_bytes(b)))),
        "i8" | "u8" => NpyData::Integer(numbers(body, fortran, i64::from_le_bytes)),
        _ => return None,
    })
}

/// Numbers of `N` bytes each, brought into C order if `fortran` gives the shape of an array in
/// Fortran order.
fn numbers<T, const N: usize>(
    body: &[u8],
    fortran: Option<&[usize]>,
    make: impl Fn([u8; N]) -> T,
) -> Vec<T> {
    let at = |index: usize| {
        let mut item = [0; N];
        item.copy_from_slice(&body[N * index..N * (index + 1)]);
        make(item)
    };
    let count = body.len() / N;
    let Some(shape) = fortran else { return (0..count).map(at).collect() };
    (0..count).map(|index| at(first_index_first(shape, index))).collect()
}

/// Where the element of an index in C order stands in an array of Fortran order.
pub(crate) fn first_index_first(shape: &[usize], index: usize) -> usize {
    let (mut rest, mut place) = (index, 0);
    let mut stride: usize = shape.iter().product();
    for &length in shape.iter().rev() {
        stride /= length;
        place += rest % length * stride;
        rest /= length;
    }
    place
}
