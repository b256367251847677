//! NumPy's `.npy` files, versions 1 to 3: little-endian numbers of 1 to 16 bytes in C or Fortran
//! order.
//!
//! Read here rather than by a library so that every size in the header is held against the bytes
//! present before anything is allocated, and errors say at which byte.

mod header;
mod read;
mod write;

use boresight_core::{Complex32, Complex64};
pub(crate) use read::first_index_first;
pub use write::{Element, preamble, write};

/// Numbers of an array, in C order.
#[derive(Debug, Clone, PartialEq)]
pub enum NpyData {
    /// `f4`.
    Float32(Vec<f32>),
    /// `f8`.
    Float64(Vec<f64>),
    /// `c8`.
    Complex32(Vec<Complex32>),
    /// `c16`.
    Complex64(Vec<Complex64>),
    /// `b1`, `i1` to `i8` and `u1` to `u8`.
    Integer(Vec<i64>),
}

/// An array read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct NpyArray {
    /// Lengths of its axes; empty for a single number.
    pub shape: Vec<usize>,
    /// Its numbers, in C order.
    pub data: NpyData,
}

impl NpyArray {
    /// Whether the numbers are complex.
    pub fn is_complex(&self) -> bool {
        matches!(self.data, NpyData::Complex32(_) | NpyData::Complex64(_))
    }

    /// The numbers as complex ones of double precision.
    pub fn to_complex64(&self) -> Vec<Complex64> {
        let real = |value: f64| Complex64::new(value, 0.0);
        match &self.data {
            NpyData::Float32(v) => v.iter().map(|&x| real(f64::from(x))).collect(),
            NpyData::Float64(v) => v.iter().map(|&x| real(x)).collect(),
            NpyData::Complex32(v) => {
                v.iter().map(|z| Complex64::new(f64::from(z.re), f64::from(z.im))).collect()
            }
            NpyData::Complex64(v) => v.clone(),
            NpyData::Integer(v) => v.iter().map(|&x| real(x as f64)).collect(),
        }
    }

    /// The numbers as complex ones of single precision.
    pub fn to_complex32(&self) -> Vec<Complex32> {
        match &self.data {
            NpyData::Complex32(v) => v.clone(),
            _ => self
                .to_complex64()
                .iter()
                .map(|z| Complex32::new(z.re as f32, z.im as f32))
                .collect(),
        }
    }

    /// The numbers as real ones; `None` if they are complex.
    pub fn to_f64(&self) -> Option<Vec<f64>> {
        (!self.is_complex()).then(|| self.to_complex64().iter().map(|z| z.re).collect())
    }
}

#[cfg(test)]
mod tests;
