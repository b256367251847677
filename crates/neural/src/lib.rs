//! Trained networks that estimate angles and count targets, read from ONNX files and run by tract.
//!
//! [`Model::load`] takes a file's bytes and, if there is one, its [`Card`], and checks both;
//! [`Model::estimator`] makes an [`boresight_aoa::Estimator`] of it like any other,
//! [`Model::count`] counts targets, [`Model::run`] runs the network on plain arrays.

mod aaetr;
pub mod card;
mod classifier;
mod convolution;
mod dense;
mod engine;
pub mod error;
mod features;
mod function;
mod fused;
mod model;
mod onnx;
mod product;

pub use card::{Axis, Card, Kind, Port};
pub use error::NeuralError;
pub use features::{COVARIANCE_FEATURES, covariance_features};
pub use model::{Model, SourceProbabilities};
