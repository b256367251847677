//! Models: loaded, checked, run.

use crate::card::{Axis, Card, Kind, Port};
use crate::engine::{Engine, Lengths, Runners, ports, tensor, tensor_of};
use crate::error::NeuralError;
use crate::features::{ELEMENTS, covariance_features};
use crate::onnx;
use crate::ports::{check_digest, check_ports, checked_outputs, kinds_of, list};
use boresight_aoa::{Data, SourceProbabilities};
use boresight_core::{Array, InputError};
use boresight_math::error::{check_finite, check_range};
use boresight_options::Named;
use ndarray::{ArrayD, ArrayViewD, Axis as NdAxis, Slice};
use sha2::{Digest, Sha256};
use std::sync::{Arc, Mutex, PoisonError};
use tract_onnx::prelude::{TValue, TVec};

/// Most examples run at once.
const MAX_BATCH: usize = 1 << 20;
/// Longest axis of any length.
const MAX_LENGTH: usize = 4096;

/// A network ready to run; clones share it.
#[derive(Clone)]
pub struct Model {
    pub(crate) engine: Arc<Engine>,
    kind: Kind,
    card: Option<Arc<Card>>,
    sha256: String,
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    /// Whether the file takes one example at a time.
    single: bool,
    /// The engine with the array of the last estimator in it, and the positions of its elements.
    placed: Arc<Mutex<Option<Placed>>>,
    /// What ran the graph last, ready to do so again on inputs of the same lengths.
    idle: Arc<Mutex<Option<(Lengths, Runners)>>>,
}

/// Inputs, each with whether its first axis counts examples.
type Ordered<'a> = Vec<(ArrayViewD<'a, f32>, bool)>;
/// Positions of elements, and the engine with these in it.
type Placed = (Vec<f32>, Arc<Engine>);

impl Model {
    /// Reads a model and checks it: that it is ONNX, whole, and sound; that it uses supported operators only; that
    /// inputs and outputs are those of a known kind of network and, where there is a card, those the card states; that
    /// the bytes have the card's digest; that types and shapes fit throughout.
    ///
    /// # Errors
    /// [`NeuralError`] telling what is wrong.
    pub fn load(onnx: &[u8], card: Option<&Card>) -> Result<Self, NeuralError> {
        let proto = onnx::read(onnx)?;
        let sha256: String =
            Sha256::digest(onnx).iter().map(|byte| format!("{byte:02x}")).collect();
        let (inputs, outputs) = ports(&proto);
        let kinds: Vec<Kind> = card.map_or(Kind::VARIANTS.to_vec(), |card| vec![card.kind]);
        let kinds = kinds_of(&inputs, &outputs, &kinds)?;
        let (wanted, _) = kinds[0].ports();
        // Positions too have an axis of any length, which counts elements.
        let counts = |port: &Port| port.axes.first() == Some(&Axis::Named("batch".into()));
        let batched: Vec<bool> = wanted.iter().map(counts).collect();
        let fixed = |port: &Port| matches!(port.axes.first(), Some(Axis::Length(_)));
        let single = inputs.iter().zip(&batched).any(|(port, &batched)| batched && fixed(port));
        let engine = Engine::new(&proto, inputs.clone(), batched)?;
        let (kind, outputs) = checked_outputs(&engine, &kinds, &outputs, single)?;
        if let Some(card) = card {
            check_ports("inputs", &card.inputs, &inputs)?;
            check_ports("outputs", &card.outputs, &outputs)?;
            check_digest(card, &sha256)?;
        }
        let card = card.cloned().map(Arc::new);
        let (engine, placed, idle) = (Arc::new(engine), Arc::default(), Arc::default());
        Ok(Self { engine, kind, card, sha256, inputs, outputs, single, placed, idle })
    }

    /// What the network does.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Its card, if it was loaded with one.
    pub fn card(&self) -> Option<&Card> {
        self.card.as_deref()
    }

    /// SHA-256 of its file, hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Its inputs.
    pub fn inputs(&self) -> &[Port] {
        &self.inputs
    }

    /// The number of elements of arrays that it takes; none where any goes, or where the input is no snapshot.
    pub fn elements(&self) -> Option<usize> {
        self.inputs.iter().find_map(|port| match (&*port.name, &port.axes[..]) {
            ("positions", [Axis::Length(elements), _])
            | ("covariance", [_, _, _, Axis::Length(elements)]) => Some(*elements),
            _ => None,
        })
    }

    /// Its outputs.
    pub fn outputs(&self) -> &[Port] {
        &self.outputs
    }

    /// Runs the network on inputs by name, any number of examples, and returns its outputs.
    ///
    /// # Errors
    /// [`NeuralError::Mismatch`] for other names, [`InputError::Shape`] for other shapes or inputs with different
    /// numbers of examples, [`InputError::NotFinite`] for NaN and infinities, [`NeuralError::NotFinite`] where an output
    /// is not finite.
    pub fn run(
        &self,
        inputs: &[(&str, ArrayViewD<'_, f32>)],
    ) -> Result<Vec<(String, ArrayD<f32>)>, NeuralError> {
        let (ordered, lengths) = self.ordered(inputs)?;
        let counted = ordered.iter().find(|(_, batched)| *batched);
        let batch = counted.map_or(1, |(array, _)| array.shape()[0]);
        check_range("number of examples", batch as f64, 1.0, MAX_BATCH as f64)?;
        let mut parts: Vec<Vec<ArrayD<f32>>> = vec![Vec::new(); self.outputs.len()];
        self.run_graph(
            &lengths,
            batch,
            |from, to| {
                let part = |(array, batched): &(ArrayViewD<'_, f32>, bool)| {
                    let mut array = array.view();
                    if *batched {
                        array.slice_axis_inplace(NdAxis(0), Slice::from(from..to));
                    }
                    Ok(tensor(array)?.into())
                };
                ordered.iter().map(part).collect()
            },
            |_, outputs| {
                for (parts, output) in parts.iter_mut().zip(outputs) {
                    parts.push(output.to_owned());
                }
            },
        )?;
        let join = |mut parts: Vec<ArrayD<f32>>| {
            if parts.len() == 1 {
                return Ok(parts.swap_remove(0));
            }
            let views: Vec<_> = parts.iter().map(|part| part.view()).collect();
            ndarray::concatenate(NdAxis(0), &views)
                .map_err(|error| NeuralError::Refused { stage: "run", reason: error.to_string() })
        };
        let named = |(port, parts): (&Port, _)| Ok((port.name.clone(), join(parts)?));
        self.outputs.iter().zip(parts).map(named).collect()
    }

    /// The inputs in the network's order, each with whether its first axis counts examples, and the lengths of axes that
    /// have names.
    fn ordered<'a>(
        &self,
        inputs: &'a [(&str, ArrayViewD<'_, f32>)],
    ) -> Result<(Ordered<'a>, Lengths), NeuralError> {
        let given = |name: &str| inputs.iter().find(|(given, _)| *given == name);
        if inputs.len() != self.inputs.len() || self.inputs.iter().any(|p| given(&p.name).is_none())
        {
            return Err(NeuralError::Mismatch {
                what: "names of the inputs given".into(),
                expected: list(self.inputs.iter().map(|port| port.name.as_str())),
                given: list(inputs.iter().map(|(name, _)| *name)),
            });
        }
        let mut batch = None;
        let mut ordered = Vec::with_capacity(inputs.len());
        let mut lengths: Lengths = Vec::new();
        for (port, batched) in self.engine.inputs() {
            let Some((_, array)) = given(&port.name) else { continue };
            let mut fits_length = |axis: &Axis, length: usize| match axis {
                Axis::Length(wanted) => *wanted == length,
                Axis::Named(name) => match lengths.iter().find(|(known, _)| known == name) {
                    Some((_, known)) => *known == length,
                    None => {
                        lengths.push((name.clone(), length));
                        (1..=MAX_LENGTH).contains(&length)
                    }
                },
            };
            let fits =
                array.ndim() == port.axes.len()
                    && port.axes.iter().zip(array.shape()).enumerate().all(
                        |(at, (axis, &length))| (at == 0 && batched) || fits_length(axis, length),
                    );
            let count = array.shape().first().copied();
            if !fits || (batched && *batch.get_or_insert(count) != count) {
                return Err(NeuralError::Argument(InputError::Shape {
                    what: format!("input {:?}", port.name),
                    expected: port.to_string(),
                    given: array.shape().to_vec(),
                }));
            }
            check_finite(&port.name, array.iter().map(|&x| f64::from(x)))?;
            ordered.push((array.view(), batched));
        }
        Ok((ordered, lengths))
    }

    pub(crate) fn runners(&self) -> Runners {
        Runners::new(self.engine.clone(), self.single)
    }

    fn runners_of(&self, lengths: &Lengths) -> Runners {
        match lengths[..] {
            [] => self.runners(),
            _ => Runners::new(Arc::new(self.engine.with_lengths(lengths)), self.single),
        }
    }

    fn run_graph(
        &self,
        lengths: &Lengths,
        count: usize,
        given: impl FnMut(usize, usize) -> Result<TVec<TValue>, NeuralError>,
        take: impl FnMut(usize, &[ArrayViewD<'_, f32>]),
    ) -> Result<(), NeuralError> {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let last = idle().take().filter(|(known, _)| known == lengths);
        let mut runners = last.map_or_else(|| self.runners_of(lengths), |(_, runners)| runners);
        // Not kept where it failed.
        runners.run(count, given, take)?;
        *idle() = Some((lengths.clone(), runners));
        Ok(())
    }

    /// The same with the positions of an array in place of that input.
    pub(crate) fn runners_for(&self, array: &Array) -> Result<Runners, NeuralError> {
        let positions: Vec<f32> = array.positions().iter().flatten().map(|&p| p as f32).collect();
        let mut placed = self.placed.lock().unwrap_or_else(PoisonError::into_inner);
        let engine = match &*placed {
            Some((known, engine)) if *known == positions => engine.clone(),
            _ => {
                let shape = [array.len(), 3];
                let engine =
                    self.engine.with_constant("positions", tensor_of(&shape, &positions)?)?;
                let engine = Arc::new(engine);
                *placed = Some((positions, engine.clone()));
                engine
            }
        };
        Ok(Runners::new(engine, self.single))
    }

    /// Additions, multiplications and divisions that a snapshot of an array takes, without what follows from the
    /// positions of its elements alone.
    ///
    /// # Errors
    /// [`NeuralError::Refused`] where the graph cannot be analysed.
    pub fn operations(&self, array: &Array) -> Result<f64, NeuralError> {
        self.runners_for(array)?.operations()
    }

    /// Counts the sources in the data of an array of 8 elements: 0, 1 or 2.
    ///
    /// # Errors
    /// [`NeuralError::WrongKind`] for any but the counting network, [`NeuralError::Angle`] for malformed data.
    pub fn count(&self, data: Data<'_>) -> Result<SourceProbabilities, NeuralError> {
        if self.kind != Kind::Counting {
            return Err(self.wrong_kind("counting"));
        }
        data.check(ELEMENTS)?;
        let features = covariance_features(data);
        let mut probability = [0.0; 3];
        self.run_graph(
            &Lengths::new(),
            1,
            |_, _| Ok([tensor_of(&[1, features.len()], &features)?.into()].into_iter().collect()),
            |_, outputs| {
                for (out, &given) in probability.iter_mut().zip(outputs[0].iter()) {
                    *out = f64::from(given);
                }
            },
        )?;
        let sources = (0..3).max_by(|&i, &k| probability[i].total_cmp(&probability[k]));
        Ok(SourceProbabilities { sources: sources.unwrap_or_default(), probability })
    }

    pub(crate) fn wrong_kind(&self, expected: &'static str) -> NeuralError {
        NeuralError::WrongKind { expected, given: self.kind.name() }
    }
}
