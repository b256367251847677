//! Angle-of-arrival estimators behind one interface, source counting and Cramer-Rao bounds.
//!
//! [`Estimator::new`] takes a method, an array and options and checks that they go together;
//! [`Estimator::estimate`] takes snapshots or a covariance and returns an [`Estimate`];
//! [`Estimator::estimate_batch`] takes the snapshots of many cells and returns a [`BatchEstimate`].
//!
//! # Example
//!
//! ```
//! use boresight_aoa::{Data, Estimator, Method, EstimatorOptions, SourceCount};
//! use boresight_core::steering::steering_matrix;
//! use boresight_core::{Array, Complex64, Direction};
//! use ndarray::array;
//!
//! // Two waves in two snapshots, in phase and out of phase.
//! let array = Array::ula(8)?;
//! let truth = [-10.0_f64, 15.0].map(|degrees| Direction::azimuth(degrees.to_radians()));
//! let signals = array![[1.0, 1.0], [1.0, -1.0]].mapv(Complex64::from);
//! let snapshots = steering_matrix(&array, &truth).dot(&signals);
//!
//! let options = EstimatorOptions { sources: SourceCount::Known(2), ..EstimatorOptions::default() };
//! let mut estimator = Estimator::new(Method::RootMusic, &array, &options)?;
//! let estimate = estimator.estimate(Data::Snapshots(snapshots.view()))?;
//! let mut found: Vec<f64> = estimate.sources.iter().map(|s| s.direction.azimuth_rad).collect();
//! found.sort_by(f64::total_cmp);
//! for (found, truth) in found.iter().zip(truth) {
//!     assert!((found - truth.azimuth_rad).abs() < 1e-6);
//! }
//! assert_eq!(found.len(), 2);
//! # Ok::<(), boresight_aoa::AoaError>(())
//! ```

pub mod batch;
pub mod bounds;
mod checks;
mod cost;
pub mod data;
pub mod error;
pub mod estimate;
pub mod estimator;
pub(crate) mod estimators;
pub mod grid;
pub mod method;
mod model;
pub mod options;
pub mod order;
pub mod plan;
pub mod range_angle;
pub mod refinement;
#[cfg(test)]
#[path = "../../../tests/support/size.rs"]
mod size;
mod spectra;
pub mod suits;

pub use batch::columns::{BatchColumns, SpectraColumns};
pub use batch::threads::Estimators;
pub use batch::{BatchEstimate, Spectra, WarningCount};
pub use checks::settle;
pub use data::Data;
pub use error::AoaError;
pub use estimate::{Deviation, Estimate, Source, Spectrum, SpectrumKind, Warning};
pub use estimator::Estimator;
pub use grid::Grid;
pub use method::{Method, Requirements};
pub use model::powers::sources_at;
pub use options::{EstimatorOptions, SourceCount};
pub use order::counted::{CountSources, Counted, SourceProbabilities};
pub use plan::Plan;
pub use range_angle::{RangeAngle, RangeAngleEstimate, RangeAngleTarget};
pub use spectra::peaks::{Peak, PeakFinder};
