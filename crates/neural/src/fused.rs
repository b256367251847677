//! Trees of elementwise operators as one.
//!
//! tract runs each elementwise operator by itself, over tensors in memory, and number by number where shapes are
//! broadcast. Here a tree of them, each used by the next alone, becomes one operator that goes through its output once,
//! tile by tile, so that all between stays in the first cache.

use crate::function::{Function, Operand};
use std::mem::take;
use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use tract_onnx::tract_core::ops::binary::{OptBinByScalar, OptBinUnicast, TypedBinOp};
use tract_onnx::tract_core::ops::element_wise::ElementWiseOp;

/// Numbers worked on at a time.
const TILE: usize = 256;

/// Most operators in a tree.
const MOST: usize = 64;

/// Where a step finds a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Input(usize),
    Step(usize),
}

/// One operator of a tree.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Step {
    function: Function,
    /// The second is that of functions of two numbers; else the same as the first.
    places: [Place; 2],
}

/// A tree of elementwise operators on inputs broadcast to one shape.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Fused {
    steps: Vec<Step>,
    shape: TVec<usize>,
    /// The shape with axes joined that all inputs run through alike; the last is the inner loop.
    axes: Vec<usize>,
    /// For each input its step along each of these axes, 0 where it is broadcast.
    strides: Vec<Vec<usize>>,
}

/// Replaces trees of elementwise operators, single ones included.
pub(crate) fn fuse(model: &mut TypedModel) -> TractResult<()> {
    let order = model.eval_order()?;
    let mut gone = vec![false; model.nodes.len()];
    for &root in order.iter().rev() {
        if gone[root] || function(model, root).is_none() {
            continue;
        }
        let mut inputs = Vec::new();
        let mut members = Vec::new();
        let mut steps = Vec::new();
        collect(model, root, &mut inputs, &mut steps, &mut members);
        for member in members {
            gone[member] = true;
        }
        let shape = concrete(model, OutletId::new(root, 0)).unwrap_or_default();
        let shapes: Vec<TVec<usize>> =
            inputs.iter().map(|&outlet| concrete(model, outlet).unwrap_or_default()).collect();
        let fused = Fused::new(steps, shape, &shapes);
        let name = model.node(root).name.clone();
        let mut patch = TypedModelPatch::default();
        let taps = patch.taps(model, &inputs)?;
        let outlet = patch.wire_node(format!("{name}.fused"), fused, &taps)?[0];
        patch.shunt_outside(model, OutletId::new(root, 0), outlet)?;
        patch.apply(model)?;
        gone.resize(model.nodes.len(), true);
    }
    model.compact()
}

/// Adds the tree under a node to the steps and returns the place of its result.
fn collect(
    model: &TypedModel,
    node: usize,
    inputs: &mut Vec<OutletId>,
    steps: &mut Vec<Step>,
    members: &mut Vec<usize>,
) -> Place {
    members.push(node);
    let mut places = Vec::with_capacity(2);
    for &outlet in &model.node(node).inputs {
        let place = if members.len() < MOST && belongs(model, outlet, node) {
            collect(model, outlet.node, inputs, steps, members)
        } else {
            let at = inputs.iter().position(|&known| known == outlet);
            Place::Input(at.unwrap_or_else(|| {
                inputs.push(outlet);
                inputs.len() - 1
            }))
        };
        places.push(place);
    }
    let first = places[0];
    let second = places.get(1).copied().unwrap_or(first);
    if let Some(function) = function(model, node) {
        steps.push(Step { function, places: [first, second] });
    }
    Place::Step(steps.len() - 1)
}

/// Whether what makes an outlet can become part of the tree of its user.
fn belongs(model: &TypedModel, outlet: OutletId, user: usize) -> bool {
    let node = model.node(outlet.node);
    let users = &node.outputs[outlet.slot].successors;
    function(model, outlet.node).is_some()
        && users.len() == 1
        && !model.outputs.contains(&outlet)
        && concrete(model, outlet) == concrete(model, OutletId::new(user, 0))
}

/// The shape of an outlet of 32-bit floating-point numbers.
fn concrete(model: &TypedModel, outlet: OutletId) -> Option<TVec<usize>> {
    let fact = model.outlet_fact(outlet).ok()?;
    let shape = fact.shape.as_concrete()?;
    (fact.datum_type == f32::datum_type() && fact.is_plain()).then(|| shape.into())
}

/// The function of a node, if it is elementwise and all around it is as it should be.
fn function(model: &TypedModel, node: usize) -> Option<Function> {
    let node = model.node(node);
    let output = concrete(model, OutletId::new(node.id, 0))?;
    let fits = node.inputs.iter().all(|&outlet| {
        concrete(model, outlet).is_some_and(|shape| {
            shape.len() == output.len()
                && shape.iter().zip(&output).all(|(&length, &whole)| length == whole || length == 1)
        })
    });
    if !fits || output.is_empty() {
        return None;
    }
    if let Some(op) = node.op_as::<ElementWiseOp>() {
        return Function::of_one(&*op.0);
    }
    let op = match (
        node.op_as::<TypedBinOp>(),
        node.op_as::<OptBinByScalar>(),
        node.op_as::<OptBinUnicast>(),
    ) {
        (Some(op), _, _) => &op.0,
        (_, Some(op), _) => &op.binop,
        (_, _, Some(op)) => &op.binop,
        _ => return None,
    };
    Function::of_two(&**op)
}

impl Fused {
    fn new(steps: Vec<Step>, shape: TVec<usize>, inputs: &[TVec<usize>]) -> Self {
        let mut strides: Vec<Vec<usize>> = inputs
            .iter()
            .map(|input| {
                let mut step = 1;
                let mut strides: Vec<usize> = input
                    .iter()
                    .rev()
                    .map(|&length| {
                        let stride = if length == 1 { 0 } else { step };
                        step *= length;
                        stride
                    })
                    .collect();
                strides.reverse();
                strides
            })
            .collect();
        let mut axes: Vec<usize> = shape.to_vec();
        // Axes of length 1 say nothing, and two join where every input runs through them as through one.
        for at in (0..axes.len()).rev() {
            if axes[at] == 1 && axes.len() > 1 {
                axes.remove(at);
                strides.iter_mut().for_each(|own| {
                    own.remove(at);
                });
            }
        }
        for at in (1..axes.len()).rev() {
            if strides.iter().all(|own| own[at - 1] == own[at] * axes[at]) {
                axes[at - 1] *= axes.remove(at);
                strides.iter_mut().for_each(|own| {
                    own.remove(at - 1);
                });
            }
        }
        Self { steps, shape, axes, strides }
    }

    /// Calls `work` with the first number of each input and of the output, for every run along the last axis.
    fn each_run(
        &self,
        mut work: impl FnMut(&[usize], usize) -> TractResult<()>,
    ) -> TractResult<()> {
        let outer = self.axes.len() - 1;
        let length = self.axes[outer];
        let runs: usize = self.axes[..outer].iter().product();
        let mut index = vec![0; outer];
        let mut offsets = vec![0; self.strides.len()];
        for run in 0..runs {
            work(&offsets, run * length)?;
            for axis in (0..outer).rev() {
                index[axis] += 1;
                let back = index[axis] == self.axes[axis];
                for (offset, strides) in offsets.iter_mut().zip(&self.strides) {
                    *offset += strides[axis];
                    if back {
                        *offset -= strides[axis] * self.axes[axis];
                    }
                }
                if !back {
                    break;
                }
                index[axis] = 0;
            }
        }
        Ok(())
    }
}

impl Op for Fused {
    fn name(&self) -> StaticName {
        "Fused".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Fused {
    op_out_of_plan!();

    fn eval(&self, _: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let views: Vec<_> = inputs
            .iter()
            .map(|input| input.to_plain_array_view::<f32>())
            .collect::<TractResult<_>>()?;
        let slices: Vec<&[f32]> = views
            .iter()
            .map(|view| view.as_slice().context("an input in C order"))
            .collect::<TractResult<_>>()?;
        let mut tensor = Tensor::zero::<f32>(&self.shape)?;
        let mut view = tensor.to_plain_array_view_mut::<f32>()?;
        let output = view.as_slice_mut().context("an output in C order")?;
        let inner = self.axes.len() - 1;
        let length = self.axes[inner];
        let mut registers: Vec<Vec<f32>> = vec![vec![0.0; TILE.min(length)]; self.steps.len()];
        self.each_run(|offsets, start| {
            for from in (0..length).step_by(TILE) {
                let count = TILE.min(length - from);
                for (at, step) in self.steps.iter().enumerate() {
                    let last = at + 1 == self.steps.len();
                    let mut own = take(&mut registers[at]);
                    let operand = |place: Place| match place {
                        Place::Step(step) => Operand::Many(&registers[step][..count]),
                        Place::Input(input) if self.strides[input][inner] == 0 => {
                            Operand::One(slices[input][offsets[input]])
                        }
                        Place::Input(input) => {
                            let first = offsets[input] + from;
                            Operand::Many(&slices[input][first..first + count])
                        }
                    };
                    let (a, b) = (operand(step.places[0]), operand(step.places[1]));
                    let out = if last {
                        &mut output[start + from..start + from + count]
                    } else {
                        &mut own[..count]
                    };
                    step.function.run(a, b, out);
                    registers[at] = own;
                }
            }
            Ok(())
        })?;
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Fused {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(&self.shape)))
    }

    as_op!();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::tests::same_after;
    use tract_onnx::tract_core::ops::math;

    fn numbers(shape: &[usize]) -> Tensor {
        let count: usize = shape.iter().product();
        let numbers: Vec<f32> =
            (0..count).map(|i| 0.1 + ((i * i) as f32 * 0.37).sin().abs()).collect();
        Tensor::from_shape(shape, &numbers).expect("as many numbers as the shape has")
    }

    #[test]
    fn trees_stay_the_same() {
        // The other operand of each step is broadcast in every way, and long enough for two tiles.
        for (shape, other) in [
            ([2, 3, 300], [2, 3, 300]),
            ([2, 3, 300], [1, 1, 300]),
            ([2, 3, 5], [2, 3, 1]),
            ([2, 3, 5], [2, 1, 5]),
            ([2, 3, 5], [1, 3, 1]),
            ([4, 1, 1], [1, 1, 1]),
        ] {
            let mut model = TypedModel::default();
            let source = model.add_source("given", f32::fact(shape)).expect("a source");
            let constant = model.add_const("other", numbers(&other)).expect("a constant");
            let mut wire = |name: &str, op: Box<dyn TypedOp>, inputs: &[OutletId]| {
                model.wire_node(name, op, inputs).expect("a node")[0]
            };
            let sum = wire("sum", Box::new(math::add()), &[source, constant]);
            let root = wire("root", Box::new(math::sqrt()), &[sum]);
            let share = wire("share", Box::new(math::div()), &[root, constant]);
            let square = wire("square", Box::new(math::square()), &[share]);
            let less = wire("less", Box::new(math::sub()), &[constant, square]);
            let least = wire("least", Box::new(math::min()), &[less, source]);
            model.select_output_outlets(&[least]).expect("an output");
            same_after(model, &numbers(&shape), fuse, "Fused", 1);
        }
    }

    #[test]
    fn what_is_used_twice_is_kept() {
        let mut model = TypedModel::default();
        let source = model.add_source("given", f32::fact([3, 4])).expect("a source");
        let square = model.wire_node("square", math::square(), &[source]).expect("a node")[0];
        let root = model.wire_node("root", math::sqrt(), &[square]).expect("a node")[0];
        let sum = model.wire_node("sum", math::add(), &[square, root]).expect("a node")[0];
        model.select_output_outlets(&[sum, square]).expect("outputs");
        same_after(model, &numbers(&[3, 4]), fuse, "Fused", 2);
    }
}
