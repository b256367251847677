//! What estimators share of the signal model: directions, data as they are given, covariances, powers.

pub(crate) mod coincident;
pub(crate) mod cosines;
pub(crate) mod covariance;
pub(crate) mod normalised;
pub(crate) mod powers;
pub(crate) mod subspace;
