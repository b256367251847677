//! Complex data out of interleaved typed arrays.

use crate::error::{BindingError, Fallible};
use crate::read::{Fields, Read, wrong_type};
use boresight_core::{Complex64, CoreError};
use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::{JsCast, JsValue};

/// Complex numbers in C order with their shape.
pub struct ComplexData {
    /// The numbers.
    pub data: Vec<Complex64>,
    /// Their shape; its product is the number of them.
    pub shape: Vec<usize>,
}

impl Read for ComplexData {
    const EXPECTED: &'static str = "{ data, shape } with interleaved [re, im] numbers";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let numbers = float_array(&mut fields, "data")?;
        let shape: Vec<usize> = fields.required("shape")?;
        fields.finish()?;
        check_length(path, &shape, numbers.len(), 2)?;
        let data = numbers.chunks_exact(2).map(|z| Complex64::new(z[0], z[1])).collect();
        Ok(Self { data, shape })
    }
}

/// The numbers of a `Float32Array` or `Float64Array` in a field.
fn float_array(fields: &mut Fields, name: &'static str) -> Fallible<Vec<f64>> {
    let expected = "a Float32Array or Float64Array";
    let path = fields.path_of(name);
    let value = fields
        .raw(name)?
        .ok_or_else(|| BindingError::Missing { what: path.clone(), expected: expected.into() })?;
    // A detached array has no length, and copying from it throws.
    if let Some(array) = value.dyn_ref::<Float64Array>() {
        if array.length() == 0 {
            return Ok(vec![]);
        }
        let mut numbers = zeros(&path, array.length() as usize, 0.0)?;
        array.copy_to(&mut numbers);
        Ok(numbers)
    } else if let Some(array) = value.dyn_ref::<Float32Array>() {
        if array.length() == 0 {
            return Ok(vec![]);
        }
        let mut numbers = zeros(&path, array.length() as usize, 0.0_f32)?;
        array.copy_to(&mut numbers);
        Ok(numbers.into_iter().map(f64::from).collect())
    } else {
        Err(wrong_type(&path, expected, &value))
    }
}

/// `len` copies of `zero`, or an error where memory does not hold them.
pub fn zeros<T: Clone>(what: &str, len: usize, zero: T) -> Fallible<Vec<T>> {
    let mut numbers = Vec::new();
    numbers.try_reserve_exact(len).map_err(|_| BindingError::TooLarge {
        what: what.into(),
        given: len.saturating_mul(size_of::<T>()),
    })?;
    numbers.resize(len, zero);
    Ok(numbers)
}

/// Checks that `given` numbers fill `shape` with `each` of them an entry.
fn check_length(path: &str, shape: &[usize], given: usize, each: usize) -> Fallible<()> {
    if given == 0 {
        let expected = "at least one number".into();
        return Err(CoreError::Empty { what: format!("{path}.data"), expected }.into());
    }
    let entries = shape.iter().try_fold(each, |product, &n| product.checked_mul(n));
    if entries == Some(given) {
        return Ok(());
    }
    Err(CoreError::Shape {
        what: format!("{path}.data"),
        expected: format!("{each} numbers for each entry of shape {shape:?}"),
        given: vec![given],
    }
    .into())
}
