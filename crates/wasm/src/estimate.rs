//! Angle estimation.

use crate::carry;
use crate::complex::ComplexData;
use crate::error::{BindingError, Fallible};
use crate::options::read_estimator;
use crate::read::{Fields, Read};
use boresight_aoa::method::Requirements;
use boresight_aoa::{self as aoa, Data, Method};
use boresight_core::{Array, Complex64, InputError};
use boresight_options::{Described, Flat};
use ndarray::{ArrayView2, ArrayView3, ArrayViewMut2};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// What a method needs and gives.
#[derive(Described, Serialize)]
pub struct MethodInfo {
    /// Its name.
    name: Method,
    /// What it needs and gives.
    requirements: Flat<Requirements>,
}

/// The estimators and what each needs and gives.
#[wasm_bindgen]
pub fn methods() -> js_sys::Array {
    let all = Method::ALL.into_iter().chain(Method::NETWORKS);
    carry::write_all(all.map(|name| MethodInfo { name, requirements: name.requirements().into() }))
}

/// Estimates angles once. To run one method on many cells keep an [`Estimator`].
#[wasm_bindgen]
pub fn estimate(input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    Estimator::new(options)?.estimate(input)
}

/// An estimator whose preparation is kept between cells.
#[wasm_bindgen]
pub struct Estimator {
    inner: aoa::Estimator,
    /// The array where snapshots have to be corrected for its errors.
    calibrated: Option<Array>,
    batch: aoa::BatchEstimate,
}

#[wasm_bindgen]
impl Estimator {
    /// Checks that method, array and options go together, and prepares.
    #[wasm_bindgen(constructor)]
    pub fn new(options: &JsValue) -> Fallible<Self> {
        let (method, array, options) = read_estimator(options)?;
        let inner = aoa::Estimator::new(method, &array, &options)?;
        let calibrated = array.correction().is_some().then_some(array);
        Ok(Self { calibrated, ..inner.into() })
    }

    /// Estimates the angles in `{ snapshots }` or `{ covariance, snapshotCount }`.
    pub fn estimate(&mut self, input: &JsValue) -> Fallible<JsValue> {
        let mut input = Input::read(input, "input")?;
        if let Some(array) = &self.calibrated {
            input.correct(array)?;
        }
        Ok(carry::write(&self.inner.estimate(input.data()?)?))
    }

    /// Estimates the angles in every cell of `{ snapshots }`: [cells, elements] or
    /// [cells, elements, snapshots].
    #[wasm_bindgen(js_name = estimateBatch)]
    pub fn estimate_batch(&mut self, input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        let mut fields = Fields::new(input, "input")?;
        let mut cells: Cells = fields.required("snapshots")?;
        if let Some(array) = &self.calibrated {
            cells.correct(array)?;
        }
        fields.finish()?;
        let mut fields = Fields::of_optional(options)?;
        let spectra = fields.optional("spectra")?.unwrap_or(false);
        fields.finish()?;
        self.inner.estimate_batch_into(cells.view()?, spectra, &mut self.batch)?;
        Ok(carry::write(&self.batch.columns()))
    }
}

impl From<aoa::Estimator> for Estimator {
    fn from(inner: aoa::Estimator) -> Self {
        let batch = aoa::BatchEstimate::new(inner.method());
        Self { inner, calibrated: None, batch }
    }
}

/// Snapshots of many cells, or of none.
struct Cells(ComplexData);

impl Read for Cells {
    const EXPECTED: &'static str = ComplexData::EXPECTED;

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        ComplexData::or_none(Fields::new(value, path)?).map(Self)
    }
}

impl Cells {
    /// Takes an array's known errors off.
    fn correct(&mut self, array: &Array) -> Fallible<()> {
        let (cells, elements, snapshots) = self.view()?.dim();
        for cell in self.0.data.chunks_mut((elements * snapshots).max(1)).take(cells) {
            let cell = ArrayViewMut2::from_shape((elements, snapshots), cell)
                .map_err(|_| shape_error("snapshots", "a matrix a cell", &self.0.shape))?;
            array.correct(cell)?;
        }
        Ok(())
    }

    fn view(&self) -> Fallible<ArrayView3<'_, Complex64>> {
        let ComplexData { data, shape, .. } = &self.0;
        let axes = match shape[..] {
            [cells, elements] => Some((cells, elements, 1)),
            [cells, elements, snapshots] => Some((cells, elements, snapshots)),
            _ => None,
        };
        axes.and_then(|axes| ArrayView3::from_shape(axes, data).ok()).ok_or_else(|| {
            shape_error("snapshots", "[cells, elements] or [cells, elements, snapshots]", shape)
        })
    }
}

/// Snapshots or a covariance.
pub enum Input {
    /// Elements x snapshots, or a vector of elements.
    Snapshots(ComplexData),
    /// Elements x elements, and the number of snapshots in it.
    Covariance(ComplexData, usize),
}

impl Read for Input {
    const EXPECTED: &'static str = "{ snapshots } or { covariance, snapshotCount }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let snapshots = fields.optional::<ComplexData>("snapshots")?;
        let covariance = fields.optional::<ComplexData>("covariance")?;
        let input = match (snapshots, covariance) {
            (Some(snapshots), None) => Self::Snapshots(snapshots),
            (None, Some(covariance)) => {
                Self::Covariance(covariance, fields.required("snapshotCount")?)
            }
            (given, _) => {
                return Err(BindingError::Type {
                    what: path.into(),
                    expected: Self::EXPECTED.into(),
                    given: if given.is_some() { "both" } else { "neither" }.into(),
                });
            }
        };
        fields.finish()?;
        Ok(input)
    }
}

impl Input {
    /// Takes an array's known errors off: `K Y`, or `K R K^H`.
    ///
    /// # Errors
    /// For a shape that is neither a vector nor a matrix, or other elements than the array has.
    pub fn correct(&mut self, array: &Array) -> Fallible<()> {
        let (data, sides) = match self {
            Self::Snapshots(data) => (data, 1),
            Self::Covariance(data, _) => (data, 2),
        };
        let (rows, columns) = match data.shape[..] {
            [rows] => (rows, 1),
            [rows, columns] => (rows, columns),
            _ => return Err(shape_error("input", "a matrix", &data.shape)),
        };
        let shape = data.shape.clone();
        let wrong = || shape_error("input", "a matrix", &shape);
        for side in 0..sides {
            if side == 1 {
                let adjoint = boresight_math::linalg::adjoint(as_matrix(data, "covariance")?);
                data.data = adjoint.into_iter().collect();
            }
            let view = ArrayViewMut2::from_shape((rows, columns), &mut data.data);
            array.correct(view.map_err(|_| wrong())?)?;
        }
        Ok(())
    }

    /// The data as the estimators take it.
    ///
    /// # Errors
    /// For a shape that is neither a vector nor a matrix.
    pub fn data(&self) -> Fallible<Data<'_>> {
        match self {
            Self::Snapshots(data) => Ok(Data::Snapshots(as_matrix(data, "snapshots")?)),
            Self::Covariance(data, snapshots) => {
                let [rows, columns] = data.shape[..] else {
                    return Err(shape_error("covariance", "[elements, elements]", &data.shape));
                };
                let matrix = matrix(rows, columns, data, "covariance")?;
                Ok(Data::Covariance { matrix, snapshots: *snapshots })
            }
        }
    }
}

/// Snapshots as elements x snapshots; a vector is one snapshot.
pub fn as_matrix<'a>(data: &'a ComplexData, what: &str) -> Fallible<ArrayView2<'a, Complex64>> {
    match data.shape[..] {
        [elements] => matrix(elements, 1, data, what),
        [elements, snapshots] => matrix(elements, snapshots, data, what),
        _ => Err(shape_error(what, "[elements, snapshots]", &data.shape)),
    }
}

fn matrix<'a>(
    rows: usize,
    columns: usize,
    data: &'a ComplexData,
    what: &str,
) -> Fallible<ArrayView2<'a, Complex64>> {
    ArrayView2::from_shape((rows, columns), &data.data)
        .map_err(|_| shape_error(what, "a matrix", &data.shape))
}

/// The error for data of the wrong shape.
pub fn shape_error(what: &str, expected: &str, given: &[usize]) -> BindingError {
    let given = given.to_vec();
    InputError::Shape { what: what.into(), expected: expected.into(), given }.into()
}
