//! Root-MUSIC (Barabell 1983), on any lattice.

use crate::checks::{LatticeAngles, ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::method::Method;
use crate::model::powers::sources_at;
use crate::model::subspace::{SubspacePlan, noise_projector};
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use boresight_core::{Array, Complex64, Direction, Lattice};
use boresight_math::linalg::polynomial_roots;
use boresight_math::order::sort_descending;
use ndarray::Array2;

/// Longest lattice whose polynomial is solved.
const MAX_SPAN: usize = 1024;

/// With `z = exp(j pi d u)`, MUSIC's form is a polynomial in `z` over the lags of the array. Its
/// roots come in pairs `z, 1 / z*`; those nearest to the unit circle are the sources.
pub(crate) struct RootMusic {
    array: Array,
    subspace: SubspacePlan,
    lattice: Lattice,
    angles: LatticeAngles,
    ambiguity: Option<Warning>,
}

impl RootMusic {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        let method = Method::RootMusic;
        check_array(method, array, options)?;
        let subspace = SubspacePlan::new(method, array, options)?;
        let unsuitable = |given: String| AoaError::Array {
            method: method.name(),
            expected: format!("elements on a grid of at most {MAX_SPAN} points along y"),
            given,
        };
        let lattice = subspace.array().lattice().ok_or_else(|| unsuitable("has none".into()))?;
        if lattice.span() > MAX_SPAN {
            return Err(unsuitable(format!("spans {}", lattice.span())));
        }
        Ok(Self {
            array: array.clone(),
            angles: LatticeAngles::new(&lattice, options),
            lattice,
            ambiguity: ambiguity(array, options),
            subspace,
        })
    }

    /// Coefficients of `z^(span - 1) a^H N a`, from the lowest power.
    fn polynomial(&self, form: &Array2<Complex64>) -> Vec<Complex64> {
        let span = self.lattice.span();
        let mut coefficients = vec![Complex64::ZERO; 2 * span - 1];
        let indices = &self.lattice.indices;
        for (row, &k) in form.rows().into_iter().zip(indices) {
            for (value, &l) in row.iter().zip(indices) {
                coefficients[span - 1 + l - k] += value;
            }
        }
        coefficients
    }
}

impl Plan for RootMusic {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let basis = self.subspace.basis(data)?;
        let count = basis.ncols();
        let mut warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        let mut directions: Vec<Direction> = Vec::new();
        if count > 0 {
            let coefficients = self.polynomial(&noise_projector(&basis));
            match polynomial_roots(&coefficients) {
                Some(roots) => {
                    directions = pairs_near_circle(roots)
                        .iter()
                        .filter_map(|&z| self.angles.direction(z))
                        .take(count)
                        .collect();
                }
                None => warnings.push(Warning::NotConverged { iterations: 0 }),
            }
        }
        let sources = sources_at(&self.array, &directions, data);
        Ok(conclude(Method::RootMusic, sources, Some(count), None, 0, warnings))
    }
}

/// Pairs of roots `z, 1 / z*`, nearest to the unit circle first, each as the sum of the two. A
/// source without noise is a double root, which rounding splits in two; the sum undoes that.
fn pairs_near_circle(mut roots: Vec<Complex64>) -> Vec<Complex64> {
    let distance = |z: &Complex64| z.norm().ln().abs();
    roots.retain(|z| z.norm_sqr() > 0.0);
    sort_descending(&mut roots, distance);
    let mut pairs = Vec::with_capacity(roots.len() / 2);
    while let Some(z) = roots.pop() {
        let mirrored = z.conj().inv();
        let gap = |k: &usize| (roots[*k] - mirrored).norm_sqr();
        let partner = (0..roots.len()).min_by(|a, b| gap(a).total_cmp(&gap(b)));
        pairs.push(z + partner.map_or(Complex64::ZERO, |k| roots.remove(k)));
    }
    pairs
}
