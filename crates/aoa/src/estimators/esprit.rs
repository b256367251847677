//! Estimation by rotational invariance (Roy and Kailath 1989), by least squares or total least
//! squares.

use crate::checks::{LatticeAngles, ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::method::Method;
use crate::model::powers::sources_at;
use crate::model::subspace::SubspacePlan;
use crate::options::{EspritForm, EstimatorOptions};
use crate::plan::Plan;
use boresight_core::{Array, Complex64, Direction, InputError};
use boresight_math::linalg::{adjoint, eigenvalues, hermitian_eigen, solve};
use ndarray::{Array2, ArrayView2, s};

/// The signal subspace seen by all elements but the last and by all but the first differ by a
/// rotation whose eigenvalues are `exp(j pi d u)`.
pub(crate) struct Esprit {
    array: Array,
    subspace: SubspacePlan,
    form: EspritForm,
    falling: bool,
    angles: LatticeAngles,
    ambiguity: Option<Warning>,
}

impl Esprit {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(Method::Esprit, array, options)?;
        let subspace = SubspacePlan::new(Method::Esprit, array, options)?;
        let lattice = array.lattice().ok_or_else(|| AoaError::Array {
            method: Method::Esprit.name(),
            expected: "elements evenly spaced along y, in order".into(),
            given: "is not evenly spaced".into(),
        })?;
        Ok(Self {
            array: array.clone(),
            subspace,
            form: options.esprit,
            falling: lattice.is_falling(),
            angles: LatticeAngles::new(&lattice, options),
            ambiguity: ambiguity(array, options),
        })
    }
}

impl Plan for Esprit {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let basis = self.subspace.basis(data)?;
        let count = basis.ncols();
        let mut warnings: Vec<Warning> = self.ambiguity.iter().cloned().collect();
        let mut directions: Vec<Direction> = Vec::new();
        if count > 0 {
            let last = basis.nrows() - 1;
            let mut halves = [basis.slice(s![..last, ..]), basis.slice(s![1.., ..])];
            if self.falling {
                halves.reverse();
            }
            let rotation = match self.form {
                EspritForm::LeastSquares => least_squares_rotation(halves)?,
                EspritForm::TotalLeastSquares => total_least_squares_rotation(halves)?,
            };
            let turns = match &rotation {
                Some(rotation) => eigenvalues(rotation.view())?,
                None => None,
            };
            match turns {
                Some(turns) => {
                    directions = turns.iter().filter_map(|&z| self.angles.direction(z)).collect();
                }
                None => warnings.push(Warning::NotConverged { iterations: 0 }),
            }
        }
        let sources = sources_at(&self.array, &directions, data);
        Ok(conclude(Method::Esprit, sources, Some(count), None, 0, warnings))
    }
}

type Halves<'a> = [ArrayView2<'a, Complex64>; 2];

/// The `F` that minimises `|E1 F - E2|`.
fn least_squares_rotation([e1, e2]: Halves<'_>) -> Result<Option<Array2<Complex64>>, InputError> {
    let transposed = adjoint(e1);
    solve(transposed.dot(&e1).view(), transposed.dot(&e2).view())
}

/// `-V1 V2^-1`, with `V1` over `V2` spanning what is least in `[E1 E2]`.
fn total_least_squares_rotation(
    halves: Halves<'_>,
) -> Result<Option<Array2<Complex64>>, InputError> {
    let [e1, e2] = halves;
    let count = e1.ncols();
    let mut pair = Array2::zeros((e1.nrows(), 2 * count));
    pair.slice_mut(s![.., ..count]).assign(&e1);
    pair.slice_mut(s![.., count..]).assign(&e2);
    let vectors = hermitian_eigen(adjoint(pair.view()).dot(&pair).view())?.vectors;
    let least = vectors.slice(s![.., count..]);
    let (v1, v2) = (least.slice(s![..count, ..]), least.slice(s![count.., ..]));
    Ok(solve(v2.t(), v1.mapv(|z| -z).t())?.map(|x| x.reversed_axes()))
}
