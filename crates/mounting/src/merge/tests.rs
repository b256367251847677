//! The elimination against least squares of all unknowns at once.

use super::elimination::Effects;
use super::*;
use crate::recursive::information::Vector;
use boresight_core::{Diagnose, Random};
use std::f64::consts::PI;

/// Deviations of the observations' rows, by unknown, so that a drive of some rows tells each about as well as drives do.
const SLOPES: Vector = [1.0, 0.3, 8.0, 6.0, 0.8];
const RADARS: [u8; 3] = [3, 1, 7];
const ROWS: usize = 40;
const SIGMA: f64 = 0.003;

/// Entries of a row, by column.
type Entries = Vec<(usize, f64)>;
/// A linear observation of one part: row, value less that at the part's reference.
type Observation = (Vector, f64);

struct Given {
    drives: Vec<Vec<DrivePart>>,
    observations: Vec<Vec<Vec<Observation>>>,
}

fn upper(n: &[[f64; UNKNOWNS]; UNKNOWNS]) -> [f64; 15] {
    let mut entries = (0..UNKNOWNS).flat_map(|i| (i..UNKNOWNS).map(move |j| n[i][j]));
    std::array::from_fn(|_| entries.next().unwrap())
}

/// Drives with references of their own, on either side of half a turn for the second radar.
fn given(seed: u64, drives: usize) -> Given {
    let mut random = Random::new(seed, 1);
    let mut result = Given { drives: vec![], observations: vec![] };
    for _ in 0..drives {
        let (mut parts, mut all) = (vec![], vec![]);
        for (angle, level) in [0.4, PI, -1.5].into_iter().enumerate() {
            let mut near = |at: f64, sigma: f64| at + sigma * random.normal();
            let reference = [
                wrap(near(level, 0.002)),
                near(1.0, 0.01),
                near(0.0, 1e-3),
                near(0.004, 1e-3),
                near(0.04, 0.01),
            ];
            let (mut n, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
            let observations: Vec<Observation> = (0..ROWS)
                .map(|_| {
                    let row =
                        std::array::from_fn(
                            |i| {
                                if i == 0 { 1.0 } else { SLOPES[i] * random.normal() }
                            },
                        );
                    let value = 0.004 * random.normal();
                    boresight_math::linalg::small::add_outer(&mut n, &row, 1.0 / (SIGMA * SIGMA));
                    for i in 0..UNKNOWNS {
                        right[i] += row[i] * value / (SIGMA * SIGMA);
                    }
                    (row, value)
                })
                .collect();
            let equations = NormalEquations {
                reference,
                information: upper(&n),
                right,
                prior: [wrap(level + 0.01), 1.0, 1e-4 * angle as f64, 0.0035, 0.04],
                // The bias of the second is the narrowest.
                prior_information: [1e3, 2.5e3, [3e5, 1e6, 2e5][angle], 1.5e5, 1.1e3],
                floor_rad: 0.0,
                doubt_rad: 5e-4 * angle as f64,
            };
            parts.push(DrivePart { angle, equations });
            all.push(observations);
        }
        result.drives.push(parts);
        result.observations.push(all);
    }
    result
}

/// Gaussian elimination with pivots, of several right-hand sides.
fn gauss(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs())).unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in 0..n {
            if i != k {
                let factor = a[i][k] / a[k][k];
                for j in k..n {
                    a[i][j] -= factor * a[k][j];
                }
                for j in 0..b[i].len() {
                    b[i][j] -= factor * b[k][j];
                }
            }
        }
    }
    (0..n).map(|i| b[i].iter().map(|entry| entry / a[i][i]).collect()).collect()
}

/// Solution and covariance of all unknowns: three angles, the four of the car, then for each drive those four less the shared ones and
/// the error of each part's angle. In units of `scale`, which are those that the unknowns are known to.
struct Dense {
    x: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

const UNITS: Vector = [1e-3, 1e-2, 1e-3, 1e-3, 1e-2];

fn dense(
    given: &Given,
    weights: &[Vec<f64>],
    shared: [bool; CAR],
    tau: &[f64; 3],
    spread: &CarVector,
    without: Option<(usize, usize)>,
) -> Dense {
    let drives = given.drives.len();
    let size = 3 + CAR + drives * (CAR + 3);
    let own = |drive: usize, i: usize| 3 + CAR + drive * (CAR + 3) + i;
    let mut rows: Vec<(Entries, f64, f64)> = vec![];
    let level = [0.4, PI, -1.5];
    let known = |sigma: f64| if sigma > 0.0 { 1.0 / (sigma * sigma) } else { 1e30 };
    for angle in 0..3 {
        rows.push((vec![(angle, 1.0)], level[angle] + 0.01, 1e3));
    }
    for i in 0..CAR {
        let prior = |angle: usize| {
            let equations = &given.drives[0][angle].equations;
            (equations.prior[i + 1], equations.prior_information[i + 1])
        };
        let (mean, information) = prior(if i == 1 { 1 } else { 0 });
        if shared[i] {
            rows.push((vec![(3 + i, 1.0)], mean, information));
        } else {
            rows.push((vec![(3 + i, 1.0)], 0.0, 1.0 / UNITS[i + 1].powi(2)));
        }
        for drive in 0..drives {
            if shared[i] {
                rows.push((vec![(own(drive, i), 1.0)], 0.0, known(spread[i])));
            } else {
                rows.push((vec![(own(drive, i), 1.0)], mean, information));
            }
        }
    }
    for (drive, parts) in given.drives.iter().enumerate() {
        for (angle, part) in parts.iter().enumerate() {
            let weight = weights[drive][angle];
            let error = own(drive, CAR + angle);
            let variance = tau[angle].powi(2) + part.equations.doubt_rad.powi(2);
            let known = if without == Some((drive, angle)) { 0.0 } else { weight / variance };
            rows.push((vec![(error, 1.0)], 0.0, known));
            let mut at = part.equations.reference;
            at[0] = level[angle] + wrap(at[0] - level[angle]);
            for (row, value) in &given.observations[drive][angle] {
                let mut entries = vec![(angle, row[0]), (error, row[0])];
                for i in 0..CAR {
                    entries.push((own(drive, i), row[i + 1]));
                    if shared[i] {
                        entries.push((3 + i, row[i + 1]));
                    }
                }
                let value = value + (0..UNKNOWNS).map(|i| row[i] * at[i]).sum::<f64>();
                rows.push((entries, value, weight / (SIGMA * SIGMA)));
            }
        }
    }
    let unit = |at: usize| {
        let i = if at < 3 {
            0
        } else if at < 3 + CAR {
            at - 2
        } else {
            (at - 3 - CAR) % (CAR + 3) + 1
        };
        if i > CAR { UNITS[0] } else { UNITS[i] }
    };
    let mut n = vec![vec![0.0; size]; size];
    let mut right = vec![0.0; size];
    for (entries, value, information) in rows {
        for (i, a) in &entries {
            right[*i] += a * unit(*i) * information * value;
            for (j, b) in &entries {
                n[*i][*j] += a * unit(*i) * information * b * unit(*j);
            }
        }
    }
    let sides = (0..size)
        .map(|i| {
            let mut side: Vec<f64> = (0..size).map(|j| if i == j { 1.0 } else { 0.0 }).collect();
            side.push(right[i]);
            side
        })
        .collect();
    let solved = gauss(n, sides);
    Dense {
        x: (0..size).map(|i| solved[i][size] * unit(i)).collect(),
        covariance: (0..size)
            .map(|i| (0..size).map(|j| solved[i][j] * unit(i) * unit(j)).collect())
            .collect(),
    }
}

const SHARINGS: [[Sharing; CAR]; 4] = [
    [Sharing::Shared; CAR],
    [Sharing::Drive; CAR],
    [Sharing::Shared, Sharing::Drive, Sharing::Shared, Sharing::Shared],
    [Sharing::Drive, Sharing::Shared, Sharing::Shared, Sharing::Drive],
];

fn options([scale, bias, slip, delay]: [Sharing; CAR]) -> MergeOptions {
    MergeOptions { scale, bias, slip, delay, ..MergeOptions::default() }
}

fn near(a: f64, b: f64, unit: f64, what: &str) {
    assert!((a - b).abs() <= 1e-9 * (unit + b.abs()), "{what}: {a:e} and {b:e}");
}

/// Compares a solution with the dense one.
fn compare(settled: &Settled, dense: &Dense, drives: usize) {
    let size = 3 + CAR;
    let shared = settled.layout.shared;
    let level = [0.4, PI, -1.5];
    let is_told = |i: usize| i < 3 || shared[i - 3];
    for i in (0..size).filter(|i| is_told(*i)) {
        let x = if i < 3 {
            let angle = settled.reference.angles[i] + settled.outcome.solution.x[i];
            level[i] + wrap(angle - level[i])
        } else {
            settled.reference.car[i - 3] + settled.outcome.solution.x[i]
        };
        near(x, dense.x[i], 0.01 * UNITS[if i < 3 { 0 } else { i - 2 }], "unknown");
        for j in (0..size).filter(|j| is_told(*j)) {
            let [ii, jj] = [i, j].map(|k| dense.covariance[k][k]);
            near(
                settled.outcome.solution.covariance[i * size + j],
                dense.covariance[i][j],
                (ii * jj).sqrt(),
                "covariance",
            );
        }
    }
    for drive in 0..drives {
        let about = &settled.outcome.about[drive];
        for i in 0..CAR {
            let at = size + drive * size + i;
            let (both, own) = (3 + i, at);
            let c = &dense.covariance;
            let (x, variance) = if shared[i] {
                (dense.x[both] + dense.x[own], c[both][both] + 2.0 * c[both][own] + c[own][own])
            } else {
                (dense.x[own], c[own][own])
            };
            near(settled.reference.car[i] + about.car[i], x, UNITS[i + 1], "car");
            near(about.car_variance[i], variance, 0.0, "variance of the car");
            if shared[i] {
                near(about.deviation[i], dense.x[own], UNITS[i + 1], "deviation");
                near(
                    about.deviation_variance[i],
                    c[own][own],
                    1e-12 * UNITS[i + 1].powi(2),
                    "its variance",
                );
            }
        }
    }
}

#[test]
fn eliminated_or_all_at_once_the_solution_is_the_same() {
    for (seed, sharing) in SHARINGS.into_iter().enumerate() {
        let given = given(seed as u64, 4);
        let settled = settle(&RADARS, &given.drives, &options(sharing)).unwrap();
        assert!(settled.outcome.converged);
        let weights: Vec<Vec<f64>> = settled
            .outcome
            .about
            .iter()
            .map(|about| about.parts.iter().map(|part| part.weight).collect())
            .collect();
        let tau: [f64; 3] =
            std::array::from_fn(|i| settled.outcome.effects.angle[settled.layout.radar[i]].sqrt());
        let spread = settled.outcome.effects.car.map(f64::sqrt);
        let at_once =
            |without| dense(&given, &weights, settled.layout.shared, &tau, &spread, without);
        compare(&settled, &at_once(None), 4);
        // What a part says against all others, by leaving it out.
        for (drive, angle) in [(0, 0), (3, 1), (2, 2)] {
            // With an error of which nothing is known: it is what the part says against all others.
            let others = at_once(Some((drive, angle)));
            let error = 3 + CAR + drive * (CAR + 3) + CAR + angle;
            let part = &given.drives[drive][angle].equations;
            let own = SIGMA * SIGMA / ROWS as f64;
            let weight = weights[drive][angle];
            let variance = others.covariance[error][error] - own / weight
                + own
                + tau[angle].powi(2)
                + part.doubt_rad.powi(2);
            let deviations = settled.outcome.about[drive].parts[angle].deviations();
            near(deviations, others.x[error] / variance.sqrt(), 1.0, "deviations");
        }
    }
}

#[test]
fn with_differences_given_the_solution_is_the_same() {
    let given = given(9, 4);
    for sharing in SHARINGS {
        for spread in [[0.0; CAR], [1e-3, 2e-4, 0.0, 1e-3]] {
            let options = options(sharing);
            let (vehicle, reference) = gather(&RADARS, &given.drives, &options).unwrap();
            // By number of the radar: 1, 3, 7.
            let tau = [4e-4, 6e-4, 2e-4];
            let effects = Effects {
                angle: tau.map(|tau| tau * tau).to_vec(),
                car: spread.map(|sigma| sigma * sigma),
            };
            let solution = vehicle.solve(&effects).unwrap();
            let about = vehicle.about(&solution, &effects).unwrap();
            let weights = vec![vec![1.0; 3]; 4];
            let tau = [tau[1], tau[0], tau[2]];
            let at_once = dense(&given, &weights, options.shared(), &tau, &spread, None);
            let told = vec![];
            let layout = vehicle.layout;
            let outcome = Outcome { solution, effects, about, converged: true };
            let settled = Settled { layout, reference, outcome, told };
            compare(&settled, &at_once, 4);
        }
    }
}

#[test]
fn nothing_is_told_of_an_angle_without_drives() {
    let radars = [1, 2, 2];
    let options = MergeOptions::default();
    let none = merge_drives(&radars, &[], &options).unwrap();
    assert!(none.angles.iter().all(|angle| angle.sigma_rad == f64::INFINITY && angle.drives == 0));
    assert_eq!((none.shared, none.drives.len()), (CarUnknowns::default(), 0));
    assert!(merge_drives(&[], &[], &options).unwrap().angles.is_empty());
    let mut some = given(2, 3);
    some.drives.push(vec![]);
    // A drive that says nothing.
    let mut part = some.drives[0][1];
    part.equations.information = [0.0; 15];
    part.equations.right = [0.0; UNKNOWNS];
    some.drives.push(vec![part]);
    for drive in &mut some.drives {
        drive.retain(|part| part.angle < 2);
    }
    let merged = merge_drives(&radars, &some.drives, &options).unwrap();
    assert_eq!(merged.angles.iter().map(|a| a.drives).collect::<Vec<_>>(), [3, 3, 0]);
    assert!(merged.angles[..2].iter().all(|angle| angle.sigma_rad < 1e-3));
    assert_eq!(merged.covariance[2], [0.0, 0.0, f64::INFINITY]);
    assert_eq!(merged.drives[3].own, CarUnknowns::default());
    assert_eq!(merged.drives[4].parts[0].deviations, 0.0);
    // It knows of its bias what it knew before.
    let bias = merged.drives[4].own.bias_radps.unwrap();
    assert!((bias.sigma - 1e-3).abs() < 1e-4, "{bias:?}");
    let few = merge_drives(&radars, &some.drives[..3], &options).unwrap();
    for (a, b) in few.angles.iter().zip(&merged.angles) {
        near(a.angle_rad, b.angle_rad, 1e-3, "angle");
    }
}

#[test]
fn what_no_drive_tells_is_added_once_and_shared_by_the_angles_of_a_radar() {
    let mut given = given(4, 6);
    let radars = [5, 5, 6];
    let clean = merge_drives(&radars, &given.drives, &MergeOptions::default()).unwrap();
    for part in given.drives.iter_mut().flatten() {
        part.equations.floor_rad = 1e-3;
    }
    let floored = merge_drives(&radars, &given.drives, &MergeOptions::default()).unwrap();
    for i in 0..3 {
        for j in 0..3 {
            let beyond = floored.covariance[i][j] - clean.covariance[i][j];
            let expected = if (i < 2) == (j < 2) { 1e-6 } else { 0.0 };
            assert!((beyond - expected).abs() < 1e-15, "{i} {j} {beyond:e}");
        }
    }
}

#[test]
fn what_no_drive_leads_to_is_refused_by_name() {
    let options = MergeOptions::default();
    let refused = |change: fn(&mut DrivePart)| {
        let mut given = given(1, 3);
        change(&mut given.drives[1][2]);
        merge_drives(&RADARS, &given.drives, &options).unwrap_err()
    };
    let unsound: [fn(&mut DrivePart); 7] = [
        |part| part.equations.right[3] = f64::NAN,
        |part| part.equations.information[0] = f64::INFINITY,
        |part| part.equations.information[1] = 1e300,
        |part| part.equations.information[5] = -1.0,
        |part| part.equations.information[6] = 1e3 * part.equations.information[5],
        |part| part.equations.prior_information[2] = 0.0,
        |part| part.equations.reference[1] = f64::NEG_INFINITY,
    ];
    for change in unsound {
        let error = refused(change);
        assert_eq!(error.code(), "unsound-equations", "{error}");
        assert!(error.details().what.contains("drive 1"), "{error}");
    }
    assert_eq!(refused(|part| part.angle = 3).code(), "out-of-range");
    let wrong = MergeOptions { drive_sigma_rad: 0.0, ..options };
    assert_eq!(merge_drives(&RADARS, &[], &wrong).unwrap_err().code(), "out-of-range");
}
