//! Trained networks: from a file, and in the place of other methods.

use crate::arguments::ModelArguments;
use crate::error::CliError;
use crate::files::Files;
use boresight_aoa::{CountSources, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::{Array, Waveform};
use boresight_neural::{Card, Model, NeuralError};
use boresight_options::Named;
use boresight_pipeline::{Chain, ChainOptions};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model and, unless another is named, the card beside it, if there is one.
pub fn load(path: &Path, card: Option<&Path>, files: &Files) -> Result<Model, CliError> {
    let beside = path.with_extension("json");
    let card_path = card.map(Path::to_owned).or_else(|| beside.is_file().then_some(beside));
    let card = match &card_path {
        Some(path) => {
            Some(Card::from_json(&files.read(path)?).map_err(|error| wrong(path, error))?)
        }
        None => None,
    };
    Model::load(&files.read(path)?, card.as_ref()).map_err(|error| wrong(path, error))
}

/// The error of a model, with its file.
pub fn wrong(path: &Path, error: NeuralError) -> CliError {
    CliError::Model { path: path.into(), error: Box::new(error) }
}

/// The model for a method, if that is a network, and its file.
pub fn model_for(
    method: Method,
    arguments: &ModelArguments,
    files: &Files,
) -> Result<Option<(Model, PathBuf)>, CliError> {
    if !Method::NETWORKS.contains(&method) {
        return Ok(None);
    }
    let path = arguments.model.as_ref().ok_or_else(|| CliError::Option {
        option: "--model",
        expected: format!("a trained model (.onnx), since {} is a network", method.name()),
        given: "nothing".into(),
    })?;
    let model = load(path, arguments.card.as_deref(), files)?;
    if model.kind().method() != Some(method) {
        let given = model.kind().name();
        return Err(wrong(path, NeuralError::WrongKind { expected: method.name(), given }));
    }
    Ok(Some((model, path.clone())))
}

/// What counts the sources where a network is to, if one is given.
fn counter_for(
    arguments: &ModelArguments,
    files: &Files,
) -> Result<Option<Arc<dyn CountSources>>, CliError> {
    let Some(path) = &arguments.counting_model else { return Ok(None) };
    let counter = load(path, None, files)?.counter();
    counter.map(Some).map_err(|error| wrong(path, error))
}

/// Says which flag is missing where sources are to be counted by a network and there is none.
fn check_counter(
    options: &EstimatorOptions,
    counter: Option<&Arc<dyn CountSources>>,
) -> Result<(), CliError> {
    if options.sources != SourceCount::Network || counter.is_some() {
        return Ok(());
    }
    Err(CliError::Option {
        option: "--counting-model",
        expected: "a counting network (.onnx), which --sources network calls for".into(),
        given: "nothing".into(),
    })
}

/// An estimator by any method.
pub fn estimator(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
    arguments: &ModelArguments,
    files: &Files,
) -> Result<Estimator, CliError> {
    let counter = counter_for(arguments, files)?;
    check_counter(options, counter.as_ref())?;
    match (model_for(method, arguments, files)?, counter) {
        (None, None) => Ok(Estimator::new(method, array, options)?),
        (None, Some(counter)) => Ok(Estimator::counted(method, array, options, &counter)?),
        (Some((model, path)), counter) => {
            let estimator = match &counter {
                None => model.estimator(array, options),
                Some(counter) => model.counted_estimator(array, options, counter),
            };
            estimator.map_err(|error| wrong(&path, error))
        }
    }
}

/// A chain by any method.
pub fn chain(
    waveform: &Waveform,
    receivers: usize,
    array: &Array,
    options: &ChainOptions,
    arguments: &ModelArguments,
    files: &Files,
) -> Result<Chain, CliError> {
    let counter = counter_for(arguments, files)?;
    let (angle, threads) = (&options.angle.options, options.threads);
    check_counter(angle, counter.as_ref())?;
    match (model_for(options.angle.method, arguments, files)?, counter) {
        (None, None) => Ok(Chain::new(waveform, receivers, array, options)?),
        (None, Some(counter)) => Ok(Chain::counted(waveform, receivers, array, options, &counter)?),
        (Some((model, path)), counter) => {
            let estimators = match &counter {
                None => model.estimators(array, angle, threads),
                Some(counter) => model.counted_estimators(array, angle, threads, counter),
            };
            let estimators = estimators.map_err(|error| wrong(&path, error))?;
            Ok(Chain::with_estimators(waveform, receivers, array, options, estimators)?)
        }
    }
}
