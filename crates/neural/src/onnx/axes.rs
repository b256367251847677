//! Numbers of axes, and that operators name axes their inputs have.

use super::malformed;
use super::operators::fewest_axes;
use super::tensor::integers;
use crate::error::NeuralError;
use std::collections::HashMap;
use tract_onnx::pb::{AttributeProto, NodeProto, TensorProto};

/// Most axes of a tensor.
pub(super) const MAX_AXES: usize = 8;

/// Longest window, step or padding.
const MAX_WINDOW: i64 = 1 << 12;

/// Numbers of axes of the values so far; what depends on data is left out.
#[derive(Default)]
pub(super) struct Axes<'a> {
    known: HashMap<&'a str, usize>,
}

impl<'a> Axes<'a> {
    /// Takes note of a value.
    pub fn insert(&mut self, name: &'a str, axes: usize) {
        self.known.insert(name, axes);
    }

    /// Checks the axes a node names and takes note of its outputs.
    pub fn node(
        &mut self,
        node: &'a NodeProto,
        constants: &HashMap<&str, &TensorProto>,
    ) -> Result<(), NeuralError> {
        let named = named_axes(node, constants);
        let first = self.of(node, 0);
        if let Some(axes) = first {
            self.shaped(node, axes)?;
            let most = match node.op_type.as_str() {
                "Flatten" => axes + 1,
                "Unsqueeze" => axes + named.as_ref().map_or(0, Vec::len),
                _ => axes,
            };
            self.check(node, named.as_deref().unwrap_or_default(), axes, most)?;
        }
        if let Some(axes) = self.output(node, named.as_deref(), constants) {
            if axes > MAX_AXES {
                let what = format!("output of {:?} ({})", node.name, node.op_type);
                return Err(malformed(what, format!("at most {MAX_AXES} axes"), axes.to_string()));
            }
            for name in &node.output {
                self.known.insert(name, axes);
            }
        }
        Ok(())
    }

    /// Checks that the first inputs have axes enough, and that windows have as many.
    fn shaped(&self, node: &NodeProto, axes: usize) -> Result<(), NeuralError> {
        let what = || format!("inputs of {:?} ({})", node.name, node.op_type);
        let fewest = fewest_axes(&node.op_type);
        let second = self.of(node, 1).filter(|_| node.op_type == "MatMul");
        if axes < fewest || second.is_some_and(|axes| axes < fewest) {
            let expected = format!("at least {fewest} axes");
            return Err(malformed(what(), expected, axes.to_string()));
        }
        if fewest < 3 {
            return Ok(());
        }
        let kernel = self.of(node, 1).filter(|_| node.op_type.starts_with("Conv"));
        let windows =
            [("kernel_shape", 1, 1), ("strides", 1, 1), ("dilations", 1, 1), ("pads", 2, 0)];
        let fits = windows.iter().all(|&(name, times, least)| {
            attribute(node, name).is_none_or(|window| {
                window.ints.len() == times * (axes - 2)
                    && window.ints.iter().all(|length| (least..=MAX_WINDOW).contains(length))
            })
        });
        let groups = attribute(node, "group").is_none_or(|g| (1..=MAX_WINDOW).contains(&g.i));
        if fits && groups && kernel.is_none_or(|kernel| kernel == axes) {
            return Ok(());
        }
        let expected =
            format!("windows, steps and padding along {} axes, up to {MAX_WINDOW}", axes - 2);
        Err(malformed(what(), expected, "others"))
    }

    fn check(
        &self,
        node: &NodeProto,
        named: &[i64],
        axes: usize,
        most: usize,
    ) -> Result<(), NeuralError> {
        let permutes = node.op_type == "Transpose";
        let within = |&axis: &i64| {
            // What is not there yet is counted with what will be, but by Flatten.
            let from = if node.op_type == "Flatten" { axes } else { most };
            let axis = if axis < 0 && !permutes { axis.saturating_add(from as i64) } else { axis };
            usize::try_from(axis).ok().filter(|&axis| axis < most)
        };
        let mut seen: Vec<usize> = named.iter().filter_map(within).collect();
        let all_within = seen.len() == named.len();
        seen.sort_unstable();
        seen.dedup();
        let whole = !permutes || named.is_empty() || seen.len() == most;
        if all_within && whole && seen.len() == named.len() {
            return Ok(());
        }
        let what = format!("axes named by {:?} ({})", node.name, node.op_type);
        Err(malformed(what, format!("different ones of {most}"), format!("{named:?}")))
    }

    fn of(&self, node: &NodeProto, input: usize) -> Option<usize> {
        self.known.get(node.input.get(input)?.as_str()).copied()
    }

    fn output(
        &self,
        node: &NodeProto,
        named: Option<&[i64]>,
        constants: &HashMap<&str, &TensorProto>,
    ) -> Option<usize> {
        let first = self.of(node, 0);
        let length = |input: usize| {
            let tensor = constants.get(node.input.get(input)?.as_str())?;
            Some(integers(tensor).len())
        };
        let broadcast = || {
            let all = (0..node.input.len()).map(|input| self.of(node, input));
            all.collect::<Option<Vec<usize>>>()?.into_iter().max()
        };
        let keeps = attribute(node, "keepdims").is_none_or(|keep| keep.i != 0);
        match node.op_type.as_str() {
            "Constant" => constants.get(node.output.first()?.as_str()).map(|t| t.dims.len()),
            "Shape" => Some(1),
            "Size" => Some(0),
            "Flatten" | "Gemm" => Some(2),
            "Reshape" => length(1),
            "ConstantOfShape" => length(0),
            "Expand" => Some(first?.max(length(1)?)),
            "Add" | "And" | "Div" | "Equal" | "Greater" | "GreaterOrEqual" | "Less"
            | "LessOrEqual" | "Mod" | "Mul" | "Or" | "PRelu" | "Pow" | "Sub" | "Xor" | "Where"
            | "Max" | "Min" | "Mean" | "Sum" => broadcast(),
            "MatMul" => {
                let (a, b) = (first?, self.of(node, 1)?);
                (a >= 2 && b >= 2).then_some(a.max(b))
            }
            "Gather" => (first? + self.of(node, 1)?).checked_sub(1),
            "Einsum" => None,
            "Squeeze" => first?.checked_sub(named?.len()),
            "Unsqueeze" => Some(first? + named?.len()),
            name if name.starts_with("Reduce") && !keeps => {
                first?.checked_sub(named.map_or(first?, <[i64]>::len))
            }
            "ArgMax" | "ArgMin" if !keeps => first?.checked_sub(1),
            _ => first,
        }
    }
}

/// The axes a node names, in an attribute or in a constant.
fn named_axes(node: &NodeProto, constants: &HashMap<&str, &TensorProto>) -> Option<Vec<i64>> {
    let operator = node.op_type.as_str();
    let input = match operator {
        "Squeeze" | "Unsqueeze" => Some(1),
        "Slice" => Some(3),
        "CumSum" => Some(1),
        name if name.starts_with("Reduce") => Some(1),
        _ => None,
    };
    let list = |name| attribute(node, name).map(|axes| axes.ints.clone());
    match operator {
        "Transpose" => list("perm"),
        "Concat" | "Gather" | "Split" | "Softmax" | "LogSoftmax" | "ArgMax" | "ArgMin"
        | "LpNormalization" | "LayerNormalization" | "TopK" | "Flatten" | "ScatterElements" => {
            attribute(node, "axis").map(|axis| vec![axis.i])
        }
        _ => list("axes").or_else(|| {
            let tensor = constants.get(node.input.get(input?)?.as_str())?;
            Some(integers(tensor))
        }),
    }
}

fn attribute<'n>(node: &'n NodeProto, name: &str) -> Option<&'n AttributeProto> {
    node.attribute.iter().find(|attribute| attribute.name == name)
}
