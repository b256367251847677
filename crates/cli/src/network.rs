//! Trained networks: from a file, and in the place of other methods.

use crate::error::CliError;
use crate::files;
use boresight_neural::{Card, Model, NeuralError};
use std::path::Path;

/// A model and, unless another is named, the card beside it, if there is one.
pub fn load(path: &Path, card: Option<&Path>) -> Result<Model, CliError> {
    let beside = path.with_extension("json");
    let card_path = card.map(Path::to_owned).or_else(|| beside.is_file().then_some(beside));
    let card = match &card_path {
        Some(path) => {
            Some(Card::from_json(&files::read(path)?).map_err(|error| wrong(path, error))?)
        }
        None => None,
    };
    Model::load(&files::read(path)?, card.as_ref()).map_err(|error| wrong(path, error))
}

fn wrong(path: &Path, error: NeuralError) -> CliError {
    CliError::Model { path: path.into(), error: Box::new(error) }
}
