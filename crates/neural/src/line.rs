//! Convolutions along one axis with constant kernels.
//!
//! Four output channels at eight neighbouring positions are computed together. The numbers of neighbouring positions lie
//! next to each other in the input, so nothing is copied before and the output is written in order.

use crate::product::numbers_of;
use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use wide::f32x4;

/// Output channels computed together.
const CHANNELS: usize = 4;
/// Positions computed together.
const POSITIONS: usize = 8;

/// A convolution of stride 1 of [batch, channels, length].
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    /// Weights by groups of output channels, then by inner number; the last group is filled up with zeros.
    weights: Vec<[f32; CHANNELS]>,
    bias: Vec<f32>,
    /// Offset in the input of each inner number, a channel and a place of the kernel.
    inner: Vec<usize>,
    given: [usize; 3],
    output: [usize; 3],
}

impl Eq for Line {}

impl Line {
    /// For an input that includes its padding. `kernel` is [output channels, channels, places]. `None` if the output is
    /// shorter than what is computed together, or the shapes do not fit.
    pub fn new(
        kernel: &[f32],
        bias: &[f32],
        dilation: usize,
        given: [usize; 3],
        output: [usize; 3],
    ) -> Option<Self> {
        let [_, channels, length] = given;
        let [_, outputs, positions] = output;
        let places = kernel.len() / (outputs * channels).max(1);
        let reach = places.checked_sub(1)? * dilation + positions;
        let fits = kernel.len() == outputs * channels * places && reach <= length;
        if !fits || positions < POSITIONS || !(bias.len() == outputs || bias.len() == 1) {
            return None;
        }
        let count = channels * places;
        let mut weights = vec![[0.0; CHANNELS]; outputs.div_ceil(CHANNELS) * count];
        for (own, row) in kernel.chunks_exact(count).enumerate() {
            for (at, &weight) in row.iter().enumerate() {
                weights[own / CHANNELS * count + at][own % CHANNELS] = weight;
            }
        }
        let inner = (0..channels).flat_map(|c| (0..places).map(move |k| c * length + k * dilation));
        let bias = (0..outputs).map(|own| bias[own % bias.len()]).collect();
        Some(Self { weights, bias, inner: inner.collect(), given, output })
    }

    fn convolve(&self, given: &[f32], output: &mut [f32]) {
        let [_, channels, length] = self.given;
        let [_, outputs, positions] = self.output;
        let scenes = given.chunks_exact(channels * length);
        for (given, output) in scenes.zip(output.chunks_exact_mut(outputs * positions)) {
            let groups = self.weights.chunks_exact(self.inner.len());
            let lines = output.chunks_mut(CHANNELS * positions);
            for ((weights, lines), bias) in groups.zip(lines).zip(self.bias.chunks(CHANNELS)) {
                let mut from = 0;
                while from < positions {
                    // The last eight overlap those before.
                    from = from.min(positions - POSITIONS);
                    let sums = eight(&given[from..], weights, &self.inner);
                    let of_lines = lines.chunks_exact_mut(positions).zip(&sums).zip(bias);
                    for ((line, sums), bias) in of_lines {
                        let to = line[from..].iter_mut().zip(sums);
                        to.for_each(|(to, sum)| *to = sum + bias);
                    }
                    from += POSITIONS;
                }
            }
        }
    }
}

/// Sums over the inner numbers for four output channels at eight positions.
// Written out: engines of WebAssembly keep these sums in registers, arrays of them in memory.
#[inline(never)]
fn eight(
    given: &[f32],
    weights: &[[f32; CHANNELS]],
    inner: &[usize],
) -> [[f32; POSITIONS]; CHANNELS] {
    let [mut a0, mut a1, mut b0, mut b1] = [f32x4::ZERO; 4];
    let [mut c0, mut c1, mut d0, mut d1] = [f32x4::ZERO; 4];
    for (&[a, b, c, d], &place) in weights.iter().zip(inner) {
        let Some(&[x0, x1, x2, x3, x4, x5, x6, x7]) = given[place..].first_chunk::<POSITIONS>()
        else {
            continue;
        };
        let (low, high) = (f32x4::new([x0, x1, x2, x3]), f32x4::new([x4, x5, x6, x7]));
        let weight = f32x4::splat(a);
        a0 += weight * low;
        a1 += weight * high;
        let weight = f32x4::splat(b);
        b0 += weight * low;
        b1 += weight * high;
        let weight = f32x4::splat(c);
        c0 += weight * low;
        c1 += weight * high;
        let weight = f32x4::splat(d);
        d0 += weight * low;
        d1 += weight * high;
    }
    [numbers_of([a0, a1]), numbers_of([b0, b1]), numbers_of([c0, c1]), numbers_of([d0, d1])]
}

impl Op for Line {
    fn name(&self) -> StaticName {
        "Line".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Line {
    op_out_of_plan!();

    fn eval(&self, _: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let view = inputs[0].to_plain_array_view::<f32>()?;
        let given = view.as_slice().context("an input in C order")?;
        let mut tensor = Tensor::zero::<f32>(&self.output)?;
        let mut output = tensor.to_plain_array_view_mut::<f32>()?;
        self.convolve(given, output.as_slice_mut().context("an output in C order")?);
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Line {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(self.output)))
    }

    as_op!();
}
