//! Spectra over a grid of directions, and their peaks.

pub(crate) mod dense_grid;
pub(crate) mod lags;
pub(crate) mod null_spectrum;
pub(crate) mod peaks;
pub(crate) mod quadratic;
