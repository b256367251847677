//! Arrays of complex numbers, as results carry them: interleaved, with their shape.

use super::{Described, columns};
use ndarray::{Array, Dimension};
use num_complex::{Complex32, Complex64};
use serde::{Serialize, Serializer};

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

/// The same in single precision.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "ComplexArray32")]
pub struct ComplexArray32 {
    /// Real and imaginary parts, one after the other.
    #[serde(serialize_with = "columns::serialize")]
    pub data: Vec<f32>,
    /// Lengths of the axes.
    pub shape: Vec<usize>,
}

impl<D: Dimension> From<&Array<Complex64, D>> for ComplexArray {
    fn from(array: &Array<Complex64, D>) -> Self {
        let data = array.iter().flat_map(|z| [z.re, z.im]).collect();
        Self { data, shape: array.shape().to_vec() }
    }
}

impl<D: Dimension> From<&Array<Complex32, D>> for ComplexArray32 {
    fn from(array: &Array<Complex32, D>) -> Self {
        let data = array.iter().flat_map(|z| [z.re, z.im]).collect();
        Self { data, shape: array.shape().to_vec() }
    }
}

/// Serializes an array as a [`ComplexArray`].
///
/// # Errors
/// Those of the serializer.
pub fn serialize<D: Dimension, S: Serializer>(
    array: &Array<Complex64, D>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    ComplexArray::from(array).serialize(serializer)
}
