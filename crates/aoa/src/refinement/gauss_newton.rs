//! Gauss-Newton refinement of all directions and amplitudes of a matched model together.
//!
//! The model is `y_n = A(directions) s_n + noise`. For given directions the best amplitudes are
//! `A^+ y_n`; with them eliminated, a step over directions and amplitudes becomes one over
//! directions alone (Golub and Pereyra 1973, Kaufman 1975), from the residual `P y`, with `P` the
//! projection away from `A`, and the derivatives `P a'`. Steps are damped where they would not
//! lower the residual power (Levenberg 1944, Marquardt 1963), so that the fit never gets worse.
//! What it converges to is a local maximum of the deterministic likelihood.

use crate::data::Data;
use crate::model::cosines::{Geometry, Point, Steering};
use boresight_core::{Array, Complex64, Direction, InputError};
use boresight_math::linalg::{Cholesky, adjoint};
use ndarray::{Array1, Array2, ArrayView1};

/// When refinement ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most steps.
    pub iterations: usize,
    /// Change of every direction cosine below which it has converged.
    pub tolerance: f64,
}

/// Outcome of a refinement.
#[derive(Debug, Clone, PartialEq)]
pub struct Refined {
    /// Directions, in the order given.
    pub directions: Vec<Direction>,
    /// Mean power, summed over the elements, that the model leaves unexplained.
    pub residual_power: f64,
    /// Steps done.
    pub iterations: usize,
    /// Whether the last step was below the tolerance.
    pub converged: bool,
}

/// Refines directions on snapshots or a covariance; the matching amplitudes are those of least
/// squares at the directions returned. On arrays that span an area elevation is refined as well.
///
/// Directions that cannot be told apart, or more of them than elements, are returned as they are,
/// not converged, with all of the power as residual.
///
/// # Errors
/// As [`Data::check`]; [`InputError::OutOfRange`] for a direction more than a quarter turn off
/// boresight; [`InputError::Empty`] for none.
pub fn refine(
    array: &Array,
    directions: &[Direction],
    data: Data<'_>,
    limits: Limits,
) -> Result<Refined, crate::error::AoaError> {
    data.check(array.len())?;
    if directions.is_empty() {
        return Err(InputError::Empty {
            what: "directions to refine".into(),
            expected: "at least one".into(),
        }
        .into());
    }
    for direction in directions {
        direction.check()?;
    }
    let geometry = Geometry::new(array);
    let points: Vec<Point> = directions.iter().map(|&d| geometry.point(d)).collect();
    let (points, outcome) = refine_points(&geometry, points, data, limits);
    let directions = points.iter().map(|&p| geometry.direction(p)).collect();
    Ok(Refined { directions, ..outcome })
}

/// The same on direction cosines; `directions` of the outcome is left empty.
pub(crate) fn refine_points(
    geometry: &Geometry,
    mut points: Vec<Point>,
    data: Data<'_>,
    limits: Limits,
) -> (Vec<Point>, Refined) {
    let total = total_power(data);
    let mut outcome =
        Refined { directions: Vec::new(), residual_power: total, iterations: 0, converged: false };
    let Some(mut fit) = Fit::new(geometry, &points, data, total) else {
        return (points, outcome);
    };
    let mut damping = 0.0;
    while outcome.iterations < limits.iterations && !outcome.converged {
        outcome.iterations += 1;
        let system = fit.normal_equations(geometry.axes);
        let mut accepted = false;
        for _ in 0..10 {
            let Some(steps) = system.step(damping, geometry) else {
                damping = (10.0 * damping).max(1e-4);
                continue;
            };
            let largest = steps.iter().flatten().fold(0.0f64, |m, s| m.max(s.abs()));
            let next: Vec<Point> =
                points.iter().zip(&steps).map(|(&p, &s)| geometry.moved(p, s)).collect();
            let there = Fit::new(geometry, &next, data, total);
            // To rounding the residual may rise at the very end.
            match there.filter(|there| there.residual <= fit.residual + 1e-13 * total) {
                Some(there) => {
                    accepted = true;
                    outcome.converged = largest < limits.tolerance;
                    damping *= 0.1;
                    if damping < 1e-7 {
                        damping = 0.0;
                    }
                    points = next;
                    fit = there;
                    break;
                }
                // Too small to matter, and no better: this is the minimum.
                None if largest < limits.tolerance => {
                    accepted = true;
                    outcome.converged = true;
                    break;
                }
                None => damping = (10.0 * damping).max(1e-4),
            }
        }
        if !accepted {
            break;
        }
    }
    outcome.residual_power = fit.residual.max(0.0);
    (points, outcome)
}

/// Mean power of the data, summed over elements.
pub(crate) fn total_power(data: Data<'_>) -> f64 {
    match data {
        Data::Snapshots(y) => y.iter().map(|z| z.norm_sqr()).sum::<f64>() / y.ncols() as f64,
        Data::Covariance { matrix, .. } => matrix.diag().iter().map(|z| z.re).sum(),
    }
}

/// `R x` for the sample covariance `R` of the data.
fn covariance_times(data: Data<'_>, x: &Array2<Complex64>) -> Array2<Complex64> {
    match data {
        Data::Snapshots(y) => {
            let share = 1.0 / y.ncols() as f64;
            y.dot(&adjoint(y).dot(x)).mapv(|z| z * share)
        }
        Data::Covariance { matrix, .. } => matrix.dot(x),
    }
}

/// The least-squares fit at given directions.
pub(crate) struct Fit {
    steering: Vec<Steering>,
    a: Array2<Complex64>,
    /// `A (A^H A)^-1`: its adjoint is the pseudo-inverse of `A`.
    weights: Array2<Complex64>,
    /// `R` times the weights.
    seen: Array2<Complex64>,
    pub residual: f64,
}

impl Fit {
    pub fn new(geometry: &Geometry, points: &[Point], data: Data<'_>, total: f64) -> Option<Self> {
        let elements = geometry.elements();
        if points.len() > elements {
            return None;
        }
        let steering: Vec<Steering> = points.iter().map(|&p| geometry.steering(p)).collect();
        let a = Array2::from_shape_fn((elements, points.len()), |(k, i)| steering[i].vector[k]);
        let adjoint_a = adjoint(a.view());
        let factor = Cholesky::new(adjoint_a.dot(&a).view()).ok()?;
        let smallest = 1e-11 * elements as f64;
        if factor.lower().diag().iter().any(|d| d.re * d.re < smallest) {
            return None;
        }
        let weights = a.dot(&factor.inverse());
        let seen = covariance_times(data, &weights);
        let explained: f64 = a.iter().zip(&seen).map(|(a, s)| (a.conj() * s).re).sum();
        let residual = total - explained;
        residual.is_finite().then_some(Self { steering, a, weights, seen, residual })
    }

    /// By how much the residual power would rise without each source.
    pub fn gains(&self) -> Vec<f64> {
        let pairs = self.weights.columns().into_iter().zip(self.seen.columns());
        pairs
            .map(|(weight, seen)| {
                let dot = |x: ArrayView1<Complex64>| -> f64 {
                    weight.iter().zip(x).map(|(w, x)| (w.conj() * x).re).sum()
                };
                dot(seen) / dot(weight)
            })
            .collect()
    }

    fn normal_equations(&self, axes: usize) -> NormalEquations {
        let (elements, sources) = self.a.dim();
        let count = axes * sources;
        // Derivatives of the steering vectors, source-major, and their parts outside A.
        let slopes = Array2::from_shape_fn((elements, count), |(k, p)| {
            let steering = &self.steering[p / axes];
            steering.vector[k] * Complex64::new(0.0, steering.slopes[k][p % axes])
        });
        let inside = self.a.dot(&adjoint(self.weights.view()).dot(&slopes));
        let outside = slopes - inside;
        let powers = adjoint(self.weights.view()).dot(&self.seen);
        let cross = adjoint(outside.view()).dot(&outside);
        let hessian = Array2::from_shape_fn((count, count), |(p, q)| {
            (cross[[p, q]] * powers[[q / axes, p / axes]]).re
        });
        let gradient = Array1::from_shape_fn(count, |p| {
            let seen = self.seen.column(p / axes);
            let product: Complex64 =
                seen.iter().zip(outside.column(p)).map(|(s, d)| s.conj() * d).sum();
            -product.re
        });
        NormalEquations { hessian, gradient, axes }
    }
}

/// `H step = -gradient`, with both halved.
struct NormalEquations {
    hessian: Array2<f64>,
    gradient: Array1<f64>,
    axes: usize,
}

impl NormalEquations {
    fn step(&self, damping: f64, geometry: &Geometry) -> Option<Vec<Point>> {
        let mut damped = self.hessian.mapv(|h| Complex64::new(h, 0.0));
        for d in damped.diag_mut() {
            *d = *d * (1.0 + damping) + f64::MIN_POSITIVE;
        }
        let factor = Cholesky::new(damped.view()).ok()?;
        let step = factor.solve(self.gradient.mapv(|g| Complex64::new(-g, 0.0)).view());
        if step.iter().any(|s| !s.re.is_finite()) {
            return None;
        }
        let most = geometry.half_beam();
        Some(
            step.exact_chunks(self.axes)
                .into_iter()
                .map(|s| {
                    let at = |axis: usize| s.get(axis).map_or(0.0, |z| z.re.clamp(-most, most));
                    [at(0), at(1)]
                })
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_matrix;

    const LIMITS: Limits = Limits { iterations: 50, tolerance: 1e-12 };

    #[test]
    fn exact_data_is_fitted_exactly() {
        for (name, elevations) in [("lrr48", [0.0; 3]), ("awr1843", [0.1, -0.15, 0.0])] {
            let array = preset(name).unwrap();
            let truth: Vec<Direction> = [-0.6, 0.1, 0.5]
                .iter()
                .zip(elevations)
                .map(|(&a, e)| Direction::new(a, e))
                .collect();
            let s = ndarray::array![
                [Complex64::new(1.0, 0.2)],
                [Complex64::new(-0.3, 0.4)],
                [Complex64::new(0.1, -0.9)]
            ];
            let y = steering_matrix(&array, &truth).dot(&s);
            let off = |d: &Direction| {
                let lift = if name == "lrr48" { 0.0 } else { 0.02 };
                Direction::new(d.azimuth_rad + 0.004, d.elevation_rad + lift)
            };
            let start: Vec<Direction> = truth.iter().map(off).collect();
            let r = y.dot(&adjoint(y.view()));
            for data in
                [Data::Snapshots(y.view()), Data::Covariance { matrix: r.view(), snapshots: 1 }]
            {
                let refined = refine(&array, &start, data, LIMITS).unwrap();
                assert!(refined.converged, "{name} {refined:?}");
                assert!(refined.residual_power < 1e-12, "{name} {refined:?}");
                for (found, truth) in refined.directions.iter().zip(&truth) {
                    assert!((found.azimuth_rad - truth.azimuth_rad).abs() < 1e-6, "{name}");
                    assert!((found.elevation_rad - truth.elevation_rad).abs() < 1e-6, "{name}");
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_refined_comes_back() {
        let array = Array::ula(4).unwrap();
        let y = Array2::from_elem((4, 1), Complex64::new(1.0, 0.0));
        let same = [Direction::azimuth(0.1); 2];
        let refined = refine(&array, &same, Data::Snapshots(y.view()), LIMITS).unwrap();
        assert!(!refined.converged);
        assert!((refined.residual_power - 4.0).abs() < 1e-12);
        let many = vec![Direction::azimuth(0.1); 5];
        assert!(!refine(&array, &many, Data::Snapshots(y.view()), LIMITS).unwrap().converged);
        let refused = |directions: &[Direction]| {
            refine(&array, directions, Data::Snapshots(y.view()), LIMITS).unwrap_err()
        };
        assert_eq!(refused(&[]).code(), "empty");
        let behind = [Direction::azimuth(2.0)];
        assert_eq!(refused(&behind).details().what, "azimuth_rad");
        let silence = Array2::zeros((4, 1));
        let one = [Direction::azimuth(0.1)];
        let refined = refine(&array, &one, Data::Snapshots(silence.view()), LIMITS).unwrap();
        assert_eq!(refined.residual_power, 0.0);
        assert!((refined.directions[0].azimuth_rad - 0.1).abs() < 1e-12);
    }
}
