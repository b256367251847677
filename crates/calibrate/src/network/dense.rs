//! Fully connected layers.

use super::{NetworkError, Weights};

/// Outputs and rows that are computed together, in registers.
const OUTPUTS: usize = 8;
const ROWS: usize = 4;

/// `output = weights input + bias`.
#[derive(Debug, Clone)]
pub(super) struct Layer {
    /// For each [`OUTPUTS`] outputs, filled up with zeros, their weights of each input.
    blocks: Vec<[f32; OUTPUTS]>,
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
        let mut blocks = vec![[0.0; OUTPUTS]; outputs.div_ceil(OUTPUTS) * inputs];
        for (output, row) in rows.chunks_exact(inputs.max(1)).enumerate() {
            for (input, weight) in row.iter().enumerate() {
                blocks[output / OUTPUTS * inputs + input][output % OUTPUTS] = *weight;
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
        output.clear();
        output.resize(input.len() / inputs * outputs, 0.0);
        for (k, rows) in input.chunks(ROWS * inputs).enumerate() {
            let from = ROWS * k * outputs;
            if rows.len() == ROWS * inputs {
                self.apply_rows::<ROWS>(rows, &mut output[from..]);
            } else {
                for (r, row) in rows.chunks_exact(inputs).enumerate() {
                    self.apply_rows::<1>(row, &mut output[from + r * outputs..]);
                }
            }
        }
    }

    /// The output of `N` rows.
    fn apply_rows<const N: usize>(&self, rows: &[f32], output: &mut [f32]) {
        let (inputs, outputs) = (self.inputs.max(1), self.outputs());
        for (b, block) in self.blocks.chunks_exact(inputs).enumerate() {
            let mut sums = [[0.0_f32; OUTPUTS]; N];
            for (i, weights) in block.iter().enumerate() {
                for (r, sums) in sums.iter_mut().enumerate() {
                    let value = rows[r * inputs + i];
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        *sum += value * weight;
                    }
                }
            }
            let bias = &self.bias[b * OUTPUTS..outputs.min((b + 1) * OUTPUTS)];
            for (r, sums) in sums.iter().enumerate() {
                let to = &mut output[r * outputs + b * OUTPUTS..][..bias.len()];
                for ((to, sum), bias) in to.iter_mut().zip(sums).zip(bias) {
                    *to = sum + bias;
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

/// Replaces what is negative by zero.
pub(super) fn rectify(values: &mut [f32]) {
    values.iter_mut().for_each(|value| *value = value.max(0.0));
}

/// `1 / (1 + exp(-x))`.
pub(super) fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + (-x).exp())
}

/// The inverse hyperbolic sine, as the exported network has it.
pub(super) fn asinh(x: f32) -> f32 {
    let size = x.abs();
    (size + size * size / (1.0 + (1.0 + size * size).sqrt())).ln_1p().copysign(x)
}
