//! Writing.

use crate::error::FormatError;
use boresight_core::{Complex32, Complex64, InputError};

/// A number type that can be written.
pub trait Element: Copy {
    /// Its name in the header.
    const DESCR: &'static str;
    /// Appends its bytes.
    fn put(self, bytes: &mut Vec<u8>);
}

impl Element for f32 {
    const DESCR: &'static str = "<f4";
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for f64 {
    const DESCR: &'static str = "<f8";
    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for Complex32 {
    const DESCR: &'static str = "<c8";
    fn put(self, bytes: &mut Vec<u8>) {
        self.re.put(bytes);
        self.im.put(bytes);
    }
}

impl Element for Complex64 {
    const DESCR: &'static str = "<c16";
    fn put(self, bytes: &mut Vec<u8>) {
        self.re.put(bytes);
        self.im.put(bytes);
    }
}

/// The bytes of a `.npy` file (version 1) of numbers in C order.
///
/// # Errors
/// [`InputError::Shape`] if the shape does not hold the count of numbers;
/// [`InputError::OutOfRange`] for more than 32 axes.
pub fn write<T: Element>(shape: &[usize], data: &[T]) -> Result<Vec<u8>, FormatError> {
    let count = shape.iter().try_fold(1_usize, |n, &length| n.checked_mul(length));
    if count != Some(data.len()) {
        return Err(InputError::Shape {
            what: "data".into(),
            expected: format!("{} numbers, to fill {shape:?}", count.unwrap_or(usize::MAX)),
            given: vec![data.len()],
        }
        .into());
    }
    let mut bytes = preamble::<T>(shape)?;
    bytes.reserve_exact(std::mem::size_of_val(data));
    for &value in data {
        value.put(&mut bytes);
    }
    Ok(bytes)
}

/// What stands before the numbers in such a file.
///
/// # Errors
/// [`InputError::OutOfRange`] for more than 32 axes.
pub fn preamble<T: Element>(shape: &[usize]) -> Result<Vec<u8>, FormatError> {
    boresight_math::error::check_range("axes", shape.len() as f64, 0.0, 32.0)?;
    let axes: String = shape.iter().map(|length| format!("{length}, ")).collect();
    // One axis needs its comma; more read better without the last one.
    let axes = if shape.len() == 1 { axes.trim_end() } else { axes.trim_end_matches(", ") };
    let mut header =
        format!("{{'descr': '{}', 'fortran_order': False, 'shape': ({axes}), }}", T::DESCR);
    // Magic, version and length take 10 bytes; the data starts at a multiple of 64.
    let padding = (10 + header.len() + 1).next_multiple_of(64) - (10 + header.len() + 1);
    header.extend(std::iter::repeat_n(' ', padding));
    header.push('\n');
    let mut bytes = Vec::with_capacity(10 + header.len());
    bytes.extend(b"\x93NUMPY\x01\x00");
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    Ok(bytes)
}
