//! Arrays of complex numbers, as results carry them: interleaved, with their shape.

use crate::columns;
use crate::description::Described;
use ndarray::{Array, Dimension};
use num_complex::{Complex, Complex64};
use serde::Serialize;

/// Interleaved [re, im] numbers in C order with their shape (complex numbers, not floats).
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "ComplexArray")]
pub struct ComplexArray {
    /// Real and imaginary parts, one after the other.
    #[serde(serialize_with = "columns::serialize")]
    pub data: Vec<f64>,
    /// Lengths of the axes.
    pub shape: Vec<usize>,
}

impl<D: Dimension> From<&Array<Complex64, D>> for ComplexArray {
    fn from(array: &Array<Complex64, D>) -> Self {
        Self { data: interleaved(array), shape: array.shape().to_vec() }
    }
}

/// Real and imaginary parts, one after the other.
pub fn interleaved<T: Copy, D: Dimension>(array: &Array<Complex<T>, D>) -> Vec<T> {
    array.iter().flat_map(|z| [z.re, z.im]).collect()
}
