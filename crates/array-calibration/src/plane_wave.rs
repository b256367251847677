//! Plane waves over an array, by direction cosines along the axes it spans.

use boresight_core::array::Position;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::phasor::cis;
use std::f64::consts::PI;

/// Cosines along y and z.
pub(crate) type Cosines = [f64; 2];

/// Points of the search a beam width.
const OVERSAMPLING: f64 = 4.0;

/// Most points of the search along one axis.
const MOST_POINTS: f64 = 4096.0;

/// Most points of the search in all.
const MOST_IN_ALL: usize = 1 << 16;

/// Newton steps on the strongest point.
const STEPS: usize = 8;

/// The array, and which cosines count.
#[derive(Debug, Clone)]
pub(crate) struct PlaneWaves {
    pub positions: Vec<Position>,
    /// Of y (0) and z (1), those along which elements differ.
    pub axes: Vec<usize>,
    grid: Vec<Cosines>,
    step: f64,
}

impl PlaneWaves {
    pub fn new(array: &Array) -> Self {
        let positions = array.positions().to_vec();
        let extent = |axis: usize| {
            let along = positions.iter().map(|p| p[axis + 1]);
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let axes: Vec<usize> = (0..2).filter(|&axis| extent(axis) > 1e-9).collect();
        let widest = axes.iter().map(|&axis| extent(axis)).fold(1.0, f64::max);
        let per_axis = if axes.len() == 2 { (MOST_IN_ALL as f64).sqrt() } else { MOST_POINTS };
        let points = (2.0 * OVERSAMPLING * widest).ceil().clamp(8.0, per_axis) as usize;
        let step = 2.0 / points as f64;
        let along = |axis: usize| -> Vec<f64> {
            if axes.contains(&axis) {
                (0..=points).map(|k| -1.0 + step * k as f64).collect()
            } else {
                vec![0.0]
            }
        };
        let (y, z) = (along(0), along(1));
        let grid = z
            .iter()
            .flat_map(|&w| y.iter().map(move |&v| [v, w]))
            .filter(|u| u[0] * u[0] + u[1] * u[1] <= 1.0 + 1e-12)
            .collect();
        Self { positions, axes, grid, step }
    }

    pub fn cosines(&self, direction: Direction) -> Cosines {
        let unit = direction.unit();
        [unit[1], unit[2]]
    }

    pub fn direction(&self, u: Cosines) -> Direction {
        let elevation_rad = u[1].clamp(-1.0, 1.0).asin();
        let level = (1.0 - u[1] * u[1]).max(1e-12).sqrt();
        Direction::new((u[0] / level).clamp(-1.0, 1.0).asin(), elevation_rad)
    }

    /// Response of each channel.
    pub fn response(&self, u: Cosines) -> Vec<Complex64> {
        let x = third(u);
        self.positions.iter().map(|p| cis(PI * (p[0] * x + p[1] * u[0] + p[2] * u[1]))).collect()
    }

    /// Slope of a channel's phase by the cosine along an axis.
    pub fn slope(&self, channel: usize, u: Cosines, axis: usize) -> f64 {
        let p = self.positions[channel];
        PI * (p[axis + 1] - p[0] * u[axis] / third(u))
    }

    /// Where a plane wave under the channels' factors is most like a signal.
    pub fn fitted(&self, signal: &[Complex64], factors: &[Complex64]) -> Cosines {
        let turned: Vec<Complex64> =
            signal.iter().zip(factors).map(|(v, g)| v * g.conj()).collect();
        let power = |u: &Cosines| self.sum(&turned, *u).norm_sqr();
        let start = self.grid.iter().map(|u| (power(u), *u));
        let (_, mut best) =
            start.fold((-1.0, [0.0; 2]), |best, one| if one.0 > best.0 { one } else { best });
        for _ in 0..STEPS {
            let Some(next) = self.newton(&turned, best) else { break };
            if power(&next) < power(&best) {
                break;
            }
            let moved = (next[0] - best[0]).hypot(next[1] - best[1]);
            best = next;
            if moved < 1e-13 {
                break;
            }
        }
        best
    }

    fn sum(&self, turned: &[Complex64], u: Cosines) -> Complex64 {
        self.response(u).iter().zip(turned).map(|(a, t)| a.conj() * t).sum()
    }

    /// A Newton step of the beam's power.
    fn newton(&self, turned: &[Complex64], u: Cosines) -> Option<Cosines> {
        let n = self.axes.len();
        let mut sum = Complex64::ZERO;
        let mut first = [Complex64::ZERO; 2];
        let mut second = [[Complex64::ZERO; 2]; 2];
        for (k, (a, t)) in self.response(u).iter().zip(turned).enumerate() {
            let value = a.conj() * t;
            sum += value;
            for (i, &axis) in self.axes.iter().enumerate() {
                let slope = self.slope(k, u, axis);
                first[i] += value * slope;
                for (j, &other) in self.axes.iter().enumerate() {
                    second[i][j] += value * (slope * self.slope(k, u, other));
                }
            }
        }
        // The sum turns by -j times the slopes.
        let gradient = |i: usize| 2.0 * (sum.conj() * first[i]).im;
        let bend = |i: usize, j: usize| {
            2.0 * ((first[i].conj() * first[j]).re - (sum.conj() * second[i][j]).re)
        };
        let step = match n {
            1 => [-gradient(0) / negative(bend(0, 0))?, 0.0],
            2 => {
                let (a, b, d) = (negative(bend(0, 0))?, bend(0, 1), bend(1, 1));
                let determinant = a * d - b * b;
                if determinant <= 1e-12 * a * a {
                    [-gradient(0) / a, 0.0]
                } else {
                    let (g, h) = (gradient(0), gradient(1));
                    [-(d * g - b * h) / determinant, -(a * h - b * g) / determinant]
                }
            }
            _ => return None,
        };
        let mut next = u;
        for (i, &axis) in self.axes.iter().enumerate() {
            next[axis] += step[i].clamp(-self.step, self.step);
        }
        let length = next[0].hypot(next[1]);
        if length > 1.0 {
            next = next.map(|cosine| cosine / length);
        }
        next.iter().all(|cosine| cosine.is_finite()).then_some(next)
    }
}

fn negative(bend: f64) -> Option<f64> {
    (bend < 0.0).then_some(bend)
}

fn third(u: Cosines) -> f64 {
    (1.0 - u[0] * u[0] - u[1] * u[1]).max(1e-9).sqrt()
}
