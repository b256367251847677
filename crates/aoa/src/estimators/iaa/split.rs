//! Vectors beside a matrix in tiles.

use super::inverse::{HermitianTiles, Real, TILE};
use boresight_core::Complex64;
use rustfft::num_complex::Complex;

/// A vector in blocks of one tile, real and imaginary parts apart.
#[derive(Debug, Clone)]
pub struct Split<T> {
    /// Real parts.
    pub re: Vec<[T; TILE]>,
    /// Imaginary parts.
    pub im: Vec<[T; TILE]>,
}

impl<T: Real> Split<T> {
    /// Zeros, as many as fill that many tiles.
    pub fn zero(blocks: usize) -> Self {
        let zero = vec![[T::zero(); TILE]; blocks];
        Self { re: zero.clone(), im: zero }
    }

    /// Sets all to zero.
    pub fn clear(&mut self) {
        for x in self.re.iter_mut().chain(&mut self.im) {
            *x = [T::zero(); TILE];
        }
    }

    /// Entry `k`.
    pub fn get(&self, k: usize) -> Complex<T> {
        Complex::new(self.re[k / TILE][k % TILE], self.im[k / TILE][k % TILE])
    }

    /// Replaces entry `k`.
    pub fn set(&mut self, k: usize, z: Complex<T>) {
        self.re[k / TILE][k % TILE] = z.re;
        self.im[k / TILE][k % TILE] = z.im;
    }
}

impl Split<f64> {
    /// `self^H x`.
    pub fn dot(&self, x: &Self) -> Complex64 {
        let (mut re, mut im) = (0.0, 0.0);
        let (parts, others) = (self.re.iter().zip(&self.im), x.re.iter().zip(&x.im));
        for ((a, b), (p, q)) in parts.zip(others) {
            for c in 0..TILE {
                re += a[c] * p[c] + b[c] * q[c];
                im += a[c] * q[c] - b[c] * p[c];
            }
        }
        Complex64::new(re, im)
    }
}

impl<T: Real> HermitianTiles<T> {
    /// `x = -M y`: of what [`HermitianTiles::negative_inverse`] leaves, the inverse times `y`.
    pub fn negated_product(&self, y: &Split<T>, x: &mut Split<T>) {
        x.clear();
        let mut tiles = self.tiles().iter();
        for i in 0..self.blocks() {
            for (j, tile) in tiles.by_ref().take(i + 1).enumerate() {
                for r in 0..TILE {
                    // Row r of the tile times y_j, and its conjugate times y_i into x_j.
                    let (mut re, mut im) = (T::zero(), T::zero());
                    for c in 0..TILE {
                        let (a, b) = (tile.re[r][c], tile.im[r][c]);
                        let (p, q) = (y.re[j][c], y.im[j][c]);
                        re = re + a * p - b * q;
                        im = im + a * q + b * p;
                    }
                    x.re[i][r] = x.re[i][r] - re;
                    x.im[i][r] = x.im[i][r] - im;
                    if j < i {
                        let (p, q) = (y.re[i][r], y.im[i][r]);
                        for c in 0..TILE {
                            let (a, b) = (tile.re[r][c], tile.im[r][c]);
                            x.re[j][c] = x.re[j][c] - (a * p + b * q);
                            x.im[j][c] = x.im[j][c] - (a * q - b * p);
                        }
                    }
                }
            }
        }
    }
}
