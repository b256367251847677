//! Angle estimation.

use crate::complex::ComplexData;
use crate::error::{BindingError, Fallible};
use crate::options::read_estimator;
use crate::read::{Fields, Read};
use crate::write::{Record, degrees, finite_db, finite_dbs, float32, float64, list};
use boresight_aoa::{self as aoa, Data, Method, SpectrumKind};
use boresight_core::{Complex64, CoreError};
use js_sys::Uint32Array;
use ndarray::{ArrayView2, ArrayView3};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// The estimators and what each needs and gives.
#[wasm_bindgen]
pub fn methods() -> js_sys::Array {
    list(Method::ALL.iter().chain(&Method::NETWORKS).map(|method| {
        let needs = method.requirements();
        let max_snapshots = needs.max_snapshots.map_or(JsValue::NULL, JsValue::from);
        Record::new()
            .with("name", method.name())
            .with("title", needs.title)
            .with("reference", needs.reference)
            .with("minSnapshots", needs.min_snapshots)
            .with("maxSnapshots", max_snapshots)
            .with("takesCovariance", needs.takes_covariance)
            .with("uniformArray", needs.uniform_array)
            .with("lattice", needs.lattice)
            .with("elevation", needs.elevation)
            .with("sourceCount", needs.source_count)
            .with("spectrum", needs.spectrum)
            .with("cost", needs.cost)
            .with("network", needs.network)
    }))
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
    batch: aoa::BatchEstimate,
}

#[wasm_bindgen]
impl Estimator {
    /// Checks that method, array and options go together, and prepares.
    #[wasm_bindgen(constructor)]
    pub fn new(options: &JsValue) -> Fallible<Self> {
        let (method, array, options) = read_estimator(options)?;
        Ok(aoa::Estimator::new(method, &array, &options)?.into())
    }

    /// Estimates the angles in `{ snapshots }` or `{ covariance, snapshotCount }`.
    pub fn estimate(&mut self, input: &JsValue) -> Fallible<JsValue> {
        let input = Input::read(input, "input")?;
        Ok(estimate_record(&self.inner.estimate(input.data()?)?).into())
    }

    /// Estimates the angles in every cell of `{ snapshots }`: [cells, elements] or
    /// [cells, elements, snapshots].
    #[wasm_bindgen(js_name = estimateBatch)]
    pub fn estimate_batch(&mut self, input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        let mut fields = Fields::new(input, "input")?;
        let cells: Cells = fields.required("snapshots")?;
        fields.finish()?;
        let mut fields = Fields::of_optional(options)?;
        let spectra = fields.optional("spectra")?.unwrap_or(false);
        fields.finish()?;
        self.inner.estimate_batch_into(cells.view()?, spectra, &mut self.batch)?;
        Ok(batch_record(&self.batch).into())
    }
}

impl From<aoa::Estimator> for Estimator {
    fn from(inner: aoa::Estimator) -> Self {
        let batch = aoa::BatchEstimate::new(inner.method());
        Self { inner, batch }
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
    CoreError::Shape { what: what.into(), expected: expected.into(), given }.into()
}

/// An estimate as a plain object.
pub fn estimate_record(estimate: &aoa::Estimate) -> Record {
    Record::new()
        .with("method", estimate.method.name())
        .with("sources", list(estimate.sources.iter().map(source_record)))
        .with_some("spectrum", estimate.spectrum.as_ref().map(spectrum_record))
        .with("resolved", estimate.resolved)
        .with("iterations", estimate.iterations)
        .with("warnings", warnings(&estimate.warnings))
}

/// Warnings of an estimator.
pub fn warnings(warnings: &[aoa::Warning]) -> js_sys::Array {
    list(
        warnings
            .iter()
            .map(|w| Record::new().with("code", w.code()).with("message", w.to_string())),
    )
}

fn source_record(source: &aoa::Source) -> Record {
    Record::new()
        .with("azimuthDeg", source.direction.azimuth_rad.to_degrees())
        .with("elevationDeg", source.direction.elevation_rad.to_degrees())
        .with("powerDb", finite_db(source.power))
        .with_some("amplitude", source.amplitude.map(|z| list([z.re, z.im])))
        .with_some("confidence", source.confidence)
}

fn spectrum_record(spectrum: &aoa::Spectrum) -> Record {
    Record::new()
        .with("azimuthDeg", degrees(&spectrum.azimuth_rad))
        .with("elevationDeg", degrees(&spectrum.elevation_rad))
        .with("valuesDb", finite_dbs(&spectrum.values))
        .with("kind", kind_name(spectrum.kind))
}

fn kind_name(kind: SpectrumKind) -> &'static str {
    match kind {
        SpectrumKind::Power => "power",
        SpectrumKind::Pseudo => "pseudo",
    }
}

fn batch_record(batch: &aoa::BatchEstimate) -> Record {
    let sources = &batch.sources;
    let each = |number: fn(&aoa::Source) -> f64| sources.iter().map(number).collect::<Vec<_>>();
    Record::new()
        .with("method", batch.method.name())
        .with("cells", batch.cells as f64)
        .with("cell", Uint32Array::new_from_slice(&batch.cell))
        .with("azimuthDeg", degrees(&each(|s| s.direction.azimuth_rad)))
        .with("elevationDeg", degrees(&each(|s| s.direction.elevation_rad)))
        .with("powerDb", float64(&each(|s| finite_db(s.power))))
        .with_some("spectra", batch.spectra.as_ref().map(|s| spectra_record(s, batch.cells)))
        .with("unresolved", batch.unresolved as f64)
        .with("warnings", list(batch.warnings.iter().map(warning_count_record)))
}

fn spectra_record(spectra: &aoa::Spectra, cells: usize) -> Record {
    let (azimuths, elevations) = (spectra.azimuth_rad.len(), spectra.elevation_rad.len());
    let shape: Vec<f64> = match elevations {
        1 => vec![cells as f64, azimuths as f64],
        _ => vec![cells as f64, elevations as f64, azimuths as f64],
    };
    Record::new()
        .with("azimuthDeg", degrees(&spectra.azimuth_rad))
        .with("elevationDeg", degrees(&spectra.elevation_rad))
        .with("power", float32(&spectra.values))
        .with("shape", list(shape))
        .with("kind", kind_name(spectra.kind))
}

fn warning_count_record(count: &aoa::WarningCount) -> Record {
    Record::new()
        .with("code", count.first.code())
        .with("message", count.first.to_string())
        .with("cells", count.cells as f64)
}
