//! A gated recurrent network (Cho et al. 2014) over a sequence, both ways.

use super::dense::{Layer, one, sigmoid};
use super::{NetworkError, Weights};

/// One way through the sequence.
#[derive(Debug, Clone)]
struct Way {
    of_input: Layer,
    of_state: Layer,
}

impl Way {
    /// The tensors that PyTorch names with this ending: gates for reset, update and candidate, one below the other.
    fn read(
        weights: &Weights,
        name: &str,
        ending: &str,
        inputs: usize,
    ) -> Result<Self, NetworkError> {
        let named = |of: &str, inputs: Option<usize>| {
            let matrix = format!("{name}.weight_{of}_{ending}");
            let outputs = weights.shape(&matrix).and_then(|shape| shape.first()).copied();
            let outputs = outputs.unwrap_or(0) / 3 * 3;
            let shape = [outputs, inputs.unwrap_or(outputs / 3)];
            Layer::named(weights, &matrix, &format!("{name}.bias_{of}_{ending}"), shape, true)
        };
        Ok(Self { of_input: named("ih", Some(inputs))?, of_state: named("hh", None)? })
    }

    fn states(&self) -> usize {
        self.of_state.outputs() / 3
    }

    /// The next state.
    fn step(&self, input: &[f32], state: &mut [f32]) {
        let (mut a, mut b) = (vec![], vec![]);
        self.of_input.apply(input, &mut a);
        self.of_state.apply(state, &mut b);
        let n = state.len();
        for i in 0..n {
            let reset = one(a[i] + b[i], sigmoid);
            let update = one(a[n + i] + b[n + i], sigmoid);
            let candidate = (a[2 * n + i] + reset * b[2 * n + i]).tanh();
            state[i] = (1.0 - update) * candidate + update * state[i];
        }
    }
}

/// Both ways through a sequence.
#[derive(Debug, Clone)]
pub(super) struct Recurrent {
    ways: [Way; 2],
}

impl Recurrent {
    pub(super) fn read(weights: &Weights, name: &str, inputs: usize) -> Result<Self, NetworkError> {
        let ways = [
            Way::read(weights, name, "l0", inputs)?,
            Way::read(weights, name, "l0_reverse", inputs)?,
        ];
        for (way, ending) in ways.iter().zip(["l0", "l0_reverse"]) {
            let [given, expected] = [way.of_input.outputs(), 3 * ways[0].states()];
            if given != expected || way.of_state.outputs() != expected {
                return Err(NetworkError::Unlike {
                    tensor: format!("{name}.weight_ih_{ending}"),
                    expected: format!("{expected} outputs"),
                    given: format!("{given}"),
                });
            }
        }
        Ok(Self { ways })
    }

    /// Numbers of a state, of both ways together.
    pub(super) fn outputs(&self) -> usize {
        2 * self.ways[0].states()
    }

    /// States of both ways, of rows of inputs.
    pub(super) fn apply(&self, inputs: &[f32], row: usize) -> Vec<f32> {
        let one = self.outputs() / 2;
        let count = inputs.len() / row.max(1);
        let mut states = vec![0.0; count * self.outputs()];
        for (way, network) in self.ways.iter().enumerate() {
            let mut state = vec![0.0; one];
            for k in 0..count {
                let at = if way == 0 { k } else { count - 1 - k };
                network.step(&inputs[at * row..(at + 1) * row], &mut state);
                let from = at * self.outputs() + way * one;
                states[from..from + one].copy_from_slice(&state);
            }
        }
        states
    }
}
