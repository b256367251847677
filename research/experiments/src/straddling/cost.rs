//! What an answer costs, by formula: real additions and multiplications of one snapshot.
//!
//! Formulas count the steps that grow with elements `K` and points of the grid `G`: `5 N log2 N` for a transform of
//! `N` points, 8 for a complex multiplication with addition, `4 K^3` for a Cholesky factor and the inverse from it
//! (4/3 and 8/3). What is the same for all methods (peaks, interpolation) is left out. They are what the methods as
//! published take, on an array on a lattice by transforms, on any other by products with steering vectors.

use super::trial::Line;
use crate::aoa::finder::Finder;
use crate::aoa::plain_iaa;
use crate::error::EvaluateError;
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::Array;

/// How a spectrum over the grid is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// By products with the steering vector of every point: any array.
    Dense,
    /// By transforms: elements on a lattice.
    Fast,
}

/// Operations of one snapshot; nothing for methods without a formula and networks that are a name only.
pub(super) fn operations(
    line: &Line,
    array: &Array,
    grid: Option<usize>,
) -> Result<Option<f64>, EvaluateError> {
    let form = if array.lattice().is_some() { Form::Fast } else { Form::Dense };
    let found = match line.finder() {
        Finder::Network(network) => {
            let count = |model: &boresight_neural::Model| model.operations(array);
            network.model.as_ref().map(count).transpose()?
        }
        Finder::PlainIaa(per_degree) => {
            of_method(Method::Iaa, Form::Dense, array, Some(plain_iaa::points(*per_degree)))
        }
        Finder::Method(method, _) => of_method(*method, form, array, grid),
    };
    let refined = if line.is_refined() { pursuit(form, array) } else { 0.0 };
    Ok(found.map(|found| found + refined))
}

/// Operations of a method on one snapshot with one source; nothing for methods without a formula.
pub fn of_method(method: Method, form: Form, array: &Array, grid: Option<usize>) -> Option<f64> {
    let k = array.len() as f64;
    let options = EstimatorOptions::default();
    let g = grid.unwrap_or(options.grid_points) as f64;
    let inverse = 4.0 * k.powi(3);
    Some(match method {
        Method::Bartlett => beams(form, k, g),
        Method::Capon => inverse + quadratic(form, k, g),
        // The covariance of the powers, its inverse, `a^H R^-1 a` and `a^H R^-1 y`.
        Method::Iaa => {
            let covariance = quadratic(form, k, g);
            let iteration = covariance + inverse + quadratic(form, k, g) + beams(form, k, g);
            options.iaa.iterations as f64 * iteration
        }
        Method::Nomp => pursuit(form, array),
        _ => return None,
    })
}

/// `|a^H y|^2` on every point.
fn beams(form: Form, elements: f64, points: f64) -> f64 {
    match form {
        Form::Fast => transform(points) + 3.0 * points,
        Form::Dense => 8.0 * elements * points + 3.0 * points,
    }
}

/// `a^H Q a` on every point for Hermitian `Q`, or the reverse.
fn quadratic(form: Form, elements: f64, points: f64) -> f64 {
    match form {
        Form::Fast => transform(points),
        Form::Dense => 4.0 * elements * elements * points,
    }
}

fn transform(points: f64) -> f64 {
    5.0 * points * points.log2()
}

/// NOMP on one source: two beams over its coarse grid (to find one source and to see that there is no other) and
/// Newton steps, each on a steering vector and two derivatives.
fn pursuit(form: Form, array: &Array) -> f64 {
    let k = array.len() as f64;
    let nomp = EstimatorOptions::default().nomp;
    let points = (nomp.oversampling as f64 * (array.aperture() + 1.0)).max(16.0);
    let points = 2_f64.powf(points.log2().ceil());
    let steps = (nomp.single_refinements + nomp.cyclic_refinements) as f64;
    2.0 * beams(form, k, points) + steps * 3.0 * 8.0 * k
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::presets::preset;

    /// Counted by hand for 48 elements, 1024 points and 15 iterations: a transform is 51,200, the inverse 442,368,
    /// a dense form 9,437,184.
    #[test]
    fn formulas_count_what_they_say() {
        let array = preset("lrr48").unwrap();
        let of = |method, form| of_method(method, form, &array, Some(1024)).unwrap();
        assert_eq!(of(Method::Bartlett, Form::Fast), 51_200.0 + 3_072.0);
        assert_eq!(of(Method::Capon, Form::Fast), 442_368.0 + 51_200.0);
        let fast = 3.0 * 51_200.0 + 3_072.0 + 442_368.0;
        assert_eq!(of(Method::Iaa, Form::Fast), 15.0 * fast);
        let dense = 2.0 * 9_437_184.0 + 442_368.0 + 8.0 * 48.0 * 1024.0 + 3_072.0;
        assert_eq!(of(Method::Iaa, Form::Dense), 15.0 * dense);
        // Four points an element of 93: 512.
        let search = 5.0 * 512.0 * 9.0 + 3.0 * 512.0;
        let nomp = of_method(Method::Nomp, Form::Fast, &array, None).unwrap();
        assert_eq!(nomp, 2.0 * search + 6.0 * 24.0 * 48.0);
        assert_eq!(of_method(Method::Music, Form::Fast, &array, None), None);
    }
}
