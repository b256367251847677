//! Fully connected layers.

use super::{NetworkError, Weights};
use wide::f32x4;

/// Outputs and rows that are computed together, in registers.
const OUTPUTS: usize = 8;
const ROWS: usize = 4;

type Block = [f32x4; OUTPUTS / 4];

/// `output = weights input + bias`.
#[derive(Debug, Clone)]
pub(super) struct Layer {
    /// For each [`OUTPUTS`] outputs, filled up with zeros, their weights of each input.
    blocks: Vec<Block>,
    bias: Vec<f32>,
    inputs: usize,
}

impl Layer {
    /// The layer `name`, whose number of outputs its weights tell.
    pub(super) fn read(
        weights: &Weights,
        name: &str,
        inputs: usize,
        has_bias: bool,
    ) -> Result<Self, NetworkError> {
        let matrix = format!("{name}.weight");
        let outputs = weights.shape(&matrix).and_then(|shape| shape.first().copied()).unwrap_or(0);
        Self::named(weights, &matrix, &format!("{name}.bias"), [outputs, inputs], has_bias)
    }

    /// The layer of two tensors and a shape.
    pub(super) fn named(
        weights: &Weights,
        matrix: &str,
        bias: &str,
        [outputs, inputs]: [usize; 2],
        has_bias: bool,
    ) -> Result<Self, NetworkError> {
        let rows = weights.values(matrix, &[outputs, inputs])?;
        let mut blocks = vec![Block::default(); outputs.div_ceil(OUTPUTS) * inputs];
        for (output, row) in rows.chunks_exact(inputs.max(1)).enumerate() {
            for (input, weight) in row.iter().enumerate() {
                let block = &mut blocks[output / OUTPUTS * inputs + input];
                block[output % OUTPUTS / 4].as_mut_array()[output % 4] = *weight;
            }
        }
        let bias = match has_bias {
            true => weights.values(bias, &[outputs])?.to_vec(),
            false => vec![0.0; outputs],
        };
        Ok(Self { blocks, bias, inputs })
    }

    pub(super) fn outputs(&self) -> usize {
        self.bias.len()
    }

    /// Replaces `output` by that of rows of inputs.
    pub(super) fn apply(&self, input: &[f32], output: &mut Vec<f32>) {
        let (inputs, outputs) = (self.inputs.max(1), self.outputs());
        let count = input.len() / inputs;
        output.clear();
        output.resize(count * outputs, 0.0);
        let row = |r: usize| &input[r * inputs..(r + 1) * inputs];
        for first in (0..count).step_by(ROWS) {
            // Of the last rows there may be fewer; what is computed twice is the same.
            let last = count - 1;
            let at: [usize; ROWS] = std::array::from_fn(|r| (first + r).min(last));
            let rows = at.map(row);
            for (b, block) in self.blocks.chunks_exact(inputs).enumerate() {
                let sums = products(block, rows);
                let bias = &self.bias[b * OUTPUTS..outputs.min((b + 1) * OUTPUTS)];
                for (r, sums) in at.iter().zip(sums) {
                    let to = &mut output[r * outputs + b * OUTPUTS..][..bias.len()];
                    let sums = sums.iter().flat_map(|sums| sums.to_array());
                    for ((to, sum), bias) in to.iter_mut().zip(sums).zip(bias) {
                        *to = sum + bias;
                    }
                }
            }
        }
    }

    /// As [`Layer::apply`], with what is negative replaced by zero.
    pub(super) fn apply_rectified(&self, input: &[f32], output: &mut Vec<f32>) {
        self.apply(input, output);
        rectify(output);
    }
}

/// Products of a block's weights with rows of inputs. All sums are variables of their own, which compilers for WebAssembly keep in
/// registers.
fn products(block: &[Block], [a, b, c, d]: [&[f32]; ROWS]) -> [Block; ROWS] {
    let [mut sum_a, mut sum_b, mut sum_c, mut sum_d] = [Block::default(); ROWS];
    for ((((weights, a), b), c), d) in block.iter().zip(a).zip(b).zip(c).zip(d) {
        let add = |sum: Block, value: &f32| {
            let value = f32x4::splat(*value);
            [sum[0] + value * weights[0], sum[1] + value * weights[1]]
        };
        (sum_a, sum_b, sum_c, sum_d) = (add(sum_a, a), add(sum_b, b), add(sum_c, c), add(sum_d, d));
    }
    [sum_a, sum_b, sum_c, sum_d]
}

/// Adds numbers of the same count.
pub(super) fn add(values: &mut [f32], others: &[f32]) {
    let ((fours, rest), (other_fours, other_rest)) =
        (values.as_chunks_mut::<4>(), others.as_chunks::<4>());
    for (four, other) in fours.iter_mut().zip(other_fours) {
        *four = (f32x4::from(*four) + f32x4::from(*other)).to_array();
    }
    rest.iter_mut().zip(other_rest).for_each(|(value, other)| *value += other);
}

/// Replaces what is negative by zero.
pub(super) fn rectify(values: &mut [f32]) {
    each(values, |four| four.fast_max(f32x4::ZERO));
}

/// Replaces numbers by a function of them, four at a time.
pub(super) fn each(values: &mut [f32], f: impl Fn(f32x4) -> f32x4) {
    let (fours, rest) = values.as_chunks_mut::<4>();
    for four in fours {
        *four = f(f32x4::from(*four)).to_array();
    }
    let mut four = [0.0; 4];
    four[..rest.len()].copy_from_slice(rest);
    rest.copy_from_slice(&f(f32x4::from(four)).to_array()[..rest.len()]);
}

/// A function of one number.
pub(super) fn one(x: f32, f: impl Fn(f32x4) -> f32x4) -> f32 {
    f(f32x4::splat(x)).to_array()[0]
}

/// `1 / (1 + exp(-x))`.
pub(super) fn sigmoid(x: f32x4) -> f32x4 {
    f32x4::ONE / (f32x4::ONE + (-x).exp())
}

/// The hyperbolic tangent.
pub(super) fn tanh(x: f32x4) -> f32x4 {
    // From 10 on it is 1 in single precision.
    let x = x.fast_max(f32x4::splat(-10.0)).fast_min(f32x4::splat(10.0));
    f32x4::ONE - f32x4::splat(2.0) / ((x + x).exp() + f32x4::ONE)
}

/// The inverse hyperbolic sine, as the exported network has it.
pub(super) fn asinh(x: f32x4) -> f32x4 {
    let size = x.abs();
    let square = size * size;
    let more = size + square / (f32x4::ONE + (f32x4::ONE + square).sqrt());
    (f32x4::ONE + more).ln().copysign(x)
}
