//! Named tensors in and out.

use boresight_core::InputError;
use boresight_options::columns;
use boresight_wasm::carry;
use boresight_wasm::error::Fallible;
use boresight_wasm::given;
use boresight_wasm::read::{Fields, Read, wrong_type};
use js_sys::{Float32Array, Reflect};
use ndarray::ArrayD;
use serde::{Serialize, Serializer};
use wasm_bindgen::JsValue;

/// Numbers in C order with their shape.
struct Tensor(ArrayD<f32>);

impl Read for Tensor {
    const EXPECTED: &'static str = "{ data: Float32Array, shape }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let data = fields.raw("data")?.unwrap_or(JsValue::UNDEFINED);
        let own = format!("{path}.data");
        let data = given::numbers::<Float32Array, f32>(&data, &|| own.clone())?
            .ok_or_else(|| wrong_type(&own, "a Float32Array", &data))?;
        let shape: Vec<usize> = fields.required("shape")?;
        fields.finish()?;
        let given = data.len();
        let array = ArrayD::from_shape_vec(&*shape, data).map_err(|_| InputError::Shape {
            what: own,
            expected: format!("1 number for each entry of shape {shape:?}"),
            given: vec![given],
        })?;
        Ok(Self(array))
    }
}

/// The tensors of an object by its keys.
pub fn read_tensors(value: &JsValue) -> Fallible<Vec<(String, ArrayD<f32>)>> {
    if !given::is_plain(value) {
        return Err(wrong_type("inputs", "an object of tensors", value));
    }
    let tensor = |key: JsValue| {
        let name = key.as_string().unwrap_or_default();
        let path = format!("inputs.{name}");
        let tensor = Reflect::get(value, &key).map_err(|_| given::throws(path.clone()))?;
        let Tensor(array) = Tensor::read(&tensor, &path)?;
        Ok((name, array))
    };
    given::keys(value, &|| "inputs".into())?.to_vec().into_iter().map(tensor).collect()
}

/// An object of tensors by their names.
pub fn tensors_object(tensors: &[(String, ArrayD<f32>)]) -> JsValue {
    carry::write(&Tensors(tensors))
}

struct Tensors<'a>(&'a [(String, ArrayD<f32>)]);

impl Serialize for Tensors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let record = |array| TensorRecord { shape: ArrayD::shape(array), data: array };
        serializer.collect_map(self.0.iter().map(|(name, array)| (name, record(array))))
    }
}

/// Numbers in C order with their shape.
#[derive(Serialize)]
struct TensorRecord<'a> {
    #[serde(serialize_with = "columns::serialize_array")]
    data: &'a ArrayD<f32>,
    shape: &'a [usize],
}
