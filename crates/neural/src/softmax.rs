//! Softmax along one axis, whichever it is.
//!
//! tract goes through an axis other than the last number by number, over views: the weights of AAETR's attention from
//! elements to queries, which come out transposed, took it 1.5 ms a layer. Here numbers that lie side by side along the
//! axes after it are worked on together, four at a time.

use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use tract_onnx::tract_core::ops::nn::{Softmax as Tracts, SoftmaxKind};
use wide::f32x4;

/// Softmax along one axis of a tensor in C order.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Softmax {
    shape: TVec<usize>,
    /// How many numbers the axis has.
    length: usize,
    /// How many lie side by side along the axes after it.
    beside: usize,
}

/// Replaces softmax along one axis.
pub(crate) fn soften(model: &mut TypedModel) -> TractResult<()> {
    for node in model.eval_order()? {
        let Some(own) = replacement(model, node)? else { continue };
        let input = model.node(node).inputs[0];
        let name = format!("{}.own", model.node(node).name);
        let mut patch = TypedModelPatch::default();
        let tap = patch.tap_model(model, input)?;
        let outlet = patch.wire_node(name, own, &[tap])?[0];
        patch.shunt_outside(model, OutletId::new(node, 0), outlet)?;
        patch.apply(model)?;
    }
    model.compact()
}

fn replacement(model: &TypedModel, node: usize) -> TractResult<Option<Softmax>> {
    let node = model.node(node);
    let Some(op) = node.op_as::<Tracts>() else { return Ok(None) };
    let fact = model.outlet_fact(node.inputs[0])?;
    let plain = fact.datum_type == f32::datum_type() && fact.is_plain();
    let (&[axis], Some(shape)) = (&*op.axes, fact.shape.as_concrete()) else { return Ok(None) };
    if op.kind != SoftmaxKind::Softmax || !plain {
        return Ok(None);
    }
    let beside = shape[axis + 1..].iter().product();
    Ok(Some(Softmax { shape: shape.into(), length: shape[axis], beside }))
}

impl Softmax {
    /// In place.
    fn run(&self, numbers: &mut [f32]) {
        let Self { length, beside, .. } = *self;
        if length * beside == 0 {
            return;
        }
        if beside == 1 {
            numbers.chunks_exact_mut(length).for_each(along);
            return;
        }
        let mut most = vec![0.0; beside];
        let mut sums = vec![0.0; beside];
        for block in numbers.chunks_exact_mut(length * beside) {
            most.fill(f32::NEG_INFINITY);
            for row in block.chunks_exact(beside) {
                each(&mut most, row, |most, &x| *most = if x > *most { x } else { *most });
            }
            sums.fill(0.0);
            for row in block.chunks_exact_mut(beside) {
                each(row, &most, |x, &most| *x -= most);
                exponentials(row);
                each(&mut sums, row, |sum, &x| *sum += x);
            }
            for row in block.chunks_exact_mut(beside) {
                each(row, &sums, |x, &sum| *x /= sum);
            }
        }
    }
}

/// Softmax of numbers side by side.
fn along(row: &mut [f32]) {
    let most = row.iter().fold(f32::NEG_INFINITY, |most, &x| if x > most { x } else { most });
    row.iter_mut().for_each(|x| *x -= most);
    exponentials(row);
    let share = row.iter().sum::<f32>().recip();
    row.iter_mut().for_each(|x| *x *= share);
}

fn each(own: &mut [f32], other: &[f32], change: impl Fn(&mut f32, &f32)) {
    own.iter_mut().zip(other).for_each(|(own, other)| change(own, other));
}

/// Of numbers up to zero, four at a time.
#[inline(never)]
fn exponentials(numbers: &mut [f32]) {
    let (fours, rest) = numbers.as_chunks_mut::<4>();
    for four in fours {
        *four = f32x4::new(*four).exp().to_array();
    }
    rest.iter_mut().for_each(|x| *x = x.exp());
}

impl Op for Softmax {
    fn name(&self) -> StaticName {
        "OwnSoftmax".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Softmax {
    op_out_of_plan!();

    fn eval(&self, _: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let mut tensor = args_1!(inputs).into_tensor();
        let mut view = tensor.to_plain_array_view_mut::<f32>()?;
        self.run(view.as_slice_mut().context("numbers in C order")?);
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Softmax {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(&self.shape)))
    }

    as_op!();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::tests::numbers;
    use crate::engine::tests::same_after;

    #[test]
    fn any_axis_stays_the_same() {
        for (shape, axis) in [([2, 3, 7], 2), ([2, 3, 7], 1), ([5, 3, 4], 0), ([1, 1, 1], 2)] {
            let mut model = TypedModel::default();
            let source = model.add_source("given", f32::fact(shape)).expect("a source");
            let op = Tracts { axes: tvec!(axis), ..Tracts::default() };
            let soft = model.wire_node("soft", op, &[source]).expect("a node");
            model.select_output_outlets(&soft).expect("an output");
            same_after(model, &numbers(&shape), soften, "OwnSoftmax", 1);
        }
    }

    #[test]
    fn no_size_of_the_numbers_matters() {
        for (length, beside) in [(6, 1), (6, 5)] {
            let own = Softmax { shape: tvec!(length, beside), length, beside };
            let mut given = vec![-3e38; length * beside];
            for column in 0..beside {
                given[column] = 3e38;
                given[beside + column] = 3e38;
            }
            own.run(&mut given);
            for (at, &share) in given.iter().enumerate() {
                let expected = if at < 2 * beside { 0.5 } else { 0.0 };
                assert!(share == expected, "{length} {beside} {at}: {share}");
            }
        }
    }
}
