//! Models of the repository, and small ONNX files made to order.
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex64, Direction, Random};
use boresight_formats::NpyArray;
use boresight_neural::{Card, Model};
use ndarray::{Array2, ArrayD};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

pub fn root() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Names of all models that are there.
pub fn names() -> Vec<String> {
    let files = std::fs::read_dir(root().join("models")).unwrap();
    let mut names: Vec<String> = files
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().into())
        .collect();
    names.sort();
    names
}

pub fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(root().join(format!("models/{name}.onnx"))).unwrap()
}

pub fn card(name: &str) -> Card {
    Card::from_json(&std::fs::read(root().join(format!("models/{name}.json"))).unwrap()).unwrap()
}

/// A model of the repository, loaded once for all tests: unoptimised, that takes seconds.
pub fn model(name: &str) -> &'static Model {
    static LOADED: Mutex<BTreeMap<String, &'static Model>> = Mutex::new(BTreeMap::new());
    let mut loaded = LOADED.lock().unwrap();
    loaded.entry(name.into()).or_insert_with(|| {
        Box::leak(Box::new(Model::load(&bytes(name), Some(&card(name))).unwrap()))
    })
}

/// An array of a golden batch.
pub fn golden(name: &str, port: &str) -> ArrayD<f32> {
    let path = root().join(format!("tests/golden/networks/{name}/{port}.npy"));
    let array = NpyArray::parse(&std::fs::read(path).unwrap()).unwrap();
    let numbers = array.to_f64().unwrap().into_iter().map(|x| x as f32).collect();
    ArrayD::from_shape_vec(array.shape, numbers).unwrap()
}

/// Vectors of targets at these azimuths, deg, with echoes of their own in each, 10 dB above the noise.
pub fn vectors(array: &Array, degrees: &[f64], count: usize, seed: u64) -> Array2<Complex64> {
    let random = &mut Random::new(seed, 0);
    let at: Vec<Direction> = degrees.iter().map(|d| Direction::azimuth(d.to_radians())).collect();
    let echoes = Array2::from_shape_fn((at.len(), count), |_| random.complex_normal(1.0));
    let noise = Array2::from_shape_fn((array.len(), count), |_| random.complex_normal(0.1));
    steering_matrix(array, &at).dot(&echoes) + noise
}

/// A field of a protobuf message.
pub enum Field {
    Number(u32, i64),
    Bytes(u32, Vec<u8>),
}

pub fn text(number: u32, text: &str) -> Field {
    Field::Bytes(number, text.into())
}

fn varint(mut value: u64, out: &mut Vec<u8>) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// A protobuf message.
pub fn message(fields: &[Field]) -> Vec<u8> {
    let mut out = Vec::new();
    for field in fields {
        match field {
            Field::Number(number, value) => {
                varint(u64::from(*number) << 3, &mut out);
                varint(*value as u64, &mut out);
            }
            Field::Bytes(number, bytes) => {
                varint(u64::from(*number) << 3 | 2, &mut out);
                varint(bytes.len() as u64, &mut out);
                out.extend(bytes);
            }
        }
    }
    out
}

/// A constant of 32-bit floating-point numbers.
pub fn floats(name: &str, dims: &[i64], numbers: &[f32]) -> Vec<u8> {
    let mut fields: Vec<Field> = dims.iter().map(|&dim| Field::Number(1, dim)).collect();
    fields.push(Field::Number(2, 1));
    fields.push(text(8, name));
    fields.push(Field::Bytes(9, numbers.iter().flat_map(|x| x.to_le_bytes()).collect()));
    message(&fields)
}

/// A constant of integers.
pub fn integers(name: &str, numbers: &[i64]) -> Vec<u8> {
    message(&[
        Field::Number(1, numbers.len() as i64),
        Field::Number(2, 7),
        text(8, name),
        Field::Bytes(9, numbers.iter().flat_map(|x| x.to_le_bytes()).collect()),
    ])
}

/// A node with attributes as they are encoded.
pub fn node(operator: &str, inputs: &[&str], output: &str, attributes: &[Vec<u8>]) -> Vec<u8> {
    let mut fields: Vec<Field> = inputs.iter().map(|name| text(1, name)).collect();
    fields.push(text(2, output));
    fields.push(text(3, &format!("node of {output}")));
    fields.push(text(4, operator));
    fields.extend(attributes.iter().map(|attribute| Field::Bytes(5, attribute.clone())));
    message(&fields)
}

/// An attribute that is an integer.
pub fn integer_attribute(name: &str, value: i64) -> Vec<u8> {
    message(&[text(1, name), Field::Number(20, 2), Field::Number(3, value)])
}

/// An attribute that is a tensor.
pub fn tensor_attribute(name: &str, tensor: Vec<u8>) -> Vec<u8> {
    message(&[text(1, name), Field::Number(20, 4), Field::Bytes(5, tensor)])
}

/// An input or output of a type (1 for 32-bit floating-point numbers); a negative length is the batch.
pub fn port(name: &str, element: i64, dims: &[i64]) -> Vec<u8> {
    let dims: Vec<Field> = dims
        .iter()
        .map(|&dim| match dim {
            0.. => Field::Bytes(1, message(&[Field::Number(1, dim)])),
            _ => Field::Bytes(1, message(&[text(2, "batch")])),
        })
        .collect();
    let tensor = message(&[Field::Number(1, element), Field::Bytes(2, message(&dims))]);
    message(&[text(1, name), Field::Bytes(2, message(&[Field::Bytes(1, tensor)]))])
}

/// A graph.
#[derive(Clone)]
pub struct Graph {
    pub nodes: Vec<Vec<u8>>,
    pub constants: Vec<Vec<u8>>,
    pub inputs: Vec<Vec<u8>>,
    pub outputs: Vec<Vec<u8>>,
}

impl Graph {
    /// A network of the DNN's kind: one layer of small weights and a sigmoid.
    pub fn dnn() -> Self {
        let weights: Vec<f32> =
            (0..56 * 21).map(|k| ((k * 37) % 101) as f32 * 1e-3 - 0.05).collect();
        Self {
            nodes: vec![
                node("MatMul", &["covariance", "weights"], "layer", &[]),
                node("Sigmoid", &["layer"], "probability", &[]),
            ],
            constants: vec![floats("weights", &[56, 21], &weights)],
            inputs: vec![port("covariance", 1, &[-1, 56])],
            outputs: vec![port("probability", 1, &[-1, 21])],
        }
    }

    /// The file, with operators of a set.
    pub fn file(&self, opset: i64) -> Vec<u8> {
        let part = |number: u32, all: &[Vec<u8>]| -> Vec<Field> {
            all.iter().map(|one| Field::Bytes(number, one.clone())).collect()
        };
        let mut graph = part(1, &self.nodes);
        graph.push(text(2, "graph"));
        graph.extend(part(5, &self.constants));
        graph.extend(part(11, &self.inputs));
        graph.extend(part(12, &self.outputs));
        message(&[
            Field::Number(1, 8),
            text(2, "test"),
            Field::Bytes(7, message(&graph)),
            Field::Bytes(8, message(&[Field::Number(2, opset)])),
        ])
    }
}
