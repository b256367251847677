//! A graph, and the plans by which tract runs it.

use crate::card::{Axis, Port};
use crate::convolution::unroll;
use crate::dense::densify;
use crate::error::{NeuralError, network_failed};
use crate::fused::fuse;
use crate::softmax::soften;
use boresight_aoa::{AoaError, Method};
use ndarray::{ArrayD, ArrayViewD};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use tract_onnx::pb::{ModelProto, ValueInfoProto, tensor_proto, tensor_shape_proto, type_proto};
use tract_onnx::prelude::*;
use tract_onnx::tract_core::model::TypedModelPatch;
use tract_onnx::tract_core::ops::Cost;
use tract_onnx::tract_core::ops::cast::Cast;
use tract_onnx::tract_core::ops::konst::Const;
use tract_onnx::tract_core::plan::SimpleState;
use tract_onnx::tract_hir::infer::InferenceOp;
use tract_onnx::tract_hir::internal::DimLike;

/// Most numbers between two operators.
const MAX_NUMBERS: usize = 1 << 26;

type Runnable = Arc<TypedRunnableModel>;

/// Lengths of axes that have names, by name.
pub(crate) type Lengths = Vec<(String, usize)>;

/// A graph with its plans, a plan for each size of batch.
pub(crate) struct Engine {
    graph: InferenceModel,
    inputs: Vec<Port>,
    /// For each input whether its first axis counts the examples of a batch.
    batched: Vec<bool>,
    plans: Mutex<Vec<(usize, Runnable)>>,
    /// Operations of an example, once they have been counted.
    counted: OnceLock<f64>,
}

impl Engine {
    /// Reads the graph, whose inputs are `inputs`; `batched` tells for each whether its first axis counts examples.
    pub fn new(
        proto: &ModelProto,
        inputs: Vec<Port>,
        batched: Vec<bool>,
    ) -> Result<Self, NeuralError> {
        let onnx = tract_onnx::onnx().with_ignore_value_info(true);
        let graph = onnx.model_for_proto_model(proto).map_err(|error| refused("read", &error))?;
        Ok(Self { graph, inputs, batched, plans: Mutex::default(), counted: OnceLock::new() })
    }

    /// Inputs with, for each, whether its first axis counts the examples of a batch.
    pub fn inputs(&self) -> impl Iterator<Item = (&Port, bool)> {
        self.inputs.iter().zip(self.batched.iter().copied())
    }

    /// The same with these lengths.
    pub fn with_lengths(&self, lengths: &Lengths) -> Self {
        let mut inputs = self.inputs.clone();
        for (port, &batched) in inputs.iter_mut().zip(&self.batched) {
            for axis in &mut port.axes[usize::from(batched)..] {
                let known = |(name, _): &&(String, usize)| *axis == Axis::Named(name.clone());
                if let Some((_, length)) = lengths.iter().find(known) {
                    *axis = Axis::Length(*length);
                }
            }
        }
        let (graph, batched) = (self.graph.clone(), self.batched.clone());
        Self { graph, inputs, batched, plans: Mutex::default(), counted: OnceLock::new() }
    }

    /// Shapes of the outputs for one example, those of other than 32-bit floating-point numbers being empty. Axes without
    /// a length have one.
    pub fn output_shapes(&self) -> Result<Vec<Vec<usize>>, NeuralError> {
        let typed = self.typed(1)?;
        let shape = |at| {
            let fact = typed.output_fact(at)?;
            let shape = fact.shape.as_concrete().filter(|_| fact.datum_type == f32::datum_type());
            Ok(shape.unwrap_or_default().to_vec())
        };
        let outputs = 0..typed.outputs.len();
        outputs.map(shape).collect::<TractResult<_>>().map_err(|error| refused("analysed", &error))
    }

    /// The same with an input that never changes, so that what follows from it is computed once.
    pub fn with_constant(&self, name: &str, tensor: Tensor) -> Result<Self, NeuralError> {
        let port = self.inputs.iter().find(|port| port.name == name);
        let lengths = port.map(|port| port.lengths(tensor.shape())).unwrap_or_default();
        let mut engine = self.with_lengths(&lengths);
        if let Some(at) = self.inputs.iter().position(|port| port.name == name) {
            let outlet = engine.graph.inputs.remove(at);
            let node = &mut engine.graph.nodes[outlet.node];
            let constant = Const::new(tensor.clone().into_arc_tensor())
                .map_err(|error| refused("read", &error))?;
            node.op = Box::new(constant) as Box<dyn InferenceOp>;
            node.outputs[0].fact = tensor.into();
            engine.inputs.remove(at);
            engine.batched.remove(at);
        }
        Ok(engine)
    }

    /// The plan for batches of `batch` examples, made when it is first asked for.
    pub fn plan(&self, batch: usize) -> Result<Runnable, NeuralError> {
        let mut plans = self.plans.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, plan)) = plans.iter().find(|(size, _)| *size == batch) {
            return Ok(plan.clone());
        }
        let plan = self.prepare(batch)?;
        plans.push((batch, plan.clone()));
        Ok(plan)
    }

    /// Additions, multiplications and divisions of one example, as tract counts them, without what follows from
    /// constants alone.
    pub fn operations(&self) -> Result<f64, NeuralError> {
        if let Some(counted) = self.counted.get() {
            return Ok(*counted);
        }
        let count = |graph: TypedModel| -> TractResult<f64> {
            let mut sum = 0.0;
            for id in graph.eval_order()? {
                for (cost, number) in graph.node(id).op.cost(&graph.node_input_facts(id)?)? {
                    let each = match cost {
                        Cost::FMA(_) => 2.0,
                        Cost::Div(_) => 1.0,
                        _ => 0.0,
                    };
                    sum += each * number.to_i64()? as f64;
                }
            }
            Ok(sum)
        };
        let simple = widen(self.typed(1)?).and_then(TypedModel::into_decluttered);
        let counted = simple.and_then(count).map_err(|error| refused("analysed", &error))?;
        Ok(*self.counted.get_or_init(|| counted))
    }

    fn prepare(&self, batch: usize) -> Result<Runnable, NeuralError> {
        let wide = widen(self.typed(batch)?).and_then(TypedModel::into_decluttered);
        let optimised = wide.and_then(|mut graph| {
            // Natively tract has kernels for products on the processor at hand, which are faster than ours.
            if cfg!(target_family = "wasm") {
                unroll(&mut graph)?;
                densify(&mut graph)?;
            }
            graph.optimize()?;
            fuse(&mut graph)?;
            soften(&mut graph)?;
            graph.into_runnable()
        });
        optimised.map_err(|error| refused("optimised", &error))
    }

    /// The graph with all types and shapes.
    fn typed(&self, batch: usize) -> Result<TypedModel, NeuralError> {
        let mut graph = self.graph.clone();
        for (at, (port, &batched)) in self.inputs.iter().zip(&self.batched).enumerate() {
            let shape = shape(port, batched.then_some(batch));
            graph
                .set_input_fact(at, f32::fact(shape).into())
                .map_err(|error| refused("analysed", &error))?;
        }
        let typed = graph.into_typed().map_err(|error| refused("analysed", &error))?;
        for node in typed.nodes() {
            let held = |fact: &TypedFact| {
                fact.shape.volume().to_usize().is_ok_and(|count| count <= MAX_NUMBERS)
            };
            if !node.outputs.iter().all(|outlet| held(&outlet.fact)) {
                return Err(NeuralError::Malformed {
                    what: format!("output of {:?}", node.name),
                    expected: format!("at most {MAX_NUMBERS} numbers"),
                    given: "more, or no fixed number".into(),
                });
            }
        }
        Ok(typed)
    }
}

/// Casts constants once and for all: tract leaves that of a large one stored in half precision for each run.
fn widen(mut graph: TypedModel) -> TractResult<TypedModel> {
    for id in graph.eval_order()? {
        let node = graph.node(id);
        let (Some(cast), &[input]) = (node.op_as::<Cast>(), &*node.inputs) else { continue };
        let Some(value) = graph.outlet_fact(input)?.konst.clone() else { continue };
        if cast.to != f32::datum_type() {
            continue;
        }
        let mut patch = TypedModelPatch::default();
        let wide = value.cast_to::<f32>()?.into_owned().into_arc_tensor();
        let outlet = patch.add_const(format!("{}.wide", node.name), wide)?;
        patch.shunt_outside(&graph, OutletId::new(id, 0), outlet)?;
        patch.apply(&mut graph)?;
    }
    graph.compact()?;
    Ok(graph)
}

/// Sizes of batches plans are made for; others are made up of these, the largest first.
pub(crate) const BATCHES: [usize; 2] = [32, 1];

/// What runs a graph on batches of any size, with the state of its plans.
#[derive(Clone)]
pub(crate) struct Runners {
    engine: Arc<Engine>,
    sizes: Vec<usize>,
    ready: Vec<(usize, Runner)>,
}

impl Runners {
    /// `single` for a graph that takes one example at a time.
    pub fn new(engine: Arc<Engine>, single: bool) -> Self {
        let sizes = BATCHES.into_iter().filter(|&size| size == 1 || !single).collect();
        Self { engine, sizes, ready: Vec::new() }
    }

    /// As [`Engine::operations`].
    pub fn operations(&self) -> Result<f64, NeuralError> {
        self.engine.operations()
    }

    /// The same in complex multiplications with an addition, as estimators count.
    pub fn of_estimate(&self, method: Method) -> Result<f64, AoaError> {
        let operations = self.operations().map_err(|error| network_failed(method.name(), error))?;
        Ok(operations / 8.0)
    }

    /// The largest batch that is run at once.
    pub fn most(&self) -> usize {
        self.sizes.iter().copied().max().unwrap_or(1)
    }

    /// Runs `count` examples: `given(from, to)` makes the inputs of a stretch, `take(from, outputs)` takes its outputs.
    pub fn run(
        &mut self,
        count: usize,
        mut given: impl FnMut(usize, usize) -> Result<TVec<TValue>, NeuralError>,
        mut take: impl FnMut(usize, &[ArrayViewD<'_, f32>]),
    ) -> Result<(), NeuralError> {
        let mut from = 0;
        for at in 0..self.sizes.len() {
            let size = self.sizes[at];
            while count - from >= size {
                let inputs = given(from, from + size)?;
                self.runner(size)?.run(inputs, |outputs| take(from, outputs))?;
                from += size;
            }
        }
        Ok(())
    }

    fn runner(&mut self, size: usize) -> Result<&mut Runner, NeuralError> {
        let at = match self.ready.iter().position(|(ready, _)| *ready == size) {
            Some(at) => at,
            None => {
                let state = self.engine.plan(size)?.spawn();
                let state = state.map_err(|error| refused("run", &error))?;
                self.ready.push((size, Runner { state }));
                self.ready.len() - 1
            }
        };
        Ok(&mut self.ready[at].1)
    }
}

/// A plan with its state.
#[derive(Clone)]
struct Runner {
    state: SimpleState<TypedFact, Box<dyn TypedOp>>,
}

impl Runner {
    fn run(
        &mut self,
        inputs: TVec<TValue>,
        take: impl FnOnce(&[ArrayViewD<'_, f32>]),
    ) -> Result<(), NeuralError> {
        let failed = |error: TractError| refused("run", &error);
        let outputs = self.state.run(inputs).map_err(failed)?;
        let views: Vec<ArrayViewD<'_, f32>> = outputs
            .iter()
            .map(|output| output.to_plain_array_view::<f32>())
            .collect::<TractResult<_>>()
            .map_err(failed)?;
        for view in &views {
            if let Some(&given) = view.iter().find(|x| !x.is_finite()) {
                return Err(NeuralError::NotFinite { what: "the network's output".into(), given });
            }
        }
        take(&views);
        Ok(())
    }
}

/// A tensor of the same numbers.
pub(crate) fn tensor(array: ArrayViewD<'_, f32>) -> Result<Tensor, NeuralError> {
    match array.as_slice() {
        Some(numbers) => tensor_of(array.shape(), numbers),
        None => Ok(Tensor::from(array.to_owned())),
    }
}

/// A tensor of some shape.
pub(crate) fn tensor_of(shape: &[usize], numbers: &[f32]) -> Result<Tensor, NeuralError> {
    Tensor::from_shape(shape, numbers).map_err(|error| refused("run", &error))
}

/// A tensor that `fill` writes the numbers of.
pub(crate) fn filled(
    shape: &[usize],
    fill: impl FnOnce(&mut [f32]),
) -> Result<Tensor, NeuralError> {
    let mut numbers: ArrayD<f32> = ArrayD::zeros(shape);
    if let Some(numbers) = numbers.as_slice_mut() {
        fill(numbers);
    }
    Ok(Tensor::from(numbers))
}

fn shape(port: &Port, batch: Option<usize>) -> TVec<usize> {
    let length = |axis: &Axis| match axis {
        Axis::Length(length) => *length,
        Axis::Named(_) => 1,
    };
    port.axes
        .iter()
        .enumerate()
        .map(|(at, axis)| batch.filter(|_| at == 0).unwrap_or_else(|| length(axis)))
        .collect()
}

/// Inputs that are no constants, and outputs, as the file states them.
pub(crate) fn ports(proto: &ModelProto) -> (Vec<Port>, Vec<Port>) {
    let Some(graph) = &proto.graph else {
        return (Vec::new(), Vec::new());
    };
    let constant = |name: &str| graph.initializer.iter().any(|tensor| tensor.name == name);
    let inputs = graph.input.iter().filter(|input| !constant(&input.name));
    (inputs.map(port).collect(), graph.output.iter().map(port).collect())
}

fn port(value: &ValueInfoProto) -> Port {
    let tensor = value.r#type.as_ref().and_then(|kind| kind.value.as_ref());
    let float =
        |tensor: &&type_proto::Tensor| tensor.elem_type == tensor_proto::DataType::Float as i32;
    let shape = tensor
        .map(|type_proto::Value::TensorType(tensor)| tensor)
        .filter(float)
        .and_then(|tensor| tensor.shape.as_ref());
    let axis = |dimension: &tensor_shape_proto::Dimension| match &dimension.value {
        Some(tensor_shape_proto::dimension::Value::DimValue(length)) => {
            usize::try_from(*length).map_or_else(|_| Axis::Named("?".into()), Axis::Length)
        }
        Some(tensor_shape_proto::dimension::Value::DimParam(name)) => Axis::Named(name.clone()),
        None => Axis::Named("?".into()),
    };
    let axes = shape.map(|shape| shape.dim.iter().map(axis).collect()).unwrap_or_default();
    Port { name: value.name.clone(), axes }
}

fn refused(stage: &'static str, error: &TractError) -> NeuralError {
    // The innermost cause says what is wrong, the outermost where.
    let (outer, root) = (error.to_string(), error.root_cause().to_string());
    let reason = if outer == root { root } else { format!("{outer}: {root}") };
    NeuralError::Refused { stage, reason: reason.chars().take(400).collect() }
}

#[cfg(test)]
pub(crate) mod tests {
    use tract_onnx::tract_core::internal::*;

    /// Runs a model before and after a change, which is to leave so many operators of a name.
    pub fn same_after(
        mut model: TypedModel,
        given: &Tensor,
        change: impl Fn(&mut TypedModel) -> TractResult<()>,
        name: &str,
        count: usize,
    ) {
        let run = |model: &TypedModel| {
            let plan = model.clone().into_runnable().expect("a plan");
            plan.run(tvec!(given.clone().into())).expect("outputs")
        };
        let before = run(&model);
        change(&mut model).expect("a change");
        assert_eq!(
            model.nodes().iter().filter(|node| node.op.name() == name).count(),
            count,
            "{model}"
        );
        let after = run(&model);
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(&after) {
            before.close_enough(after, Approximation::Approximate).expect("the same numbers");
        }
    }
}
