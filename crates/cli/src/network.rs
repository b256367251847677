//! Trained networks: from a file, and in the place of other methods.

use crate::arguments::ModelArguments;
use crate::error::CliError;
use crate::files::Files;
use boresight_aoa::{Estimator, EstimatorOptions, Method};
use boresight_core::describe::Named;
use boresight_core::{Array, Waveform};
use boresight_neural::{Card, Model, NeuralError};
use boresight_pipeline::{Chain, ChainOptions};
use std::path::{Path, PathBuf};

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

/// An estimator by any method.
pub fn estimator(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
    arguments: &ModelArguments,
    files: &Files,
) -> Result<Estimator, CliError> {
    match model_for(method, arguments, files)? {
        None => Ok(Estimator::new(method, array, options)?),
        Some((model, path)) => model.estimator(array, options).map_err(|error| wrong(&path, error)),
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
    match model_for(options.angle.method, arguments, files)? {
        None => Ok(Chain::new(waveform, receivers, array, options)?),
        Some((model, path)) => {
            let estimators = model.estimators(array, &options.angle.options, options.threads);
            let estimators = estimators.map_err(|error| wrong(&path, error))?;
            Ok(Chain::with_estimators(waveform, receivers, array, options, estimators)?)
        }
    }
}
