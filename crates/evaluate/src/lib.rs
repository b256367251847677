//! Experiments: estimators over many simulated scenes, and what comes of it as tables and figures.
//!
//! This is about how right answers are, and the same on every machine. How fast they come is measured by `npm run bench`
//! and the crates' benches, and belongs to a machine. Words of its own are in `docs/glossary.md`.
//!
//! A scene depends on the seed and its own number only, so a run can be stopped and taken up again, spread
//! over threads, or split by scene numbers over machines.

pub mod aoa;
pub mod calibration;
pub mod doa;
pub mod entrants;
pub mod error;
pub mod experiment;
pub mod images;
pub mod imperfections;
mod merge;
mod plot;
pub mod resolution;
pub mod statistics;
pub mod sweep;
mod table;
mod told;

pub use entrants::{Entrants, Network};
pub use error::EvaluateError;
pub use merge::{Merged, Outcome, merge};
