//! A network as an estimator.

use crate::constructors::construct;
use crate::tensors::{read_tensors, tensors_object};
use boresight_aoa::{self as aoa, EstimatorOptions, Estimators, Method};
use boresight_core::presets::preset;
use boresight_core::{Array, InputError, Waveform};
use boresight_neural::{Card, Kind, Model, Port};
use boresight_options::{Described, Named};
use boresight_pipeline::{Chain, ChainOptions};
use boresight_wasm::bytes::Bytes;
use boresight_wasm::capture::{Capture, process_cube_by};
use boresight_wasm::carry;
use boresight_wasm::complex::Cube;
use boresight_wasm::error::Fallible;
use boresight_wasm::estimate::{Estimator, Input, shape_error};
use boresight_wasm::read::{Fields, Read};
use js_sys::Function;
use ndarray::ArrayView3;
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// What a network is.
#[derive(Described, Serialize)]
pub struct NetworkDescription<'a> {
    /// An estimator, or one that counts sources.
    kind: Kind,
    /// The method it is estimated with; null for a counting network.
    method: Option<Method>,
    /// Its name on its card, or that of its kind.
    name: &'a str,
    /// What goes in.
    inputs: &'a [Port],
    /// What comes out.
    outputs: &'a [Port],
}

/// A model, and the estimator its options make of it.
#[wasm_bindgen]
pub struct Network {
    pub(crate) model: Model,
    /// What a counting network estimates angles by.
    method: Option<Method>,
    options: EstimatorOptions,
    array: Option<Array>,
    /// Made when it is first asked for.
    estimator: Option<Estimator>,
}

#[wasm_bindgen]
impl Network {
    /// Loads an ONNX file, checks it against its card if there is one, and reads the options of its
    /// estimates.
    #[wasm_bindgen(constructor)]
    pub fn new(onnx: &JsValue, card: &JsValue, options: &JsValue) -> Fallible<Self> {
        construct();
        let onnx = Bytes::read(onnx, "onnx")?.0;
        let card = match card.is_undefined() {
            true => None,
            false => Some(Card::from_json(String::read(card, "card")?.as_bytes())?),
        };
        let model = Model::load(&onnx, card.as_ref())?;
        let unset = EstimatorOptions::default();
        let mut network =
            Self { model, method: None, options: unset, array: None, estimator: None };
        network.set_options(options)?;
        Ok(network)
    }

    /// Changes the options of its estimates.
    #[wasm_bindgen(js_name = setOptions)]
    pub fn set_options(&mut self, options: &JsValue) -> Fallible<()> {
        let mut fields = Fields::of_optional(options)?;
        let method = fields.optional("method")?;
        let array = fields.optional("array")?;
        let options: EstimatorOptions = fields.spread()?;
        fields.finish()?;
        options.check()?;
        self.check_method(method)?;
        (self.method, self.array, self.options, self.estimator) = (method, array, options, None);
        Ok(())
    }

    /// What it is: kind, method, name, inputs and outputs.
    pub fn describe(&self) -> JsValue {
        let kind = self.model.kind();
        carry::write(&NetworkDescription {
            kind,
            method: kind.method(),
            name: self.model.card().map_or(kind.name(), |card| &card.name),
            inputs: self.model.inputs(),
            outputs: self.model.outputs(),
        })
    }

    /// Estimates the angles in `{ snapshots }` or `{ covariance, snapshotCount }`.
    pub fn estimate(&mut self, input: &JsValue) -> Fallible<JsValue> {
        self.estimator()?.estimate(input)
    }

    /// Estimates the angles in every cell of `{ snapshots }`.
    #[wasm_bindgen(js_name = estimateBatch)]
    pub fn estimate_batch(&mut self, input: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        self.estimator()?.estimate_batch(input, options)
    }

    /// Counts sources.
    pub fn count(&mut self, input: &JsValue) -> Fallible<JsValue> {
        let input = Input::read(input, "input")?;
        Ok(carry::write(&self.model.count(input.data()?)?))
    }

    /// Estimates from the range bins around a peak: bins x elements x chirps.
    #[wasm_bindgen(js_name = estimateRegion)]
    pub fn estimate_region(&mut self, region: &JsValue) -> Fallible<JsValue> {
        let Cube { data, shape } = Cube::read(region, "region")?;
        let wrong = || shape_error("region", "[bins, elements, chirps]", &shape);
        let [bins, elements, chirps] = shape[..] else { return Err(wrong()) };
        let view = ArrayView3::from_shape((bins, elements, chirps), &data).map_err(|_| wrong())?;
        let array = self.array()?;
        Ok(carry::write(&self.model.estimate_region(view, &array, &self.options)?))
    }

    /// Runs the graph as it is: tensors by name to tensors by name.
    pub fn run(&mut self, inputs: &JsValue) -> Fallible<JsValue> {
        let inputs = read_tensors(inputs)?;
        let views: Vec<_> =
            inputs.iter().map(|(name, array)| (name.as_str(), array.view())).collect();
        Ok(tensors_object(&self.model.run(&views)?))
    }

    /// Detections of each frame of a cube, angles by this network.
    #[wasm_bindgen(js_name = processCube)]
    pub fn process_cube(&self, cube: &JsValue, options: &JsValue) -> Fallible<js_sys::Array> {
        process_cube_by(&|w, r, a, o| self.chain(w, r, a, o), cube, options)
    }

    /// Detections of each frame of a capture, or of one.
    #[wasm_bindgen(js_name = processFrames)]
    pub fn process_frames(
        &self,
        bytes: &JsValue,
        config: &JsValue,
        options: &JsValue,
        frame: &JsValue,
    ) -> Fallible<js_sys::Array> {
        let mut capture = Capture::new(bytes, config)?;
        let frames = capture.read_frames(frame)?;
        capture.process_frames_by(&|w, r, a, o| self.chain(w, r, a, o), frames, options)
    }

    /// Detections of several frames of a capture together; see `Capture.combineFrames`.
    #[wasm_bindgen(js_name = combineFrames)]
    pub fn combine_frames(
        &self,
        bytes: &JsValue,
        config: &JsValue,
        options: &JsValue,
        report: Option<Function>,
    ) -> Fallible<JsValue> {
        let mut capture = Capture::new(bytes, config)?;
        capture.combine_frames_by(&|w, r, a, o| self.chain(w, r, a, o), options, report)
    }
}

impl Network {
    fn estimator(&mut self) -> Fallible<&mut Estimator> {
        let estimator = match self.estimator.take() {
            Some(estimator) => estimator,
            None => {
                let array = self.array()?;
                match self.method.filter(|_| self.model.kind() == Kind::Counting) {
                    Some(method) => {
                        let counter = self.model.counter()?;
                        aoa::Estimator::counted(method, &array, &self.options, &counter)?.into()
                    }
                    None => self.model.estimator(&array, &self.options)?.into(),
                }
            }
        };
        Ok(self.estimator.insert(estimator))
    }

    /// A method that is named has to be the network's. A counting network counts the sources of those that need none.
    fn check_method(&self, method: Option<Method>) -> Fallible<()> {
        let counts = self.model.kind() == Kind::Counting;
        match method.filter(|method| !(counts && Method::ALL.contains(method))) {
            Some(method) if self.model.kind().method() != Some(method) => {
                let expected = self.model.kind().method().map_or("none", Method::name);
                let (what, given) = ("method".into(), method.name().into());
                Err(InputError::Unknown { what, expected: expected.into(), given }.into())
            }
            _ => Ok(()),
        }
    }

    /// The array asked for, or else the one the network was trained on.
    fn array(&self) -> Fallible<Array> {
        if let Some(array) = &self.array {
            return Ok(array.clone());
        }
        let kind = self.model.kind();
        if let (true, None, Some(method)) =
            (kind.answers_target_set(), self.model.elements(), kind.method())
        {
            return Err(aoa::AoaError::Array {
                method: method.name(),
                expected: "the array that took the snapshots, for this network takes any".into(),
                given: "is missing".into(),
            }
            .into());
        }
        let usual = if kind.answers_target_set() { "lrr48" } else { "ula8" };
        let trained = self.model.card().and_then(|card| card.data.array.as_deref());
        Ok(preset(trained.unwrap_or(usual))?)
    }

    /// The chain with this network, by the options of the chain's angles.
    fn chain(
        &self,
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &ChainOptions,
    ) -> Fallible<Chain> {
        self.check_method(Some(options.angle.method).filter(|method| *method != Method::Bartlett))?;
        if self.model.kind() == Kind::Counting {
            let counter = self.model.counter()?;
            return Ok(Chain::counted(waveform, receivers, array, options, &counter)?);
        }
        let estimator = self.model.estimator(array, &options.angle.options)?;
        let estimators = Estimators::of(vec![estimator])?;
        Ok(Chain::with_estimators(waveform, receivers, array, options, estimators)?)
    }
}
