//! Atomic norm minimisation (Bhaskar, Tang and Recht 2013; of several snapshots Yang and Xie 2016), without a grid and
//! without a semidefinite program.
//!
//! Of all sums of plane waves it takes the one with the smallest
//!
//! ```text
//! 1/2 sum_n ||y_n - sum_d a(u_d) s_dn||^2 + tau sum_d ||s_d||_2 ,
//! ```
//!
//! over the number of waves, their direction cosines `u_d` and their amplitudes `s_d` in all snapshots. The problem is
//! convex in the measure that the waves make up, so where it starts from makes no difference to what comes out. It is
//! solved by sliding Frank-Wolfe steps (Denoyelle, Duval, Peyre and Soubies 2019; Boyd, Schiebinger and Recht 2017): the
//! strongest beam of the residual joins the waves, and all of them in turn take a Newton step in direction and the
//! amplitude that shrinks by `tau`. It has converged once none of them moves and no beam of the residual is above `tau`,
//! which is the certificate that no other sum is better. Any positions of elements will do, which the semidefinite program of
//! the papers needs a lattice for.
//!
//! `tau^2` is the power above which noise lifts the strongest beam with the false-alarm probability of NOMP
//! (`false_alarm`), in place of the papers' asymptotic bound on its mean. Noise whose power is not given is what NOMP
//! leaves of the snapshots.
//!
//! Amplitudes shrink, and what is missing of one wave pulls at the directions of the others, by the sidelobes of the
//! array. So the waves that were selected are fitted once more without `tau`, as the papers do with amplitudes; those
//! that noise explains then are left out (`Nomp::polish`).

use crate::checks::conclude;
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::estimators::nomp::{Fitted, Nomp, energy};
use crate::method::Method;
use crate::model::cosines::Point;
use crate::model::normalised::Normalised;
use crate::options::EstimatorOptions;
use crate::plan::Plan;
use boresight_core::{Array, Complex64};
use ndarray::Array2;

/// By what share of `tau` a beam of the residual may be above it, and by what share of `tau sum ||s||` the minimum may
/// be missed for phases that do not agree.
const CERTIFICATE: f64 = 1e-3;
/// Share of the strongest beam on the coarse grid above which others may be the strongest between its points. At the
/// minimum the beams at all waves are equal.
const RIVALS: f64 = 0.8;
/// Newton steps on the strongest beam, at least.
const STEPS: usize = 4;
/// Rounds over the waves between two looks at the residual.
const ROUNDS: usize = 20;
/// Most steps of waves, each counted once a snapshot, so that no data take long.
const MOST_STEPS: usize = 100_000;
/// Least `tau`, in parts of what all of the power would make: below it rounding decides.
const LEAST: f64 = 1e-9;

/// The minimisation prepared for one array.
pub(crate) struct AtomicNorm {
    nomp: Nomp,
    certificate: f64,
}

/// The minimum.
struct Minimum {
    waves: Fitted,
    rounds: usize,
    /// Whether the certificate holds.
    certified: bool,
}

impl AtomicNorm {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        let mut options = *options;
        options.nomp.single_refinements = options.nomp.single_refinements.max(STEPS);
        let nomp = Nomp::of(Method::AtomicNorm, array, &options)?;
        Ok(Self { nomp, certificate: CERTIFICATE })
    }

    /// The threshold of beams, in the noise that is given or that a pursuit leaves; and the directions of the pursuit.
    fn threshold(&mut self, y: &Array2<Complex64>, noise_power: Option<f64>) -> (f64, Vec<Point>) {
        let (elements, snapshots) = y.dim();
        let (pursued, _) = self.nomp.pursue(y, Vec::new(), noise_power);
        let found = pursued.points.len();
        let noise = noise_power.unwrap_or_else(|| {
            let angles = 0.5 * (self.nomp.geometry.axes * found) as f64;
            let freedom = (snapshots * (elements - found)) as f64 - angles;
            energy(&pursued.residual) / freedom.max(1.0)
        });
        let power = elements as f64 * noise * self.nomp.level(snapshots);
        let least = LEAST * (elements as f64 * energy(y)).sqrt();
        (power.sqrt().max(least), pursued.points)
    }

    fn minimum(&mut self, y: &Array2<Complex64>, tau: f64, start: Vec<Point>) -> Minimum {
        let amplitudes = Array2::zeros((start.len(), y.ncols()));
        let mut waves = Fitted { points: start, amplitudes, residual: y.clone() };
        let mut rounds = 0;
        loop {
            for _ in 0..ROUNDS {
                self.nomp.cycle(&mut waves, tau);
            }
            rounds += ROUNDS;
            let (point, power) = self.nomp.strongest(&waves.residual, RIVALS);
            let exhausted = power.sqrt() <= tau * (1.0 + self.certificate);
            let certified = exhausted && self.aligned(&waves, y, tau);
            let steps = rounds * waves.amplitudes.len().max(1);
            let finished = certified || steps >= MOST_STEPS;
            let more = !(exhausted || finished) && waves.points.len() < y.nrows();
            change_waves(&mut waves, more.then_some(point));
            if finished {
                return Minimum { waves, rounds, certified };
            }
        }
    }

    /// Whether the beams of the residual at all waves have the phases of their amplitudes and the size `tau`: then
    /// `<A s, r>` is `tau sum ||s||`.
    fn aligned(&self, waves: &Fitted, y: &Array2<Complex64>, tau: f64) -> bool {
        let norm: f64 = norms(&waves.amplitudes).sum();
        let pairs = y.iter().zip(&waves.residual);
        let product: f64 = pairs.map(|(y, r)| ((y - r).conj() * r).re).sum();
        (tau * norm - product).abs() <= self.certificate * tau * norm
    }
}

/// Of the amplitudes of each wave over the snapshots.
fn norms(amplitudes: &Array2<Complex64>) -> impl Iterator<Item = f64> {
    amplitudes.rows().into_iter().map(|s| s.iter().map(|s| s.norm_sqr()).sum::<f64>().sqrt())
}

/// Leaves out waves that have shrunk to nothing, and adds one that has still to grow.
fn change_waves(waves: &mut Fitted, more: Option<Point>) {
    let heard = norms(&waves.amplitudes).enumerate().filter(|&(_, norm)| norm > 0.0);
    let kept: Vec<usize> = heard.map(|(i, _)| i).collect();
    waves.points = kept.iter().map(|&i| waves.points[i]).chain(more).collect();
    let shape = (waves.points.len(), waves.amplitudes.ncols());
    waves.amplitudes = Array2::from_shape_fn(shape, |(i, n)| {
        kept.get(i).map_or(Complex64::ZERO, |&k| waves.amplitudes[[k, n]])
    });
}

impl Plan for AtomicNorm {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let method = Method::AtomicNorm;
        let Data::Snapshots(y) = data else {
            return Err(AoaError::NeedsSnapshots { method: method.name() });
        };
        let mut warnings = self.nomp.warnings();
        let Some(normalised) = Normalised::new(y) else {
            return Ok(conclude(method, vec![], None, None, 0, warnings));
        };
        let y = &normalised.snapshots;
        let noise_power = self.nomp.noise_power_in(&normalised);
        let (tau, start) = self.threshold(y, noise_power);
        let minimum = self.minimum(y, tau, start);
        if !minimum.certified {
            warnings.push(Warning::NotConverged { iterations: minimum.rounds });
        }
        let (points, rounds) = (minimum.waves.points, minimum.rounds);
        Ok(self.nomp.conclude(method, points, &normalised, rounds, warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Direction;
    use boresight_core::Random;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_vector;
    use boresight_math::phasor::cis;
    use serde::Deserialize;

    fn plan(array: &Array) -> AtomicNorm {
        AtomicNorm::new(array, &EstimatorOptions::default()).unwrap()
    }

    #[derive(Deserialize)]
    struct Case {
        places: Vec<f64>,
        tau: f64,
        re: Vec<Vec<f64>>,
        im: Vec<Vec<f64>>,
        minimum: f64,
    }

    #[test]
    fn the_minimum_is_that_of_the_semidefinite_program() {
        let cases: &str = include_str!("../../tests/reference/atomic_norm.json");
        let cases: Vec<Case> = serde_json::from_str(cases).unwrap();
        for case in &cases {
            let positions: Vec<[f64; 3]> = case.places.iter().map(|&y| [0.0, y, 0.0]).collect();
            let mut plan = plan(&Array::new(&positions).unwrap());
            let y = Array2::from_shape_fn((case.re.len(), case.re[0].len()), |(k, n)| {
                Complex64::new(case.re[k][n], case.im[k][n])
            });
            plan.certificate = 1e-7;
            let found = plan.minimum(&y, case.tau, vec![]);
            assert!(found.certified);
            let fitted = found.waves;
            let norm: f64 = norms(&fitted.amplitudes).sum();
            let minimum = 0.5 * energy(&fitted.residual) + case.tau * norm;
            println!(
                "{} waves: {minimum:.6}, {:.6} of the program",
                fitted.points.len(),
                case.minimum
            );
            assert!((minimum / case.minimum - 1.0).abs() < 1e-6, "{minimum} {}", case.minimum);
        }
    }

    #[test]
    fn no_beam_of_what_is_left_is_above_the_threshold() {
        for (name, lift, snapshots) in [("lrr48", 0.0, 1), ("ula16", 0.0, 5), ("awr1843", 0.2, 2)] {
            let array = preset(name).unwrap();
            let mut plan = plan(&array);
            let mut certified = 0;
            for trial in 0..10 {
                let mut random = Random::new(72, trial);
                let mut y = Array2::zeros((array.len(), snapshots));
                for _ in 0..3 {
                    let azimuth = random.uniform(-0.8, 0.8);
                    let at = Direction::new(azimuth, lift * random.uniform(-1.0, 1.0));
                    let a = steering_vector(&array, at);
                    for mut column in y.columns_mut() {
                        let s = cis(random.phase());
                        column.zip_mut_with(&a, |y, a| *y += a * s);
                    }
                }
                y.iter_mut().for_each(|z| *z += random.complex_normal(0.03));
                let (tau, _) = plan.threshold(&y, Some(0.03));
                let minimum = plan.minimum(&y, tau, vec![]);
                certified += usize::from(minimum.certified);
                if !minimum.certified {
                    continue;
                }
                let fitted = minimum.waves;
                for _ in 0..4000 {
                    let at = Direction::new(
                        random.uniform(-1.57, 1.57),
                        lift * random.uniform(-1.5, 1.5),
                    );
                    let a = steering_vector(&array, at);
                    let beam = fitted.residual.columns().into_iter().map(|column| -> f64 {
                        a.iter()
                            .zip(column)
                            .map(|(a, y)| a.conj() * y)
                            .sum::<Complex64>()
                            .norm_sqr()
                    });
                    let beam = beam.sum::<f64>().sqrt();
                    assert!(beam <= tau * (1.0 + 2.0 * CERTIFICATE), "{name}: {beam} {tau}");
                }
            }
            println!("{name}: {certified} of 10 certified");
            assert!(certified >= 9, "{name}: {certified}");
        }
    }
}
