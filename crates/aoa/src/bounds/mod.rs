//! Cramer-Rao bounds of angles (Stoica and Nehorai 1989, 1990), for any array.
//!
//! With steering matrix `A`, its derivatives `D` by every angle, signal covariance `P`, noise
//! power `s` and `N` snapshots the Fisher information of the angles is
//! `F = (2 N / s) Re((D^H Q D) o M^T)`, where `Q` projects onto the complement of `A`. `M` is `P`
//! itself when the signals are unknown constants (deterministic) and `P A^H R^-1 A P` when they
//! are Gaussian (stochastic), each repeated for azimuth and elevation.

pub mod esprit_error;

use crate::error::AoaError;
use boresight_core::limits::check_operations;
use boresight_core::steering::{steering_derivatives, steering_matrix};
use boresight_core::{Array, Complex64, Direction, Extent, InputError};
use boresight_math::decibels::{db_to_amplitude, db_to_power};
use boresight_math::error::{check_finite, check_positive};
use boresight_math::linalg::{Cholesky, adjoint, least_squares};
use boresight_math::phasor::cis;
use boresight_options::{Described, Flat, columns};
use ndarray::{Array1, Array2, ArrayView2};
use serde::{Deserialize, Serialize};

/// Lower bound of the error of unbiased estimators.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Bound {
    /// Standard deviation of each source's azimuth; infinite where the data do not determine the
    /// angles.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: Vec<f64>,
    /// Of each elevation; absent where the array sees none.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub elevation_rad: Option<Vec<f64>>,
    /// Covariance of all azimuths, then all elevations, rad^2; infinite where `azimuth_rad` is.
    #[serde(skip)]
    pub covariance: Array2<f64>,
}

/// A target of a bound.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
pub struct BoundTarget {
    /// Where it is.
    #[serde(default)]
    pub direction: Flat<Direction>,
    /// Its power over that of the noise, at one element.
    #[option(range = -300..=300)]
    pub snr_db: f64,
    /// Phase of its amplitude; counts for the deterministic bound of a single snapshot.
    #[serde(default)]
    pub phase_rad: f64,
}

/// What a bound holds the signals for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[option(name = "BoundKind")]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// Unknown constants.
    #[default]
    Deterministic,
    /// Gaussian, of unknown covariance.
    Stochastic,
}

/// Data that a bound is of, beside array and targets.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct BoundRequest {
    /// Snapshots.
    #[option(default = 1, range = 1.., required)]
    pub snapshots: usize,
    /// What it holds the signals for.
    pub kind: Model,
}

/// Bound of the angles of uncorrelated targets; the deterministic one of a single snapshot is of just
/// these phases.
///
/// # Errors
/// As [`deterministic_bound`].
pub fn target_bound(
    array: &Array,
    targets: &[BoundTarget],
    options: &BoundRequest,
) -> Result<Bound, AoaError> {
    let directions: Vec<Direction> = targets.iter().map(|target| *target.direction).collect();
    let BoundRequest { snapshots, kind } = *options;
    let covariance = if snapshots == 1 && kind == Model::Deterministic {
        let amplitude = |t: &BoundTarget| cis(t.phase_rad) * db_to_amplitude(t.snr_db);
        single_snapshot(&targets.iter().map(amplitude).collect::<Vec<_>>())
    } else {
        uncorrelated(&targets.iter().map(|t| db_to_power(t.snr_db)).collect::<Vec<_>>())
    };
    let signals = Signals { covariance: covariance.view(), noise_power: 1.0, snapshots };
    match kind {
        Model::Deterministic => deterministic_bound(array, &directions, &signals),
        Model::Stochastic => stochastic_bound(array, &directions, &signals),
    }
}

/// Deviations from here on are an infinite one and rounding: no noise that a radar meets makes such.
const UNDETERMINED_RAD: f64 = 1e9;

/// What is known of the signals.
#[derive(Debug, Clone, Copy)]
pub struct Signals<'a> {
    /// Sources x sources covariance of the signals at one element; their sample covariance
    /// `S S^H / N` for the deterministic bound.
    pub covariance: ArrayView2<'a, Complex64>,
    /// Noise power at one element.
    pub noise_power: f64,
    /// Number of snapshots.
    pub snapshots: usize,
}

impl Signals<'_> {
    pub(crate) fn check(&self, array: &Array, directions: &[Direction]) -> Result<(), AoaError> {
        if directions.is_empty() || self.snapshots == 0 {
            let what = if directions.is_empty() { "directions" } else { "snapshots" };
            let expected = "at least one".into();
            return Err(InputError::Empty { what: what.into(), expected }.into());
        }
        directions.iter().try_for_each(|direction| direction.check())?;
        let count = directions.len();
        if count >= array.len() {
            let most = array.len() - 1;
            return Err(AoaError::TooManySources { method: "the bound", most, given: count });
        }
        if self.covariance.dim() != (count, count) {
            return Err(AoaError::Argument(InputError::Shape {
                what: "signal covariance".into(),
                expected: format!("[{count}, {count}], one row a direction"),
                given: self.covariance.shape().to_vec(),
            }));
        }
        let (sources, elements) = (count as f64, array.len() as f64);
        // With elevations there are twice as many angles.
        let angles = 2.0 * sources;
        check_operations("the bound", 3.0 * angles.powi(3) + 2.0 * elements * angles.powi(2))?;
        check_finite("signal covariance", self.covariance.iter().flat_map(|z| [z.re, z.im]))?;
        Ok(check_positive("noise_power", self.noise_power)?)
    }
}

/// Covariance of uncorrelated signals of the given powers.
pub fn uncorrelated(powers: &[f64]) -> Array2<Complex64> {
    let diagonal: Array1<Complex64> = powers.iter().map(|&p| Complex64::new(p, 0.0)).collect();
    Array2::from_diag(&diagonal)
}

/// Sample covariance of one snapshot of signals with these amplitudes.
pub fn single_snapshot(amplitudes: &[Complex64]) -> Array2<Complex64> {
    Array2::from_shape_fn((amplitudes.len(), amplitudes.len()), |(i, k)| {
        amplitudes[i] * amplitudes[k].conj()
    })
}

/// Bound for signals that are unknown constants.
///
/// # Errors
/// [`InputError`] for empty, misshapen or non-finite arguments, [`AoaError::TooManySources`] unless
/// there are fewer directions than elements.
pub fn deterministic_bound(
    array: &Array,
    directions: &[Direction],
    signals: &Signals<'_>,
) -> Result<Bound, AoaError> {
    signals.check(array, directions)?;
    bound(array, directions, signals, Some(signals.covariance.to_owned()))
}

/// Bound for Gaussian signals of unknown covariance.
///
/// # Errors
/// As [`deterministic_bound`].
pub fn stochastic_bound(
    array: &Array,
    directions: &[Direction],
    signals: &Signals<'_>,
) -> Result<Bound, AoaError> {
    signals.check(array, directions)?;
    let steering = steering_matrix(array, directions);
    let gram = adjoint(steering.view()).dot(&steering);
    // P A^H R^-1 A P = P (P + s (A^H A)^-1)^-1 P, which also stands without noise.
    let information = Cholesky::new(gram.view()).ok().and_then(|gram| {
        let power = &signals.covariance;
        let noisy = power + gram.inverse().mapv(|z| z * signals.noise_power);
        Some(power.dot(&Cholesky::new(noisy.view()).ok()?.inverse()).dot(power))
    });
    bound(array, directions, signals, information)
}

fn bound(
    array: &Array,
    directions: &[Direction],
    signals: &Signals<'_>,
    information: Option<Array2<Complex64>>,
) -> Result<Bound, AoaError> {
    let count = directions.len();
    let angles = if array.extent() == Extent::Area { 2 * count } else { count };
    let covariance = match (information, slopes_off_signal(array, directions, angles)?) {
        (Some(information), Some(slopes)) => {
            let scale = 2.0 * signals.snapshots as f64 / signals.noise_power;
            let fisher = Array2::from_shape_fn((angles, angles), |(i, k)| {
                scale * (slopes[[i, k]] * information[[k % count, i % count]]).re
            });
            inverse(&fisher)
        }
        _ => None,
    };
    let covariance =
        covariance.unwrap_or_else(|| Array2::from_elem((angles, angles), f64::INFINITY));
    // Along an array the phases do not change with the angle, but for rounding.
    let deviation = |i: usize| {
        let deviation = covariance[[i, i]].sqrt();
        if deviation < UNDETERMINED_RAD { deviation } else { f64::INFINITY }
    };
    Ok(Bound {
        azimuth_rad: (0..count).map(deviation).collect(),
        elevation_rad: (angles > count).then(|| (count..angles).map(deviation).collect()),
        covariance,
    })
}

/// `D^H Q D`; nothing if two steering vectors are the same.
fn slopes_off_signal(
    array: &Array,
    directions: &[Direction],
    angles: usize,
) -> Result<Option<Array2<Complex64>>, InputError> {
    let steering = steering_matrix(array, directions);
    let mut slopes = Array2::zeros((array.len(), angles));
    for (i, &direction) in directions.iter().enumerate() {
        let (by_azimuth, by_elevation) = steering_derivatives(array, direction);
        slopes.column_mut(i).assign(&by_azimuth);
        if angles > directions.len() {
            slopes.column_mut(directions.len() + i).assign(&by_elevation);
        }
    }
    let fitted = least_squares(steering.view(), slopes.view())?;
    Ok(fitted.map(|x| adjoint(slopes.view()).dot(&(&slopes - &steering.dot(&x)))))
}

/// Inverse of a positive definite matrix, scaled to a unit diagonal on the way; nothing if it is
/// singular to working precision.
fn inverse(matrix: &Array2<f64>) -> Option<Array2<f64>> {
    let scale: Vec<f64> = matrix.diag().iter().map(|x| x.sqrt()).collect();
    if scale.iter().any(|x| x.is_nan() || *x <= 0.0) {
        return None;
    }
    let unit = Array2::from_shape_fn(matrix.dim(), |(i, k)| {
        Complex64::new(matrix[[i, k]] / (scale[i] * scale[k]), 0.0)
    });
    let factor = Cholesky::new(unit.view()).ok()?;
    if factor.diagonal().any(|pivot| pivot < 1e-7) {
        return None;
    }
    let inverse = factor.inverse();
    Some(Array2::from_shape_fn(matrix.dim(), |(i, k)| inverse[[i, k]].re / (scale[i] * scale[k])))
}
