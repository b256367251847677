//! Angle-of-arrival estimators behind one interface, source counting and Cramer-Rao bounds.
//!
//! [`Estimator::new`] takes a method, an array and options and checks that they go together;
//! [`Estimator::estimate`] takes snapshots or a covariance and returns an [`Estimate`];
//! [`Estimator::estimate_batch`] takes the snapshots of many cells and returns a [`BatchEstimate`].

mod bartlett;
pub mod batch;
pub mod bounds;
mod capon;
mod checks;
mod cosines;
pub mod counting;
mod covariance;
pub mod data;
mod dense_grid;
pub mod error;
mod esprit;
pub mod esprit_error;
pub mod estimate;
pub mod estimator;
pub mod estimators;
mod false_alarm;
pub mod gauss_newton;
pub mod grid;
mod iaa;
mod lags;
mod maximum_likelihood;
pub mod method;
mod min_norm;
mod music;
mod nomp;
mod normalised;
mod null_spectrum;
pub mod options;
mod peaks;
mod powers;
mod quadratic;
pub mod refinement;
mod root_music;
mod single_snapshot_music;
mod sparse_bayesian;
mod subspace;
pub mod suits;

pub use batch::{BatchEstimate, Spectra, WarningCount};
pub use checks::settle;
pub use data::Data;
pub use error::AoaError;
pub use estimate::{Estimate, Source, Spectrum, SpectrumKind, Warning};
pub use estimator::Estimator;
pub use estimators::Estimators;
pub use grid::Grid;
pub use method::{Method, Requirements};
pub use options::{Options, SourceCount};
pub use powers::sources_at;
