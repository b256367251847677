//! Directions as direction cosines along y and z, in which phases are all but linear.

use crate::spectra::peaks::wrap;
use boresight_core::{Array, Complex64, Direction, Extent, Lattice};
use boresight_math::phasor::cis;
use std::f64::consts::PI;

/// A direction: cosines along y and z. The second is 0 for arrays that see azimuth only.
pub(crate) type Point = [f64; 2];

/// Furthest from boresight that a direction may move, as a sine: the slope of the third cosine
/// must stay finite.
const HORIZON: f64 = 1.0 - 1e-9;

/// What iterations over direction cosines need of an array.
#[derive(Debug, Clone)]
pub(crate) struct Geometry {
    positions: Vec<[f64; 3]>,
    /// Cosines that count: 1, or 2 for arrays that span an area.
    pub axes: usize,
    /// Period in the first cosine, where it is within the visible range.
    period: Option<f64>,
    /// The lattice of elements that stand on the line x = z = 0, and its span.
    line: Option<(Lattice, usize)>,
}

/// A steering vector with its first derivatives by the cosines.
#[derive(Debug, Clone)]
pub(crate) struct Steering {
    pub vector: Vec<Complex64>,
    /// `vector' / (j vector)` by each cosine: the slope of the phase.
    pub slopes: Vec<[f64; 2]>,
}

impl Geometry {
    pub fn new(array: &Array) -> Self {
        let lattice = array.lattice();
        let period = lattice.as_ref().map(|lattice| 2.0 / lattice.spacing).filter(|&p| p < 2.001);
        let line = lattice.and_then(|lattice| line(array, lattice));
        let axes = if array.extent() == Extent::Area { 2 } else { 1 };
        Self { positions: array.positions().to_vec(), axes, period, line }
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.positions.len()
    }

    pub fn point(&self, direction: Direction) -> Point {
        let unit = direction.unit();
        [unit[1], if self.axes == 2 { unit[2] } else { 0.0 }]
    }

    pub fn direction(&self, point: Point) -> Direction {
        let elevation_rad = point[1].clamp(-1.0, 1.0).asin();
        let level = (1.0 - point[1] * point[1]).max(0.0).sqrt().max(1e-12);
        Direction::new((point[0] / level).clamp(-1.0, 1.0).asin(), elevation_rad)
    }

    /// `point + step`, brought back to what is a direction.
    pub fn moved(&self, point: Point, step: Point) -> Point {
        let mut v = point[0] + step[0];
        if self.axes == 1 {
            if v.abs() > 1.0 {
                v = self.period.map_or(v.clamp(-1.0, 1.0), |period| wrap(v, period));
            }
            return [v.clamp(-1.0, 1.0), 0.0];
        }
        let w = (point[1] + step[1]).clamp(-HORIZON, HORIZON);
        let level = HORIZON * (1.0 - w * w).sqrt();
        [v.clamp(-level, level), w]
    }

    /// Smallest distance of two directions in cosines, over the period.
    pub fn distance(&self, a: Point, b: Point) -> f64 {
        let v = self.period.map_or(a[0] - b[0], |period| wrap(a[0] - b[0], period));
        v.hypot(a[1] - b[1])
    }

    fn third(point: Point) -> f64 {
        (1.0 - point[0] * point[0] - point[1] * point[1]).max(1e-9).sqrt()
    }

    /// Steering vector and its slopes.
    pub fn steering(&self, at: Point) -> Steering {
        if let Some((lattice, span)) = &self.line {
            // Powers of one turn: a rounding error each, and no sines.
            let turn = cis(PI * lattice.spacing * at[0]);
            let mut powers = vec![cis(PI * lattice.origin * at[0]); *span];
            for m in 1..*span {
                powers[m] = powers[m - 1] * turn;
            }
            let vector = lattice.indices.iter().map(|&index| powers[index]).collect();
            let slopes = self.positions.iter().map(|p| [PI * p[1], PI * p[2]]).collect();
            return Steering { vector, slopes };
        }
        let x = Self::third(at);
        let mut vector = Vec::with_capacity(self.positions.len());
        let mut slopes = Vec::with_capacity(self.positions.len());
        for p in &self.positions {
            vector.push(cis(PI * (p[0] * x + p[1] * at[0] + p[2] * at[1])));
            slopes.push([PI * (p[1] - p[0] * at[0] / x), PI * (p[2] - p[0] * at[1] / x)]);
        }
        Steering { vector, slopes }
    }

    /// Appends the steering vector.
    pub fn extend_by_steering(&self, at: Point, to: &mut Vec<Complex64>) {
        let x = Self::third(at);
        to.extend(
            self.positions.iter().map(|p| cis(PI * (p[0] * x + p[1] * at[0] + p[2] * at[1]))),
        );
    }

    /// Second derivatives of the phase of element `k` by (v, v), (v, w), (w, w).
    pub fn bends(&self, at: Point, k: usize) -> [f64; 3] {
        let along = PI * self.positions[k][0];
        if along == 0.0 {
            return [0.0; 3];
        }
        let x = Self::third(at);
        let cube = x * x * x;
        [
            -along * (1.0 / x + at[0] * at[0] / cube),
            -along * at[0] * at[1] / cube,
            -along * (1.0 / x + at[1] * at[1] / cube),
        ]
    }

    /// Covariance of the element positions along y and z, times `pi^2`: (yy, yz, zz). The variance
    /// of the slope of a beam's response to white noise.
    pub fn spread(&self) -> [f64; 3] {
        let n = self.positions.len() as f64;
        let mean = |axis: usize| self.positions.iter().map(|p| p[axis]).sum::<f64>() / n;
        let (y, z) = (mean(1), mean(2));
        let mut sums = [0.0; 3];
        for p in &self.positions {
            let (dy, dz) = (p[1] - y, p[2] - z);
            sums[0] += dy * dy;
            sums[1] += dy * dz;
            sums[2] += dz * dz;
        }
        sums.map(|s| PI * PI * s / n)
    }

    /// Half the width of a beam, roughly: the furthest a refinement may go in one step.
    pub fn half_beam(&self) -> f64 {
        let length = |axis: usize| {
            let low = self.positions.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = self.positions.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            high - low
        };
        1.0 / (length(1).max(if self.axes == 2 { length(2) } else { 0.0 }) + 1.0)
    }
}

/// The lattice, where the elements stand on the line x = z = 0, to rounding on its points, and no
/// long way apart for their number; and its span.
fn line(array: &Array, lattice: Lattice) -> Option<(Lattice, usize)> {
    let (positions, span) = (array.positions(), lattice.span());
    let on_line = positions.iter().zip(&lattice.indices).all(|(p, &index)| {
        let y = lattice.origin + lattice.spacing * index as f64;
        p[0] == 0.0 && p[2] == 0.0 && (p[1] - y).abs() < 1e-12
    });
    (on_line && span <= 16 * positions.len()).then_some((lattice, span))
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_vector;

    #[test]
    fn points_and_directions_are_the_same_thing() {
        for name in ["awr1843", "lrr48"] {
            let array = preset(name).unwrap();
            let geometry = Geometry::new(&array);
            let elevation = if geometry.axes == 2 { -0.3 } else { 0.0 };
            let direction = Direction::new(0.7, elevation);
            let point = geometry.point(direction);
            let back = geometry.direction(point);
            assert!((back.azimuth_rad - 0.7).abs() < 1e-12);
            assert!((back.elevation_rad - elevation).abs() < 1e-12);
            let expected = steering_vector(&array, direction);
            for (a, b) in geometry.steering(point).vector.iter().zip(expected) {
                assert!((a - b).norm() < 1e-12);
            }
        }
    }

    #[test]
    fn slopes_and_bends_agree_with_differences() {
        let array = Array::new(&[[0.4, 1.0, -2.0], [1.0, 0.0, 3.0], [0.0; 3]]).unwrap();
        let geometry = Geometry::new(&array);
        let at = [0.3, -0.2];
        let h = 1e-5;
        let here = geometry.steering(at);
        for axis in 0..2 {
            let mut step = [0.0; 2];
            step[axis] = h;
            let up = geometry.steering(geometry.moved(at, step));
            let down = geometry.steering(geometry.moved(at, step.map(|s| -s)));
            for k in 0..3 {
                let slope = (up.vector[k] / down.vector[k]).arg() / (2.0 * h);
                assert!((slope - here.slopes[k][axis]).abs() < 1e-6, "{slope}");
                for (other, entry) in [(0, [0, 1]), (1, [1, 2])] {
                    let bend = (up.slopes[k][other] - down.slopes[k][other]) / (2.0 * h);
                    assert!((bend - geometry.bends(at, k)[entry[axis]]).abs() < 1e-6, "{bend}");
                }
            }
        }
    }

    #[test]
    fn beyond_the_end_of_a_lattice_is_its_other_end() {
        let geometry = Geometry::new(&Array::ula(8).unwrap());
        assert!((geometry.moved([0.99, 0.0], [0.02, 0.0])[0] + 0.99).abs() < 1e-12);
        assert!(geometry.distance([0.99, 0.0], [-0.99, 0.0]) < 0.0201);
        let half = Array::new(&[[0.0; 3], [0.0, 0.5, 0.0], [0.0, 1.0, 0.0]]).unwrap();
        assert_eq!(Geometry::new(&half).moved([0.99, 0.0], [0.02, 0.0])[0], 1.0);
    }
}
