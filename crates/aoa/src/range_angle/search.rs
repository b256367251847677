//! Grid search for one more target over range and sine of the azimuth.
//!
//! The best grid point explains most of the power that the other targets leave. Correlations between
//! responses are products of one along range and one along the array, so that one pass over the grid
//! takes a few multiplications per point.

use super::atoms::{Atoms, correlate, inner, table};
use super::refine::Model;
use super::{LEAST_LEFT, Place};
use boresight_core::Complex64;
use boresight_math::linalg::Cholesky;
use ndarray::{Array1, Array2, Array3, ArrayView1, ArrayView3, Axis};

/// Grid points per range bin and per beamwidth.
const POINTS: usize = 4;

/// The grid.
pub(super) struct Search {
    bins: Vec<f64>,
    sines: Vec<f64>,
    /// Responses of unit norm, grid points x bins.
    range: Array2<Complex64>,
    /// Responses of unit norm, grid points x elements.
    array: Array2<Complex64>,
}

/// Data correlated with the response of each grid point: range x sine x chirps.
pub(super) struct Seen<'a> {
    search: &'a Search,
    matched: Array3<Complex64>,
    range: Array2<Complex64>,
    /// Whether a grid point along range may hold a target.
    is_open: Vec<bool>,
}

impl Search {
    pub fn new(atoms: &Atoms, widest: f64) -> Self {
        let span = atoms.positions.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        // A beam is 2 over the aperture wide.
        let half = (POINTS as f64 * widest * (span + 0.5)).ceil();
        let sines: Vec<f64> = if half > 0.0 {
            (0..=2 * half as usize).map(|g| widest * (g as f64 / half - 1.0)).collect()
        } else {
            vec![0.0]
        };
        let bins: Vec<f64> =
            (0..=POINTS * (atoms.bins - 1)).map(|f| f as f64 / POINTS as f64).collect();
        let range = table(bins.iter().map(|&bin| atoms.range(bin).value));
        let array = table(sines.iter().map(|&sine| unit(atoms.array(sine).value)));
        Self { bins, sines, range, array }
    }

    /// Number of grid points.
    pub fn len(&self) -> usize {
        self.bins.len() * self.sines.len()
    }

    /// Whether two places are at most one grid step apart. Refinement converges to the same optimum from both.
    pub fn is_near(&self, one: Place, other: Place) -> bool {
        let step = |all: &[f64]| if let [first, second, ..] = all { second - first } else { 1.0 };
        (one.bin - other.bin).abs() <= step(&self.bins)
            && (one.sine - other.sine).abs() <= step(&self.sines)
    }

    /// Correlates data of bins x elements x chirps with the grid. Bins not `held` are missing.
    pub fn see(&self, x: &ArrayView3<'_, Complex64>, held: &[bool]) -> Seen<'_> {
        let mut range = self.range.clone();
        for mut row in range.rows_mut() {
            row.iter_mut().zip(held).filter(|(_, held)| !**held).for_each(|(z, _)| *z *= 0.0);
            let normalised = Array1::from_vec(unit(row.to_vec()));
            row.assign(&normalised);
        }
        let (_, elements, chirps) = x.dim();
        let mut matched = Array3::zeros((self.bins.len(), self.sines.len(), chirps));
        let conjugate = self.array.mapv(|z| z.conj());
        for (row, mut to) in range.rows().into_iter().zip(matched.outer_iter_mut()) {
            let mut at = Array2::<Complex64>::zeros((elements, chirps));
            for (r, bin) in row.iter().zip(x.outer_iter()) {
                at.scaled_add(r.conj(), &bin);
            }
            to.assign(&conjugate.dot(&at));
        }
        // Targets lie in bins that are present. A single bin does not determine the range within it.
        let has_range = held.iter().filter(|held| **held).count() > 1;
        let is_open = self.bins.iter().map(|bin| {
            let nearest = bin.round();
            let holds = held.get(nearest as usize).is_some_and(|held| *held);
            holds && (has_range || nearest == *bin)
        });
        let is_open = is_open.collect();
        Seen { search: self, matched, range, is_open }
    }
}

impl Seen<'_> {
    /// Returns the grid point that explains most of the power left by the other targets, if any.
    pub fn best(&self, model: &Model<'_>, others: &[Place]) -> Option<Place> {
        let count = others.len();
        let of_others = others.iter().map(|place| {
            let [range, array] = model.responses(*place);
            [unit(range.value), unit(array.value)]
        });
        let of_others: Vec<[Vec<Complex64>; 2]> = of_others.collect();
        let along = |table: &Array2<Complex64>, other: &[Complex64]| -> Vec<Complex64> {
            let seen = |row: ArrayView1<'_, Complex64>| {
                other.iter().zip(row).map(|(x, y)| x.conj() * y).sum()
            };
            table.rows().into_iter().map(seen).collect()
        };
        let by_range: Vec<_> =
            of_others.iter().map(|[range, _]| along(&self.range, range)).collect();
        let by_sine: Vec<_> =
            of_others.iter().map(|[_, array]| along(&self.search.array, array)).collect();
        let gram = Array2::from_shape_fn((count, count), |(i, k)| {
            let ([range, array], [range_k, array_k]) = (&of_others[i], &of_others[k]);
            inner(range, range_k) * inner(array, array_k)
        });
        let factor = Cholesky::new(gram.view()).ok()?;
        let mut received = Array2::zeros((count, self.matched.len_of(Axis(2))));
        for ([range, array], mut to) in of_others.iter().zip(received.rows_mut()) {
            to.assign(&Array1::from_vec(correlate(&model.data, range, array)));
        }
        // Coordinates of the data in an orthonormal basis of the other responses, by chirp.
        let received: Vec<_> =
            received.columns().into_iter().map(|column| factor.forward(column)).collect();
        let mut best: Option<([usize; 2], f64)> = None;
        let mut towards = Array1::zeros(count);
        let planes = self.matched.outer_iter().enumerate();
        for (f, plane) in planes.filter(|(f, _)| self.is_open[*f]) {
            for (g, cell) in plane.outer_iter().enumerate() {
                for (i, to) in towards.iter_mut().enumerate() {
                    *to = by_range[i][f] * by_sine[i][g];
                }
                let shares = factor.forward(towards.view());
                let left = 1.0 - shares.iter().map(|z| z.norm_sqr()).sum::<f64>();
                if left < LEAST_LEFT {
                    continue;
                }
                let power = cell.iter().zip(&received).map(|(z, basis)| {
                    let seen: Complex64 = shares.iter().zip(basis).map(|(s, b)| s.conj() * b).sum();
                    (z - seen).norm_sqr()
                });
                let gain = power.sum::<f64>() / left;
                if gain.is_finite() && best.is_none_or(|(_, most)| gain > most) {
                    best = Some(([f, g], gain));
                }
            }
        }
        let ([f, g], _) = best?;
        Some(Place { bin: self.search.bins[f], sine: self.search.sines[g] })
    }
}

fn unit(mut row: Vec<Complex64>) -> Vec<Complex64> {
    let norm = row.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
    if norm > 0.0 {
        row.iter_mut().for_each(|z| *z /= norm);
    }
    row
}
