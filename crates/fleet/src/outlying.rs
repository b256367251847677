//! Vehicles of a fleet whose radar is not where those of the others are.
//!
//! The vehicles' angles are normal about a centre, with a spread of the fleet beside each vehicle's own deviation; a few are not. The one
//! furthest off in deviations is taken out and the others are fitted again, over and over, so that several do not hide each other. Going
//! back from the last taken out, the first one that is too far from the fit of those left is outlying, and so are all taken out before it
//! (Rosner 1983, here with unequal deviations). Centre and spread are by restricted maximum likelihood (Viechtbauer 2005).

use crate::tails::{student_quantile, student_tail};

/// Vehicles falsely called outlying, per fleet.
const FALSE_PER_FLEET: f64 = 0.05;
/// Share of the vehicles that may be outlying; one always may.
const MOST_OUTLYING: f64 = 0.2;
/// A fleet of fewer says nothing: beside the vehicle asked about there have to be three to tell centre and spread.
const LEAST_VEHICLES: usize = 4;
/// Of many vehicles so large a share is taken out at a time.
const AT_A_TIME: usize = 200;
const ITERATIONS: usize = 100;
/// A change of the fleet's variance, over a vehicle's least, that ends the iteration.
const CONVERGED: f64 = 1e-4;
/// Deviations are taken to be at least this share of the median vehicle's, and this, rad.
const LEAST_SHARE: f64 = 1e-3;
const LEAST_SIGMA: f64 = 1e-9;
const MOST_RAD: f64 = 7.0;

/// A vehicle's angle, off nominal where that is known. Where angle or deviation are no numbers or beyond 7 rad, or the deviation is below zero, the
/// vehicle says nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleAngle {
    /// The angle; within a half turn of those of the others.
    pub angle_rad: f64,
    /// Its standard deviation, without what all vehicles share.
    pub sigma_rad: f64,
}

/// How a vehicle stands to the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Distance from the centre, in deviations of both the fleet and the vehicle; NaN where vehicle or fleet say nothing.
    pub deviations: f64,
    /// Whether it is further than chance has it.
    pub outlying: bool,
}

/// Where the vehicles of a fleet lie, and which of them are unlike the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlying {
    /// Centre of the vehicles that are not outlying; NaN of none.
    pub centre_rad: f64,
    /// Their spread beyond their own deviations; NaN of fewer than two.
    pub spread_rad: f64,
    /// Deviations beyond which a vehicle whose own deviation is the fleet's median is outlying; for those more precise, whose distances rest on
    /// the spread more, they are more, for others less. Infinite of fewer than four, which say nothing.
    pub threshold: f64,
    /// The vehicles.
    pub vehicles: Vec<Standing>,
}

/// Centre and spread of some vehicles.
#[derive(Debug, Clone, Copy)]
struct Fit {
    centre: f64,
    /// Variance of the centre.
    centre_variance: f64,
    /// Variance of the fleet.
    variance: f64,
    /// What the vehicles say of it: the sum of the squared inverse variances, less what the centre takes of it.
    information: f64,
}

impl Fit {
    /// By restricted maximum likelihood, from a first guess of the variance.
    fn of(vehicles: &[(usize, VehicleAngle)], guess: f64) -> Self {
        let least = vehicles.iter().map(|v| v.1.sigma_rad.powi(2)).fold(f64::INFINITY, f64::min);
        let mut fit = Self {
            centre: f64::NAN,
            centre_variance: f64::INFINITY,
            variance: guess,
            information: 0.0,
        };
        for _ in 0..ITERATIONS {
            let weight = |v: &VehicleAngle| 1.0 / (fit.variance + v.sigma_rad.powi(2));
            let (mut sum, mut first) = (0.0, 0.0);
            for (_, v) in vehicles {
                sum += weight(v);
                first += weight(v) * v.angle_rad;
            }
            let centre = first / sum;
            let (mut squares, mut second) = (0.0, 0.0);
            for (_, v) in vehicles {
                let w = weight(v);
                squares += w * w * ((v.angle_rad - centre).powi(2) - v.sigma_rad.powi(2));
                second += w * w;
            }
            let variance = (squares / second + 1.0 / sum).max(0.0);
            let change = (variance - fit.variance).abs();
            let information = (second - second * second / (sum * sum)).max(0.0);
            fit = Self { centre, centre_variance: 1.0 / sum, variance, information };
            if change <= CONVERGED * (variance + least) {
                break;
            }
        }
        fit
    }

    /// Deviations of a vehicle that the fit is without.
    fn deviations(&self, v: &VehicleAngle) -> f64 {
        let variance = self.variance + v.sigma_rad.powi(2) + self.centre_variance;
        (v.angle_rad - self.centre).abs() / variance.sqrt()
    }

    /// Degrees of freedom that the variance of a vehicle with such a deviation is known with: its own part is given.
    fn freedom(&self, sigma_rad: f64) -> f64 {
        (self.variance + sigma_rad * sigma_rad).powi(2) * self.information
    }

    /// Whether a vehicle that the fit is without is further off than the furthest of so many is by chance.
    fn excludes(&self, v: &VehicleAngle, vehicles: usize) -> bool {
        student_tail(self.deviations(v), self.freedom(v.sigma_rad)) < level(vehicles)
    }
}

/// Probability, for each of so many vehicles, to be called falsely.
fn level(vehicles: usize) -> f64 {
    let n = vehicles as f64;
    // Where several may be called, few vehicles are called together more often than Rosner's levels have it (which hold from 25 on): this is
    // less by as much as simulation asks for.
    let together = if most_outlying(vehicles) > 1 { n / (n + 12.0) } else { 1.0 };
    FALSE_PER_FLEET / n * together
}

fn most_outlying(vehicles: usize) -> usize {
    ((vehicles as f64 * MOST_OUTLYING) as usize).max(1)
}

impl Outlying {
    /// The standing of each vehicle. A fleet of fewer than four that say something calls none outlying.
    #[must_use]
    pub fn of(vehicles: &[VehicleAngle]) -> Self {
        let mut left = known(vehicles);
        let mut standing = vec![Standing { deviations: f64::NAN, outlying: false }; vehicles.len()];
        let mut fit = Fit::of(&left, 0.0);
        if left.len() < LEAST_VEHICLES {
            let spread_rad = if left.len() > 1 { fit.variance.sqrt() } else { f64::NAN };
            let threshold = f64::INFINITY;
            return Self { centre_rad: fit.centre, spread_rad, threshold, vehicles: standing };
        }
        let keep = left.len() - most_outlying(left.len());
        let mut out = Vec::new();
        let (mut called, mut called_fit) = (0, fit);
        while left.len() > keep {
            let batch = (left.len() / AT_A_TIME).clamp(1, left.len() - keep);
            left.sort_by(|a, b| fit.deviations(&a.1).total_cmp(&fit.deviations(&b.1)));
            let furthest = left.split_off(left.len() - batch);
            fit = Fit::of(&left, fit.variance);
            for vehicle in furthest.into_iter().rev() {
                let vehicles = left.len() + 1;
                out.push(vehicle);
                if fit.excludes(&vehicle.1, vehicles) {
                    (called, called_fit) = (out.len(), fit);
                }
            }
        }
        left.extend(out.drain(called..));
        let fit = Fit::of(&left, called_fit.variance);
        let mut sigmas: Vec<f64> = left.iter().map(|(_, v)| v.sigma_rad).collect();
        let freedom = fit.freedom(middle(&mut sigmas));
        let threshold = student_quantile(level(left.len() + 1), freedom);
        for (i, vehicle) in &left {
            standing[*i].deviations = fit.deviations(vehicle);
        }
        for (i, vehicle) in &out {
            standing[*i] = Standing { deviations: fit.deviations(vehicle), outlying: true };
        }
        let spread_rad = fit.variance.sqrt();
        Self { centre_rad: fit.centre, spread_rad, threshold, vehicles: standing }
    }
}

/// The vehicles that say something, with deviations that are not so small as to rule all others.
fn known(vehicles: &[VehicleAngle]) -> Vec<(usize, VehicleAngle)> {
    let says =
        |v: &VehicleAngle| v.angle_rad.abs() < MOST_RAD && (0.0..MOST_RAD).contains(&v.sigma_rad);
    let mut known: Vec<(usize, VehicleAngle)> =
        vehicles.iter().copied().enumerate().filter(|(_, v)| says(v)).collect();
    let mut sigmas: Vec<f64> = known.iter().map(|(_, v)| v.sigma_rad).collect();
    let least = (LEAST_SHARE * middle(&mut sigmas)).max(LEAST_SIGMA);
    for (_, v) in &mut known {
        v.sigma_rad = v.sigma_rad.max(least);
    }
    known
}

/// The upper median; 0 of none. Sorts the values.
fn middle(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
