//! Arrays whose elements stand on an integer grid, which is what makes fast transforms possible.

use crate::array::Position;

/// Integer positions of elements along y: `y_k = origin + spacing * index_k`.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Grid spacing, half wavelengths.
    pub spacing: f64,
    /// Position of index 0, half wavelengths.
    pub origin: f64,
    /// Index of each element, the smallest being 0.
    pub indices: Vec<usize>,
}

/// Longest grid a lattice is looked for on; beyond it a dense method is as good.
const MAX_SPAN: usize = 1 << 14;

impl Lattice {
    /// Largest `|sin(azimuth)|` that an array on the lattice sees without ambiguity: a wave at `s` looks like one
    /// at `s + 2 / spacing`.
    pub fn unambiguous_sine(&self) -> f64 {
        (1.0 / self.spacing).min(1.0)
    }

    /// Finds the coarsest grid that holds all positions to 1e-6 half wavelengths, or nothing if
    /// they do not lie on one line along y or on no grid of reasonable length.
    pub fn of(positions: &[Position]) -> Option<Self> {
        let first = positions.first()?;
        let tolerance = 1e-6;
        if positions
            .iter()
            .any(|p| (p[0] - first[0]).abs() > tolerance || (p[2] - first[2]).abs() > tolerance)
        {
            return None;
        }
        let origin = positions.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let offsets: Vec<f64> = positions.iter().map(|p| p[1] - origin).collect();
        let spacing = offsets.iter().fold(0.0, |step, &offset| common_step(step, offset));
        if spacing < 1e-3 {
            return None;
        }
        let mut indices = Vec::with_capacity(offsets.len());
        for offset in &offsets {
            let index = (offset / spacing).round();
            if (offset - index * spacing).abs() > tolerance || index > MAX_SPAN as f64 {
                return None;
            }
            indices.push(index as usize);
        }
        Some(Self { spacing, origin, indices })
    }

    /// Number of grid points from the first to the last element, both counted.
    pub fn span(&self) -> usize {
        self.indices.iter().max().map_or(0, |last| last + 1)
    }

    /// Whether the elements fill the grid one after another, rising or falling.
    pub fn is_uniform(&self) -> bool {
        let n = self.indices.len();
        let rising = self.indices.iter().enumerate().all(|(k, &i)| i == k);
        let falling = self.indices.iter().enumerate().all(|(k, &i)| i == n - 1 - k);
        n > 1 && (rising || falling)
    }

    /// Whether the element order runs toward smaller y.
    pub fn is_falling(&self) -> bool {
        self.indices.first() > self.indices.last()
    }
}

/// Greatest common divisor of two lengths to 1e-6.
fn common_step(mut a: f64, mut b: f64) -> f64 {
    while b > 1e-6 {
        let rest = a - b * (a / b).floor();
        a = b;
        b = if rest > a - 1e-6 { 0.0 } else { rest };
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along_y(ys: &[f64]) -> Vec<Position> {
        ys.iter().map(|&y| [0.0, y, 0.0]).collect()
    }

    #[test]
    fn finds_the_coarsest_grid() {
        let lattice = Lattice::of(&along_y(&[2.0, 5.0, 11.0])).unwrap();
        assert!((lattice.spacing - 3.0).abs() < 1e-9);
        assert_eq!(lattice.indices, [0, 1, 3]);
        assert_eq!(lattice.span(), 4);
        assert!(!lattice.is_uniform());
    }

    #[test]
    fn falling_uniform_arrays_are_uniform() {
        let lattice = Lattice::of(&along_y(&[0.0, -1.0, -2.0])).unwrap();
        assert!(lattice.is_uniform() && lattice.is_falling());
        assert_eq!(lattice.origin, -2.0);
    }

    #[test]
    fn refuses_what_is_on_no_grid() {
        assert!(Lattice::of(&along_y(&[0.0, 1.0, 2.0_f64.sqrt()])).is_none());
        assert!(Lattice::of(&[[0.0; 3], [0.0, 1.0, 1.0]]).is_none());
        assert!(Lattice::of(&along_y(&[1.0])).is_none());
    }
}
