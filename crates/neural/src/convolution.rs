//! Convolutions as products with constant matrices.
//!
//! A row is what the kernel covers at one place; all rows are read where they lie in the input. tract copies those of
//! kernels over three axes number by number.

use crate::dense::{Dense, steps};
use crate::line::Line;
use crate::product::Run;
use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::TypedOp;
use tract_onnx::tract_core::ops::array::{Pad, PadMode};
use tract_onnx::tract_core::ops::cnn::{Conv, KernelFormat};
use tract_onnx::tract_core::ops::math::add;
use tract_onnx::tract_core::ops::nn::DataFormat;

/// Replaces convolutions with constant kernels.
pub(crate) fn unroll(model: &mut TypedModel) -> TractResult<()> {
    for node in model.eval_order()? {
        let Some(Convolution { pads, product, bias }) = convolution(model, node)? else { continue };
        let (name, input) = (model.node(node).name.clone(), model.node(node).inputs[0]);
        let mut patch = TypedModelPatch::default();
        let mut outlet = patch.tap_model(model, input)?;
        if pads.iter().any(|&pad| pad != (0, 0)) {
            let pad = Pad { pads, mode: PadMode::Constant(Arc::new(0.0_f32.into())) };
            outlet = patch.wire_node(format!("{name}.pad"), pad, &[outlet])?[0];
        }
        outlet = patch.wire_node(format!("{name}.product"), product, &[outlet])?[0];
        if let Some(bias) = bias {
            let bias = patch.add_const(format!("{name}.bias"), bias)?;
            outlet = patch.wire_node(format!("{name}.biased"), add(), &[outlet, bias])?[0];
        }
        patch.shunt_outside(model, OutletId::new(node, 0), outlet)?;
        patch.apply(model)?;
    }
    model.compact()
}

struct Convolution {
    /// Zeros before and after each axis of the input.
    pads: Vec<(usize, usize)>,
    product: Box<dyn TypedOp>,
    /// In the shape that the output is added to; `None` if there is nothing to add.
    bias: Option<Tensor>,
}

fn convolution(model: &TypedModel, node: usize) -> TractResult<Option<Convolution>> {
    let node = model.node(node);
    let Some(op) = node.op_as::<Conv>() else { return Ok(None) };
    let (inputs, outputs) = model.node_facts(node.id)?;
    let plain = |fact: &&TypedFact| fact.datum_type == f32::datum_type() && fact.is_plain();
    let [given, kernel, bias] = inputs[..] else { return Ok(None) };
    if op.group != 1 || op.q_params.is_some() || !inputs.iter().chain(&outputs).all(plain) {
        return Ok(None);
    }
    let (Some(kernel), Some(bias), Some(given), Some(output)) =
        (&kernel.konst, &bias.konst, given.shape.as_concrete(), outputs[0].shape.as_concrete())
    else {
        return Ok(None);
    };
    let spec = &op.pool_spec;
    let (from, to) = (spec.data_format.shape(given)?, spec.data_format.shape(output)?);
    let space: Vec<usize> = from.hw_axes().collect();
    let mut pads = vec![(0, 0); given.len()];
    let mut padded = given.to_vec();
    for (&axis, pad) in space.iter().zip(spec.computed_padding(from.hw_dims())) {
        pads[axis] = (pad.pad_before, pad.pad_after);
        padded[axis] += pad.pad_before + pad.pad_after;
    }
    if let Some(line) = line(op, kernel, bias, &padded, output)? {
        return Ok(Some(Convolution { pads, product: line.into(), bias: None }));
    }
    let (of_given, of_output, of_kernel) = (steps(&padded), steps(output), steps(kernel.shape()));
    let last = kernel.rank() - 1;
    let (out, into) = match op.kernel_fmt {
        KernelFormat::OIHW => (0, 1),
        KernelFormat::HWIO => (last, last - 1),
        KernelFormat::OHWI => (0, last),
    };
    let (channel, kernel_space) = (from.c_axis(), op.kernel_fmt.h_axis());
    let mut inner: Vec<Run> = space
        .iter()
        .enumerate()
        .map(|(at, &axis)| Run {
            length: kernel.shape()[kernel_space + at],
            steps: [spec.dilation(at) * of_given[axis], of_kernel[kernel_space + at]],
        })
        .collect();
    inner.push(Run { length: given[channel], steps: [of_given[channel], of_kernel[into]] });
    // What lies together in the input is read together.
    inner.sort_by_key(|run| std::cmp::Reverse(run.steps[0]));
    let columns =
        [Run { length: output[to.c_axis()], steps: [of_output[to.c_axis()], of_kernel[out]] }];
    let mut rows: Vec<Run> = from
        .n_axis()
        .map(|axis| Run { length: given[axis], steps: [of_given[axis], of_output[axis]] })
        .into_iter()
        .collect();
    rows.extend(space.iter().enumerate().map(|(at, &axis)| Run {
        length: output[axis],
        steps: [spec.stride(at) * of_given[axis], of_output[axis]],
    }));
    let Some(dense) = Dense::new(kernel, [&inner, &columns, &rows], output)? else {
        return Ok(None);
    };
    let bias = bias.cast_to::<f32>()?.into_owned();
    let zero = bias.to_plain_array_view::<f32>()?.iter().all(|&number| number == 0.0);
    let mut shape = vec![1; output.len()];
    shape[to.c_axis()] = bias.len();
    let bias = if zero { None } else { Some(bias.into_shape(&shape)?) };
    Ok(Some(Convolution { pads, product: dense.into(), bias }))
}

/// The convolution as one along a line, if it is one.
fn line(
    op: &Conv,
    kernel: &Tensor,
    bias: &Tensor,
    padded: &[usize],
    output: &[usize],
) -> TractResult<Option<Line>> {
    let spec = &op.pool_spec;
    let (Ok(padded), Ok(output)) = (padded.try_into(), output.try_into()) else { return Ok(None) };
    let plain = spec.data_format == DataFormat::NCHW && op.kernel_fmt == KernelFormat::OIHW;
    if !plain || spec.stride(0) != 1 {
        return Ok(None);
    }
    let (kernel, bias) = (kernel.cast_to::<f32>()?, bias.cast_to::<f32>()?);
    let (kernel, bias) = (kernel.to_plain_array_view::<f32>()?, bias.to_plain_array_view::<f32>()?);
    let (Some(kernel), Some(bias)) = (kernel.as_slice(), bias.as_slice()) else { return Ok(None) };
    Ok(Line::new(kernel, bias, spec.dilation(0), padded, output))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::tests::numbers;
    use crate::engine::tests::same_after;
    use tract_onnx::tract_core::ops::cnn::{PaddingSpec, PoolSpec};
    use tract_onnx::tract_core::ops::nn::DataFormat;

    /// Shapes of input and kernel with their formats, padding, dilations, strides, length of the bias.
    type Case = (
        &'static [usize],
        DataFormat,
        &'static [usize],
        KernelFormat,
        PaddingSpec,
        &'static [usize],
        &'static [usize],
        usize,
    );

    #[test]
    fn convolutions_stay_the_same() {
        use DataFormat::{NCHW, NHWC};
        use KernelFormat::{HWIO, OHWI, OIHW};
        let explicit =
            |before: &[usize], after: &[usize]| PaddingSpec::Explicit(before.into(), after.into());
        let cases: [Case; 7] = [
            (
                &[2, 3, 9, 6, 4],
                NCHW,
                &[10, 3, 5, 4, 2],
                OIHW,
                PaddingSpec::Valid,
                &[1; 3],
                &[1; 3],
                10,
            ),
            (&[3, 7, 11], NCHW, &[7, 7, 3], OIHW, explicit(&[1], &[1]), &[1], &[1], 7),
            (&[2, 5, 29], NCHW, &[6, 5, 4], OIHW, PaddingSpec::Valid, &[3], &[1], 1),
            (&[2, 5, 29], NCHW, &[6, 5, 4], OIHW, PaddingSpec::Valid, &[1], &[2], 6),
            (&[2, 9, 5, 3], NHWC, &[3, 2, 3, 9], HWIO, PaddingSpec::Valid, &[2, 1], &[1, 2], 9),
            (&[1, 8, 6, 4], NHWC, &[5, 3, 3, 4], OHWI, PaddingSpec::SameUpper, &[1; 2], &[2, 1], 1),
            (
                &[2, 4, 7, 5],
                NCHW,
                &[6, 4, 2, 2],
                OIHW,
                explicit(&[1, 0], &[0, 2]),
                &[1; 2],
                &[1; 2],
                6,
            ),
        ];
        for (given, format, kernel, kernel_fmt, padding, dilations, strides, bias) in cases {
            let rank = kernel.len();
            let (out, into) = match kernel_fmt {
                OIHW => (0, 1),
                HWIO => (rank - 1, rank - 2),
                OHWI => (0, rank - 1),
            };
            let pool_spec = PoolSpec {
                data_format: format,
                kernel_shape: kernel_fmt.spatial_shape(kernel).into(),
                padding,
                dilations: Some(dilations.into()),
                strides: Some(strides.into()),
                input_channels: kernel[into],
                output_channels: kernel[out],
            };
            let mut model = TypedModel::default();
            let source = model.add_source("given", f32::fact(given)).expect("a source");
            let kernel = model.add_const("kernel", numbers(kernel)).expect("a constant");
            let bias = if bias == 1 { tensor0(0.0_f32) } else { numbers(&[bias]) };
            let bias = model.add_const("bias", bias).expect("a constant");
            let op = Conv { pool_spec, kernel_fmt, group: 1, q_params: None };
            let out = model.wire_node("conv", op, &[source, kernel, bias]).expect("a convolution");
            model.select_output_outlets(&out).expect("an output");
            let along_a_line = given.len() == 3 && strides == [1];
            let name = if along_a_line { "Line" } else { "Dense" };
            same_after(model, &numbers(given), unroll, name, 1);
        }
    }
}
