//! Trained networks that estimate angles and count targets, read from ONNX files and run by tract.
//!
//! [`Model::load`] takes a file's bytes and, if there is one, its [`Card`], and checks both;
//! [`Model::estimator`] makes an [`boresight_aoa::Estimator`] of it like any other,
//! [`Model::count`] counts targets, [`Model::run`] runs the network on plain arrays.
//!
//! # Example
//!
//! ```
//! use boresight_aoa::{Data, EstimatorOptions};
//! use boresight_core::presets::preset;
//! use boresight_core::steering::steering_matrix;
//! use boresight_core::{Complex64, Direction};
//! use boresight_neural::{Card, Model};
//! use ndarray::Array2;
//!
//! let card = Card::from_json(&std::fs::read("../../models/learned-pursuit.json")?)?;
//! let model = Model::load(&std::fs::read("../../models/learned-pursuit.onnx")?, Some(&card))?;
//!
//! let array = preset("lrr48")?;
//! let truth = Direction::azimuth(12_f64.to_radians());
//! let snapshot = steering_matrix(&array, &[truth]).dot(&Array2::from_elem((1, 1), Complex64::ONE));
//! let options = EstimatorOptions { field_of_view_rad: 60_f64.to_radians(), ..EstimatorOptions::default() };
//! let estimate = model.estimator(&array, &options)?.estimate(Data::Snapshots(snapshot.view()))?;
//! assert_eq!(estimate.sources.len(), 1);
//! let error_rad = estimate.sources[0].direction.azimuth_rad - truth.azimuth_rad;
//! assert!(error_rad.abs() < 0.2_f64.to_radians(), "a fifth of the beam's width, 1 deg");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod card;
mod classifier;
mod convolution;
mod dense;
mod engine;
pub mod error;
mod estimators;
mod features;
mod few_rows;
mod function;
mod fused;
mod line;
mod model;
mod onnx;
mod ports;
mod product;
mod regions;
mod snapshots;
mod softmax;
mod spectrum;
mod target_set;

pub use card::{Axis, Card, Kind, Port};
pub use error::NeuralError;
pub use features::{COVARIANCE_FEATURES, covariance_features};
pub use model::Model;
pub use regions::{REGION_FIELD_OF_VIEW_RAD, RegionNetworks};
