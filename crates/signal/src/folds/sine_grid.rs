//! The grid of directions that folds are told on.

use boresight_core::{Array, Direction};

/// Grid points between the nulls to both sides of a beam.
const POINTS_A_BEAM: f64 = 16.0;

/// Most grid points, so that a large array cannot exhaust memory.
const MOST_POINTS: f64 = 32_768.0;

/// A grid over the sines of the sensor frame, y the faster.
pub(super) struct SineGrid {
    /// Points along y and z.
    points: [usize; 2],
}

impl SineGrid {
    pub fn of(array: &Array) -> Self {
        let points = [1, 2].map(|axis| {
            let ends = array.positions().iter().fold([f64::INFINITY, f64::NEG_INFINITY], |e, p| {
                [e[0].min(p[axis]), e[1].max(p[axis])]
            });
            // Nulls of a beam are 4 / length apart, over sines from -1 to 1.
            let length = (ends[1] - ends[0]).max(0.0);
            let least = if length > 1e-9 { 9.0 } else { 1.0 };
            (length * POINTS_A_BEAM / 2.0).min(MOST_POINTS).max(least) as usize
        });
        let excess = (points[0] as f64 * points[1] as f64 / MOST_POINTS).sqrt().max(1.0);
        Self {
            points: points.map(|n| if n == 1 { 1 } else { ((n as f64 / excess) as usize).max(3) }),
        }
    }

    pub fn len(&self) -> usize {
        self.points[0] * self.points[1]
    }

    pub fn dimensions(&self) -> f64 {
        self.points.iter().filter(|&&n| n > 1).count() as f64
    }

    /// Direction of a point, moved by a part of a step; none beyond the horizon.
    pub fn direction(&self, index: usize, offset: [f64; 2]) -> Option<Direction> {
        let at = [index % self.points[0], index / self.points[0]];
        let sine = |axis: usize| match self.points[axis] {
            1 => 0.0,
            n => (2.0 * (at[axis] as f64 + offset[axis]) / (n - 1) as f64 - 1.0).clamp(-1.0, 1.0),
        };
        let (y, z) = (sine(0), sine(1));
        if y * y + z * z > 1.0 + 1e-9 {
            return None;
        }
        let elevation_rad = libm::asin(z);
        let level = libm::cos(elevation_rad);
        let azimuth_rad = if level > 1e-9 { libm::asin((y / level).clamp(-1.0, 1.0)) } else { 0.0 };
        Some(Direction::new(azimuth_rad, elevation_rad))
    }

    /// Offset of the vertex of the parabolas through a point and its neighbours on the grid.
    pub fn vertex(&self, values: &[f64], index: usize) -> [f64; 2] {
        let at = [index % self.points[0], index / self.points[0]];
        let stride = [1, self.points[0]];
        let offset = |axis: usize| {
            if at[axis] == 0 || at[axis] + 1 >= self.points[axis] {
                return 0.0;
            }
            let [a, b, c] = [index - stride[axis], index, index + stride[axis]].map(|g| values[g]);
            let curvature = a - 2.0 * b + c;
            // Beyond the horizon there are zeros.
            if curvature >= 0.0 || a <= 0.0 || c <= 0.0 {
                return 0.0;
            }
            (0.5 * (a - c) / curvature).clamp(-0.5, 0.5)
        };
        [offset(0), offset(1)]
    }
}
