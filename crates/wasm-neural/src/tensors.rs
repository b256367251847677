//! Named tensors in and out.

use boresight_core::CoreError;
use boresight_core::describe::columns;
use boresight_wasm::carry;
use boresight_wasm::error::Fallible;
use boresight_wasm::read::{Fields, Read, wrong_type};
use js_sys::{Array, Float32Array, Object, Reflect};
use ndarray::ArrayD;
use serde::{Serialize, Serializer};
use wasm_bindgen::{JsCast, JsValue};

/// Numbers in C order with their shape.
struct Tensor(ArrayD<f32>);

impl Read for Tensor {
    const EXPECTED: &'static str = "{ data: Float32Array, shape }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let data = fields.raw("data")?.unwrap_or(JsValue::UNDEFINED);
        let data = data
            .dyn_ref::<Float32Array>()
            .ok_or_else(|| wrong_type(&format!("{path}.data"), "a Float32Array", &data))?
            .to_vec();
        let shape: Vec<usize> = fields.required("shape")?;
        fields.finish()?;
        let given = data.len();
        let array = ArrayD::from_shape_vec(&*shape, data).map_err(|_| CoreError::Shape {
            what: format!("{path}.data"),
            expected: format!("1 number for each entry of shape {shape:?}"),
            given: vec![given],
        })?;
        Ok(Self(array))
    }
}

/// The tensors of an object by its keys.
pub fn read_tensors(value: &JsValue) -> Fallible<Vec<(String, ArrayD<f32>)>> {
    if !value.is_object() || Array::is_array(value) {
        return Err(wrong_type("inputs", "an object of tensors", value));
    }
    let object: &Object = value.unchecked_ref();
    Object::entries(object)
        .iter()
        .map(|entry| {
            let name = Reflect::get_u32(&entry, 0).ok().and_then(|name| name.as_string());
            let name = name.unwrap_or_default();
            let tensor = Reflect::get_u32(&entry, 1).unwrap_or(JsValue::UNDEFINED);
            let Tensor(array) = Tensor::read(&tensor, &format!("inputs.{name}"))?;
            Ok((name, array))
        })
        .collect()
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
