//! Experiments: estimators over many simulated scenes, and what comes of it as tables and figures.
//!
//! This is about how right answers are, and the same on every machine. How fast they come is measured by `npm run bench`
//! and the crates' benches, and belongs to a machine. Words of its own are in `docs/glossary.md`.
//!
//! A scene depends on the seed and its own number only, so a run can be stopped and taken up again, spread
//! over threads, or split by scene numbers over machines.
//!
//! # Example
//!
//! ```
//! use boresight_validate::experiment::{How, run};
//! use boresight_experiments::resolution::{ResolutionExperiment, SEPARATIONS};
//! use std::ops::ControlFlow;
//!
//! // Two targets ever farther apart: how often does a method see two?
//! let options = ResolutionExperiment { array: "ula8".into(), snapshots: vec![1], trials: 2, seed: 1 };
//! let how = How { threads: 1, folder: None };
//! let report = run(&options, how, |_| ControlFlow::Continue(()))?;
//! let beams = report.conditions[0].methods.iter().find(|method| method.name == "bartlett");
//! let resolved = beams.map(|method| method.resolved.clone()).unwrap_or_default();
//! assert_eq!(resolved.len(), SEPARATIONS.len());
//! assert_eq!(resolved[0], 0.0, "a twentieth of a beam width apart they are one");
//! # Ok::<(), boresight_experiments::EvaluateError>(())
//! ```

pub mod aoa;
mod apart;
pub mod arrays;
pub mod calibration;
mod deviation;
pub mod doa;
pub mod entrants;
pub mod error;
pub mod hard;
pub mod images;
pub mod imperfections;
pub mod low_snr;
mod merge;
pub mod near_field;
pub mod resolution;
pub mod straddling;
mod told;

pub use entrants::{Entrants, Network};
pub use error::EvaluateError;
pub use merge::merge;
