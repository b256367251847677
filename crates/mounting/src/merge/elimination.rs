//! One drive's equations with all that is the drive's own eliminated (Schur complement), and how the drive lies about a solution.

use super::part::Part;
use super::{CAR, CarMatrix, CarVector};
use boresight_math::linalg::small::{dot, inverse, times};

/// Share of what is known of an angle without a part that is told from none.
const LEAST_LEFT: f64 = 1e-9;

/// A drive of the vehicle.
#[derive(Debug, Clone)]
pub(super) struct Drive {
    pub(super) parts: Vec<Part>,
    /// Prior of the car's unknowns that are the drive's own: means less the reference, and standard deviations; zero for those that drives share.
    pub(super) offset: CarVector,
    pub(super) sigma: CarVector,
}

/// Variances of what differs from drive to drive.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Effects {
    /// Of the angle, by the radar, rad^2.
    pub(super) angle: Vec<f64>,
    /// Of each unknown of the car that drives share.
    pub(super) car: CarVector,
}

/// Where a vehicle's unknowns stand: the angles, and after them those of the car, shared or not.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Which radar an angle is of, counted from 0.
    pub(super) radar: Vec<usize>,
    pub(super) shared: [bool; CAR],
}

/// A solution of the vehicle's unknowns: steps from the reference, and their covariance row by row.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub(super) x: Vec<f64>,
    pub(super) covariance: Vec<f64>,
}

/// A row of a drive's equations, before the elimination.
#[derive(Debug)]
struct Row {
    /// Which of the vehicle's unknowns it is of; none for one that is the drive's own.
    at: Option<usize>,
    /// Diagonal of an angle's.
    own: f64,
    /// Entries in the columns of the car's unknowns.
    car: CarVector,
    /// What these columns' elimination makes of them: change of the drive's deviation with the unknown, sign turned.
    pulled: CarVector,
    right: f64,
}

/// A drive with its own unknowns eliminated: a row an angle, and one each of the car's unknowns.
#[derive(Debug)]
pub(super) struct Eliminated<'a> {
    drive: &'a Drive,
    rows: Vec<Row>,
    /// Covariance of the drive's own deviations where the vehicle's unknowns are known.
    own: CarMatrix,
    /// Deviations where the vehicle's unknowns are at the reference.
    start: CarVector,
    /// Variances of the parts' angles.
    variances: Vec<f64>,
}

/// How a drive lies about a solution.
#[derive(Debug)]
pub(super) struct About {
    /// The car's unknowns in this drive less the reference, and their variances.
    pub(super) car: CarVector,
    pub(super) car_variance: CarVector,
    /// By how much they differ from the prior or from what drives share, and the variances of that.
    pub(super) deviation: CarVector,
    pub(super) deviation_variance: CarVector,
    pub(super) parts: Vec<Residual>,
}

/// How a part's angle lies about a solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residual {
    pub(super) residual: f64,
    /// Variance of the angle by the drive.
    pub(super) variance: f64,
    /// Variance of the angle by the solution.
    pub(super) fitted: f64,
    /// What the part counts for in the solution.
    pub(super) weight: f64,
}

impl Residual {
    /// Residual from a solution without the part, in deviations of the difference.
    pub(super) fn deviations(&self) -> f64 {
        let left = (1.0 - self.weight * self.fitted / self.variance).max(LEAST_LEFT);
        let deviations = self.residual / left / (self.variance + self.fitted / left).sqrt();
        if deviations.is_finite() { deviations } else { 0.0 }
    }
}

impl Layout {
    pub(super) fn size(&self) -> usize {
        self.radar.len() + CAR
    }
}

impl<'a> Eliminated<'a> {
    /// None where the drive's equations are not those of any observations.
    pub(super) fn new(drive: &'a Drive, layout: &Layout, effects: &Effects) -> Option<Self> {
        let sigma: CarVector = std::array::from_fn(|i| {
            if layout.shared[i] { effects.car[i].sqrt() } else { drive.sigma[i] }
        });
        let (mut n, mut right): (CarMatrix, CarVector) = Default::default();
        let mut rows = Vec::with_capacity(drive.parts.len() + CAR);
        let mut variances = Vec::with_capacity(drive.parts.len());
        for part in &drive.parts {
            let variance = part.variance(effects.angle[layout.radar[part.angle]]);
            let own = part.weight / variance;
            let car = part.slopes.map(|slope| own * slope);
            for i in 0..CAR {
                right[i] += part.weight * part.rest_right[i] + car[i] * part.value;
                for j in 0..CAR {
                    n[i][j] += part.weight * part.rest[i][j] + car[i] * part.slopes[j];
                }
            }
            let right = own * part.value;
            rows.push(Row { at: Some(part.angle), own, car, pulled: [0.0; CAR], right });
            variances.push(variance);
        }
        for i in 0..CAR {
            let at = layout.shared[i].then_some(layout.radar.len() + i);
            rows.push(Row { at, own: 0.0, car: n[i], pulled: [0.0; CAR], right: right[i] });
        }
        // In units of their own deviations, so that one without any is no special case.
        let scaled: CarMatrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| sigma[i] * n[i][j] * sigma[j] + if i == j { 1.0 } else { 0.0 })
        });
        let scaled = inverse(&scaled)?;
        let own: CarMatrix =
            std::array::from_fn(|i| std::array::from_fn(|j| sigma[i] * scaled[i][j] * sigma[j]));
        for row in &mut rows {
            row.pulled = times(&own, &row.car);
            row.right -= dot(&row.car, &drive.offset);
        }
        let parts = drive.parts.len();
        let start = times(&own, &std::array::from_fn(|i| rows[parts + i].right));
        for row in &mut rows {
            row.right -= dot(&row.car, &start);
        }
        Some(Self { drive, rows, own, start, variances })
    }

    /// Adds to the vehicle's equations.
    pub(super) fn add_to(&self, total: &mut [f64], right: &mut [f64]) {
        let (size, parts) = (right.len(), self.drive.parts.len());
        for (l, row) in self.rows.iter().enumerate() {
            let Some(i) = row.at else { continue };
            right[i] += row.right;
            for (m, other) in self.rows.iter().enumerate() {
                let Some(j) = other.at else { continue };
                let entry = if m >= parts {
                    row.car[m - parts]
                } else if l >= parts {
                    other.car[l - parts]
                } else if l == m {
                    row.own
                } else {
                    0.0
                };
                total[i * size + j] += entry - dot(&row.car, &other.pulled);
            }
        }
    }

    /// Variance of a linear function of the rows' unknowns.
    fn form(&self, slopes: &[f64], covariance: &[f64], size: usize) -> f64 {
        let mut result = 0.0;
        for (row, a) in self.rows.iter().zip(slopes) {
            let Some(i) = row.at else { continue };
            for (other, b) in self.rows.iter().zip(slopes) {
                let Some(j) = other.at else { continue };
                result += a * covariance[i * size + j] * b;
            }
        }
        result
    }

    /// How the drive lies about a solution.
    pub(super) fn about(&self, solution: &Solution) -> About {
        let (size, parts) = (solution.x.len(), self.drive.parts.len());
        let at = |row: &Row| row.at.map_or(0.0, |at| solution.x[at]);
        let mut deviation = self.start;
        for row in &self.rows {
            for (entry, pulled) in deviation.iter_mut().zip(row.pulled) {
                *entry -= pulled * at(row);
            }
        }
        // One of the drive's own has no part in the vehicle's unknowns: its column is left out by `at`.
        let slopes_of = |direction: &CarVector, shared: f64| -> Vec<f64> {
            let rows = self.rows.iter().enumerate();
            rows.map(|(l, row)| {
                let own = if l >= parts { shared * direction[l - parts] } else { 0.0 };
                own - dot(direction, &row.pulled)
            })
            .collect()
        };
        let form = |slopes: &[f64]| self.form(slopes, &solution.covariance, size);
        let unit = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
        let variance = |i: usize, shared: f64| self.own[i][i] + form(&slopes_of(&unit(i), shared));
        let car: CarVector = std::array::from_fn(|i| {
            at(&self.rows[parts + i]) + self.drive.offset[i] + deviation[i]
        });
        let residual = |(j, part): (usize, &Part)| {
            let mut slopes = slopes_of(&part.slopes, 1.0);
            slopes[j] += 1.0;
            let told = part.value - at(&self.rows[j]) - dot(&part.slopes, &car);
            Residual {
                residual: if part.tells() { told } else { 0.0 },
                variance: self.variances[j],
                weight: part.weight,
                fitted: dot(&part.slopes, &times(&self.own, &part.slopes)) + form(&slopes),
            }
        };
        About {
            parts: self.drive.parts.iter().enumerate().map(residual).collect(),
            car,
            car_variance: std::array::from_fn(|i| variance(i, 1.0)),
            deviation,
            deviation_variance: std::array::from_fn(|i| variance(i, 0.0)),
        }
    }
}
