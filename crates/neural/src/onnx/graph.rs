//! A graph's nodes: supported, each after what it needs, with sound constants.

use super::axes::{Axes, MAX_AXES};
use super::malformed;
use super::operators::{arity, size_input};
use super::tensor::{MAX_NUMBERS, check as check_tensor, integers, numbers};
use crate::error::NeuralError;
use std::collections::{HashMap, HashSet};
use tract_onnx::pb::attribute_proto::AttributeType;
use tract_onnx::pb::{
    AttributeProto, GraphProto, ModelProto, NodeProto, TensorProto, ValueInfoProto, type_proto,
};

/// Versions of the operators.
const OPSETS: std::ops::RangeInclusive<i64> = 9..=21;

/// Checks all that tract takes on trust.
pub(super) fn check(model: &ModelProto) -> Result<(), NeuralError> {
    let own = |domain: &str| domain.is_empty() || domain == "ai.onnx";
    let opset = model.opset_import.iter().find(|set| own(&set.domain)).map(|set| set.version);
    let Some(graph) = &model.graph else {
        return Err(malformed("model", "a graph", "none"));
    };
    match opset {
        Some(version) if OPSETS.contains(&version) => {}
        _ => {
            let expected = format!("operator set {} to {}", OPSETS.start(), OPSETS.end());
            let given = opset.map_or("none".into(), |version| version.to_string());
            return Err(malformed("operator set", expected, given));
        }
    }
    if !model.functions.is_empty() {
        return Err(malformed("model", "a graph of operators alone", "functions"));
    }
    for node in &graph.node {
        if !own(&node.domain) {
            let name = format!("{}.{}", node.domain, node.op_type);
            return Err(NeuralError::UnsupportedOperator { name });
        }
        if arity(&node.op_type).is_none() {
            return Err(NeuralError::UnsupportedOperator { name: node.op_type.clone() });
        }
    }
    Checked::default().graph(graph)
}

#[derive(Default)]
struct Checked<'a> {
    defined: HashSet<&'a str>,
    constants: HashMap<&'a str, &'a TensorProto>,
    axes: Axes<'a>,
}

impl<'a> Checked<'a> {
    fn graph(&mut self, graph: &'a GraphProto) -> Result<(), NeuralError> {
        if !graph.sparse_initializer.is_empty() {
            return Err(malformed("graph", "dense constants", "sparse ones"));
        }
        for tensor in &graph.initializer {
            check_tensor(tensor, &tensor.name)?;
            self.define(&tensor.name)?;
            self.constants.insert(&tensor.name, tensor);
            self.axes.insert(&tensor.name, tensor.dims.len());
        }
        for input in &graph.input {
            if !self.constants.contains_key(input.name.as_str()) {
                self.define(&input.name)?;
                if let Some(axes) = axes_of(input) {
                    self.axes.insert(&input.name, axes);
                }
            }
        }
        for node in &graph.node {
            self.node(node)?;
        }
        if graph.output.is_empty() {
            return Err(malformed("graph", "an output", "none"));
        }
        for output in &graph.output {
            self.known(&output.name)?;
        }
        Ok(())
    }

    fn node(&mut self, node: &'a NodeProto) -> Result<(), NeuralError> {
        let what = || format!("node {:?} ({})", node.name, node.op_type);
        let Some(arity) = arity(&node.op_type) else {
            return Err(NeuralError::UnsupportedOperator { name: node.op_type.clone() });
        };
        let [fewest, most] = arity.inputs;
        let needed = node.input.iter().take(fewest).filter(|name| !name.is_empty()).count();
        if needed < fewest || node.input.len() > most {
            let given = format!("{} inputs", node.input.len());
            return Err(malformed(what(), format!("{fewest} inputs or more, all named"), given));
        }
        let outputs = node.output.len();
        if outputs == 0 || outputs > arity.outputs || node.output.iter().any(String::is_empty) {
            let given = format!("{outputs}");
            return Err(malformed(what(), "outputs with names, as many as it has", given));
        }
        for name in node.input.iter().filter(|name| !name.is_empty()) {
            self.known(name)?;
        }
        for attribute in &node.attribute {
            check_attribute(node, attribute)?;
        }
        self.size(node)?;
        self.parts(node)?;
        for name in &node.output {
            self.define(name)?;
        }
        if let ("Constant", Some(tensor)) = (node.op_type.as_str(), value(node)) {
            self.constants.insert(&node.output[0], tensor);
        }
        self.axes.node(node, &self.constants)
    }

    /// Where a constant sets the size of an output, checks that it can be held.
    fn size(&self, node: &NodeProto) -> Result<(), NeuralError> {
        let constant = size_input(&node.op_type)
            .and_then(|input| node.input.get(input))
            .and_then(|name| self.constants.get(name.as_str()));
        let Some(shape) = constant.map(|tensor| integers(tensor)) else {
            return Ok(());
        };
        let negative = shape.iter().any(|&length| length < 0);
        if negative && matches!(node.op_type.as_str(), "ConstantOfShape" | "Expand" | "Tile") {
            let what = format!("size of the output of {:?} ({})", node.name, node.op_type);
            return Err(malformed(what, "lengths of axes", format!("{shape:?}")));
        }
        let lengths = shape.iter().map(|&length| length.checked_abs().unwrap_or(i64::MAX).max(1));
        if numbers(lengths).is_none() || shape.len() > 2 * MAX_AXES {
            let what = format!("size of the output of {:?} ({})", node.name, node.op_type);
            return Err(malformed(what, format!("at most {MAX_NUMBERS} numbers"), "more"));
        }
        Ok(())
    }

    /// Checks sizes of parts and steps: none may be zero.
    fn parts(&self, node: &NodeProto) -> Result<(), NeuralError> {
        let given = match node.op_type.as_str() {
            "Split" => node.input.get(1),
            "Slice" => node.input.get(4),
            _ => return Ok(()),
        };
        let listed =
            node.attribute.iter().filter(|a| a.name == "split").flat_map(|a| a.ints.clone());
        let constant = given.and_then(|name| self.constants.get(name.as_str()));
        let mut numbers = constant.map(|tensor| integers(tensor)).unwrap_or_default();
        let missing = given.is_some_and(|name| !name.is_empty()) && numbers.is_empty();
        numbers.extend(listed);
        let splits = node.op_type == "Split";
        if missing || numbers.iter().any(|&n| n == 0 || (splits && n < 0)) {
            let what = format!("sizes or steps of {:?} ({})", node.name, node.op_type);
            return Err(malformed(
                what,
                "constant integers other than zero",
                format!("{numbers:?}"),
            ));
        }
        Ok(())
    }

    fn define(&mut self, name: &'a str) -> Result<(), NeuralError> {
        if !self.defined.insert(name) {
            return Err(malformed(format!("value {name:?}"), "one definition", "several"));
        }
        Ok(())
    }

    fn known(&self, name: &str) -> Result<(), NeuralError> {
        if !self.defined.contains(name) {
            let expected = "a value defined before it is used";
            return Err(malformed(format!("value {name:?}"), expected, "none"));
        }
        Ok(())
    }
}

/// The number of axes an input is stated to have.
fn axes_of(input: &ValueInfoProto) -> Option<usize> {
    let type_proto::Value::TensorType(tensor) = input.r#type.as_ref()?.value.as_ref()?;
    Some(tensor.shape.as_ref()?.dim.len())
}

/// The tensor of a constant.
fn value(node: &NodeProto) -> Option<&TensorProto> {
    node.attribute.iter().find(|a| a.name == "value").and_then(|a| a.t.as_ref())
}

fn check_attribute(node: &NodeProto, attribute: &AttributeProto) -> Result<(), NeuralError> {
    let what =
        || format!("attribute {:?} of node {:?} ({})", attribute.name, node.name, node.op_type);
    let plain = attribute.g.is_none()
        && attribute.graphs.is_empty()
        && attribute.tensors.is_empty()
        && attribute.sparse_tensor.is_none()
        && attribute.sparse_tensors.is_empty()
        && attribute.ref_attr_name.is_empty();
    if !plain {
        return Err(malformed(what(), "numbers, text or one tensor", "another thing"));
    }
    if let Some(tensor) = &attribute.t {
        check_tensor(tensor, &attribute.name)?;
    }
    let kind = AttributeType::try_from(attribute.r#type);
    if (kind == Ok(AttributeType::Tensor)) != attribute.t.is_some() {
        return Err(malformed(what(), "a tensor where its type says so", "none, or one too many"));
    }
    if attribute.f.is_nan() || attribute.floats.iter().any(|x| x.is_nan()) {
        return Err(NeuralError::NotFinite { what: what(), given: f32::NAN });
    }
    Ok(())
}
