//! Numbers out of typed arrays with their shape.

use crate::error::{BindingError, Fallible};
use crate::given;
use crate::read::{Fields, Read, wrong_type};
use boresight_core::{Complex32, Complex64, InputError};
use js_sys::{Float32Array, Float64Array};
use ndarray::ArrayView4;
use wasm_bindgen::JsValue;

/// Complex numbers in C order with their shape.
pub struct ComplexData {
    /// The numbers.
    pub data: Vec<Complex64>,
    /// Their shape; its product is the number of them.
    pub shape: Vec<usize>,
    /// Whether they came in single precision.
    pub single: bool,
}

impl ComplexData {
    /// Reads `data` and `shape`, and refuses other fields.
    pub fn of(fields: Fields) -> Fallible<Self> {
        Self::read_with(fields, Fewest::One)
    }

    /// The same, and takes none where the shape says so.
    pub fn or_none(fields: Fields) -> Fallible<Self> {
        Self::read_with(fields, Fewest::None)
    }

    fn read_with(fields: Fields, fewest: Fewest) -> Fallible<Self> {
        let RealData { data, shape, single } = numbers(fields, 2, fewest)?;
        let data = data.chunks_exact(2).map(|z| Complex64::new(z[0], z[1])).collect();
        Ok(Self { data, shape, single })
    }

    /// The numbers in single precision.
    pub fn to_complex32(&self) -> Vec<Complex32> {
        self.data.iter().map(|z| Complex32::new(z.re as f32, z.im as f32)).collect()
    }
}

impl Read for ComplexData {
    const EXPECTED: &'static str = "{ data, shape } with interleaved [re, im] numbers";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        Self::of(Fields::new(value, path)?)
    }
}

/// Complex numbers in single precision in C order with their shape.
pub struct Cube {
    /// The numbers.
    pub data: Vec<Complex32>,
    /// Their shape; its product is the number of them.
    pub shape: Vec<usize>,
}

impl Cube {
    /// The cube of one frame: loops x transmitters x receivers x samples, with or without an axis of
    /// frames before.
    pub fn one_frame(&self) -> Fallible<ArrayView4<'_, Complex32>> {
        let wrong = || InputError::Shape {
            what: "cube".into(),
            expected: "[loops, transmitters, receivers, samples], or that after one frame".into(),
            given: self.shape.clone(),
        };
        let ([a, b, c, d] | [1, a, b, c, d]) = self.shape[..] else { return Err(wrong().into()) };
        ArrayView4::from_shape((a, b, c, d), &self.data).map_err(|_| wrong().into())
    }
}

impl Read for Cube {
    const EXPECTED: &'static str = ComplexData::EXPECTED;

    /// A `Float32Array` does not take the way over double precision: cubes are large.
    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let data_path = fields.path_of("data");
        let single = match fields.raw("data")? {
            Some(data) => given::numbers::<Float32Array, f32>(&data, &|| data_path.clone())?,
            None => None,
        };
        let Some(numbers) = single else {
            let all = ComplexData::of(Fields::new(value, path)?)?;
            return Ok(Self { data: all.to_complex32(), shape: all.shape });
        };
        let shape: Vec<usize> = fields.required("shape")?;
        fields.finish()?;
        check_length(data_path, &shape, numbers.len(), 2, Fewest::One)?;
        let data = numbers.chunks_exact(2).map(|z| Complex32::new(z[0], z[1])).collect();
        Ok(Self { data, shape })
    }
}

/// Real numbers in C order with their shape.
pub struct RealData {
    /// The numbers.
    pub data: Vec<f64>,
    /// Their shape; its product is the number of them.
    pub shape: Vec<usize>,
    /// Whether they came in single precision.
    pub single: bool,
}

impl RealData {
    /// Reads `data` and `shape`, and refuses other fields.
    pub fn of(fields: Fields) -> Fallible<Self> {
        numbers(fields, 1, Fewest::One)
    }
}

/// The fewest numbers accepted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fewest {
    None,
    One,
}

/// Reads `data` and `shape`, with `each` numbers for every entry of the shape.
fn numbers(mut fields: Fields, each: usize, fewest: Fewest) -> Fallible<RealData> {
    let (data, single) = float_array(&mut fields, "data")?;
    let shape: Vec<usize> = fields.required("shape")?;
    let path = fields.path_of("data");
    fields.finish()?;
    check_length(path, &shape, data.len(), each, fewest)?;
    Ok(RealData { data, shape, single })
}

/// The numbers of a `Float32Array` or `Float64Array` in a field, and whether it is the former.
pub fn float_array(fields: &mut Fields, name: &'static str) -> Fallible<(Vec<f64>, bool)> {
    let expected = "a Float32Array or Float64Array";
    let given = fields.raw(name)?;
    let path = || fields.path_of(name);
    let value =
        given.ok_or_else(|| BindingError::Missing { what: path(), expected: expected.into() })?;
    if let Some(numbers) = given::numbers::<Float64Array, _>(&value, &path)? {
        return Ok((numbers, false));
    }
    let numbers = given::numbers::<Float32Array, _>(&value, &path)?;
    numbers.map(|numbers| (numbers, true)).ok_or_else(|| wrong_type(&path(), expected, &value))
}

/// Checks that `given` numbers fill `shape` with `each` of them an entry.
fn check_length(
    what: String,
    shape: &[usize],
    given: usize,
    each: usize,
    fewest: Fewest,
) -> Fallible<()> {
    let entries = shape.iter().try_fold(each, |product, &n| product.checked_mul(n));
    if given == 0 && (fewest == Fewest::One || entries != Some(0)) {
        return Err(InputError::Empty { what, expected: "at least one number".into() }.into());
    }
    if entries == Some(given) {
        return Ok(());
    }
    let numbers = if each == 1 { "1 number" } else { "2 numbers" };
    let expected = format!("{numbers} for each entry of shape {shape:?}");
    Err(InputError::Shape { what, expected, given: vec![given] }.into())
}
