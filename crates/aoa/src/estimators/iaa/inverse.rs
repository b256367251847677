//! Inverse of a Hermitian positive definite matrix in 4 x 4 tiles.
//!
//! Real and imaginary parts are kept apart in fixed-size arrays, so that every inner loop runs over
//! four adjacent numbers and compiles to vector instructions without unsafe code. The inverse is
//! made in place by block sweeps (Beaton 1964): each sweep inverts one 4 x 4 pivot and updates
//! every other tile of the lower triangle by a rank-4 product, K^3/2 complex multiplications in
//! all, the same as Cholesky, triangular inverse and product together, but in one kernel.

use boresight_core::Complex64;
use boresight_math::fft::Transforms;
use ndarray::Array2;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Float;
use std::ops::{Add, Mul, Sub};
use wide::{f32x4, f64x2};

/// Rows and columns of a tile.
pub const TILE: usize = 4;

/// The numbers the fast form is computed in: `f64` or `f32`.
pub trait Real: Transforms + Float {
    /// What a 128-bit register holds of them.
    type Vector: Copy
        + Add<Output = Self::Vector>
        + Sub<Output = Self::Vector>
        + Mul<Output = Self::Vector>;
    /// Vectors in a row of a tile.
    const PARTS: usize;
    /// A number in every place.
    fn splat(x: Self) -> Self::Vector;
    /// A part of a row.
    fn load(row: &[Self; TILE], part: usize) -> Self::Vector;
    /// Replaces a part of a row.
    fn store(vector: Self::Vector, row: &mut [Self; TILE], part: usize);
}

impl Real for f32 {
    type Vector = f32x4;
    const PARTS: usize = 1;

    #[inline(always)]
    fn splat(x: f32) -> f32x4 {
        f32x4::splat(x)
    }

    #[inline(always)]
    fn load(row: &[f32; TILE], _: usize) -> f32x4 {
        f32x4::new(*row)
    }

    #[inline(always)]
    fn store(vector: f32x4, row: &mut [f32; TILE], _: usize) {
        *row = vector.to_array();
    }
}

impl Real for f64 {
    type Vector = f64x2;
    const PARTS: usize = 2;

    #[inline(always)]
    fn splat(x: f64) -> f64x2 {
        f64x2::splat(x)
    }

    #[inline(always)]
    fn load(row: &[f64; TILE], part: usize) -> f64x2 {
        f64x2::new([row[2 * part], row[2 * part + 1]])
    }

    #[inline(always)]
    fn store(vector: f64x2, row: &mut [f64; TILE], part: usize) {
        row[2 * part..2 * part + 2].copy_from_slice(&vector.to_array());
    }
}

/// A 4 x 4 complex block, row-major.
#[derive(Debug, Clone, Copy)]
pub struct Tile<T> {
    /// Real parts.
    pub re: [[T; TILE]; TILE],
    /// Imaginary parts.
    pub im: [[T; TILE]; TILE],
}

impl<T: Real> Tile<T> {
    /// All zero.
    pub fn zero() -> Self {
        Self { re: [[T::zero(); TILE]; TILE], im: [[T::zero(); TILE]; TILE] }
    }

    fn adjoint(&self) -> Self {
        let mut out = Self::zero();
        for r in 0..TILE {
            for c in 0..TILE {
                out.re[c][r] = self.re[r][c];
                out.im[c][r] = -self.im[r][c];
            }
        }
        out
    }
}

/// Lower triangle of a Hermitian matrix in tiles, row by row, inverted in place.
#[derive(Debug, Clone)]
pub struct HermitianTiles<T> {
    blocks: usize,
    tiles: Vec<Tile<T>>,
    /// Adjoint of the pivot's block column, and that times the inverse pivot.
    panel: Vec<Tile<T>>,
    scaled: Vec<Tile<T>>,
}

/// The matrix is not positive definite to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Singular;

impl<T: Real> HermitianTiles<T> {
    /// Room for a matrix of `size` rows, rounded up to whole tiles.
    pub fn new(size: usize) -> Self {
        let blocks = size.div_ceil(TILE);
        Self {
            blocks,
            tiles: vec![Tile::zero(); blocks * (blocks + 1) / 2],
            panel: vec![Tile::zero(); blocks],
            scaled: vec![Tile::zero(); blocks],
        }
    }

    /// Number of tiles in a row.
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// The tiles of the lower triangle: (0,0), (1,0), (1,1), (2,0), ...; diagonal tiles are full.
    pub fn tiles(&self) -> &[Tile<T>] {
        &self.tiles
    }

    /// The same, to fill.
    pub fn tiles_mut(&mut self) -> &mut [Tile<T>] {
        &mut self.tiles
    }

    /// Makes it the unit matrix.
    pub fn set_identity(&mut self) {
        self.tiles.fill(Tile::zero());
        for i in 0..self.blocks {
            let tile = &mut self.tiles[i * (i + 1) / 2 + i];
            for r in 0..TILE {
                tile.re[r][r] = T::one();
            }
        }
    }

    /// Sets an entry on or below the diagonal, and its mirror image.
    pub fn set(&mut self, row: usize, column: usize, z: Complex<T>) {
        let (i, j, r, c) = (row / TILE, column / TILE, row % TILE, column % TILE);
        let tile = &mut self.tiles[i * (i + 1) / 2 + j];
        (tile.re[r][c], tile.im[r][c]) = (z.re, z.im);
        if i == j {
            (tile.re[c][r], tile.im[c][r]) = (z.re, -z.im);
        }
    }

    /// Replaces the matrix by minus its inverse.
    ///
    /// # Errors
    /// [`Singular`] at a pivot not above `smallest`; the contents are then of no use.
    pub fn negative_inverse(&mut self, smallest: T) -> Result<(), Singular> {
        for s in 0..self.blocks {
            self.sweep(s, smallest)?;
        }
        Ok(())
    }

    fn sweep(&mut self, s: usize, smallest: T) -> Result<(), Singular> {
        let at = |i: usize, j: usize| i * (i + 1) / 2 + j;
        let pivot = invert_tile(&self.tiles[at(s, s)], smallest).ok_or(Singular)?;
        for j in 0..self.blocks {
            if j == s {
                continue;
            }
            self.panel[j] =
                if j < s { self.tiles[at(s, j)] } else { self.tiles[at(j, s)].adjoint() };
            self.scaled[j] = product(&pivot, &self.panel[j]);
        }
        let mut rest = &mut self.tiles[..];
        for i in 0..self.blocks {
            let (row, below) = rest.split_at_mut(i + 1);
            rest = below;
            if i == s {
                row[..s].copy_from_slice(&self.scaled[..s]);
                for r in 0..TILE {
                    for c in 0..TILE {
                        row[s].re[r][c] = -pivot.re[r][c];
                        row[s].im[r][c] = -pivot.im[r][c];
                    }
                }
                continue;
            }
            let left = &self.scaled[i];
            for (tile, panel) in row.iter_mut().zip(&self.panel) {
                subtract_product(tile, left, panel);
            }
            if i > s {
                row[s] = left.adjoint();
            }
        }
        Ok(())
    }
}

/// `c -= w^H b`.
#[inline(always)]
fn subtract_product<T: Real>(c: &mut Tile<T>, w: &Tile<T>, b: &Tile<T>) {
    for part in 0..T::PARTS {
        let mut re: [_; TILE] = std::array::from_fn(|r| T::load(&c.re[r], part));
        let mut im: [_; TILE] = std::array::from_fn(|r| T::load(&c.im[r], part));
        for k in 0..TILE {
            let (p, q) = (T::load(&b.re[k], part), T::load(&b.im[k], part));
            for r in 0..TILE {
                let (x, y) = (T::splat(w.re[k][r]), T::splat(w.im[k][r]));
                re[r] = re[r] - (x * p + y * q);
                im[r] = im[r] - (x * q - y * p);
            }
        }
        for r in 0..TILE {
            T::store(re[r], &mut c.re[r], part);
            T::store(im[r], &mut c.im[r], part);
        }
    }
}

/// `a b`.
#[inline(always)]
fn product<T: Real>(a: &Tile<T>, b: &Tile<T>) -> Tile<T> {
    let mut out = Tile::zero();
    for part in 0..T::PARTS {
        for r in 0..TILE {
            let (mut re, mut im) = (T::splat(T::zero()), T::splat(T::zero()));
            for k in 0..TILE {
                let (p, q) = (T::load(&b.re[k], part), T::load(&b.im[k], part));
                let (x, y) = (T::splat(a.re[r][k]), T::splat(a.im[r][k]));
                re = re + (x * p - y * q);
                im = im + (x * q + y * p);
            }
            T::store(re, &mut out.re[r], part);
            T::store(im, &mut out.im[r], part);
        }
    }
    out
}

/// Inverse of a Hermitian positive definite tile, by scalar sweeps.
fn invert_tile<T: Real>(tile: &Tile<T>, smallest: T) -> Option<Tile<T>> {
    let mut m = *tile;
    for s in 0..TILE {
        let d = m.re[s][s];
        if d.is_nan() || d <= smallest {
            return None;
        }
        let inverse = d.recip();
        let (row_re, row_im) = (m.re[s], m.im[s]);
        for r in 0..TILE {
            if r == s {
                continue;
            }
            // Hermitian up to the sign of nothing: column s is the conjugate of row s.
            let (x, y) = (row_re[r] * inverse, -row_im[r] * inverse);
            for c in 0..TILE {
                m.re[r][c] = m.re[r][c] - (x * row_re[c] - y * row_im[c]);
                m.im[r][c] = m.im[r][c] - (x * row_im[c] + y * row_re[c]);
            }
            m.re[r][s] = x;
            m.im[r][s] = y;
        }
        for c in 0..TILE {
            m.re[s][c] = row_re[c] * inverse;
            m.im[s][c] = row_im[c] * inverse;
        }
        m.re[s][s] = -inverse;
        m.im[s][s] = T::zero();
    }
    for r in 0..TILE {
        for c in 0..TILE {
            m.re[r][c] = -m.re[r][c];
            m.im[r][c] = -m.im[r][c];
        }
    }
    Some(m)
}

/// Inverse of a Hermitian positive definite matrix, of which the lower triangle is read; nothing if
/// it is singular to rounding.
pub(crate) fn hermitian_inverse(matrix: &Array2<Complex64>) -> Option<Array2<Complex64>> {
    let size = matrix.nrows();
    let largest = matrix.diag().iter().map(|z| z.re).fold(0.0, f64::max);
    let mut tiles = HermitianTiles::new(size);
    let mut rest = tiles.tiles_mut().iter_mut();
    for i in 0..size.div_ceil(TILE) {
        for (j, tile) in rest.by_ref().take(i + 1).enumerate() {
            for r in 0..TILE {
                for c in 0..TILE {
                    let (row, column) = (TILE * i + r, TILE * j + c);
                    let z = if row >= size || column >= size {
                        Complex64::new(if row == column { largest } else { 0.0 }, 0.0)
                    } else if row >= column {
                        matrix[[row, column]]
                    } else {
                        matrix[[column, row]].conj()
                    };
                    tile.re[r][c] = z.re;
                    tile.im[r][c] = if row == column { 0.0 } else { z.im };
                }
            }
        }
    }
    tiles.negative_inverse(4.0 * size as f64 * f64::EPSILON * largest).ok()?;
    let mut inverse = Array2::zeros((size, size));
    for row in 0..size {
        for column in 0..=row {
            let (i, j) = (row / TILE, column / TILE);
            let tile = &tiles.tiles()[i * (i + 1) / 2 + j];
            let (r, c) = (row % TILE, column % TILE);
            let z = -Complex64::new(tile.re[r][c], tile.im[r][c]);
            inverse[[row, column]] = z;
            inverse[[column, row]] = z.conj();
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;
    use boresight_math::linalg::{Cholesky, adjoint};

    #[test]
    fn agrees_with_cholesky() {
        let mut random = Random::new(11, 0);
        for n in [1usize, 3, 4, 5, 16, 47, 48] {
            let x = Array2::from_shape_fn((n, 2 * n), |_| random.complex_normal(1.0));
            let a = x.dot(&adjoint(x.view()));
            let expected = Cholesky::new(a.view()).unwrap().inverse();
            let scale = expected.iter().map(|z| z.norm()).fold(0.0, f64::max);
            let found = hermitian_inverse(&a).unwrap();
            for (f, e) in found.iter().zip(&expected) {
                assert!((f - e).norm() < 1e-12 * scale, "n = {n}: {f} {e}");
            }
        }
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        for bad in [0.0, -1.0, f64::NAN] {
            let mut a = Array2::<Complex64>::eye(9);
            a[[6, 6]] = Complex64::new(bad, 0.0);
            assert!(hermitian_inverse(&a).is_none());
        }
    }
}
