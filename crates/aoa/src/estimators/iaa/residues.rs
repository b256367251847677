//! Transforms between an angle grid and the lags of a lattice by short FFTs side by side.
//!
//! The grid of `G = B M` points is split into `B` residues: point `g = B q + s` has residue `s`. With
//! `w = exp(-2 pi j / G)` a sum over lattice indices is, for each residue, a transform of length `M` of
//! the terms times `w^(m s)`; so neither zeros are transformed nor lags nobody asks for, and all steps
//! are the same for four residues, which fill a vector and lie side by side in memory.

use super::fourier::{LagTransforms, cis};
use super::inverse::Real;
use boresight_core::Lattice;
use boresight_math::fft::{Quad, SideBySide, parts, quad};
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;
use std::f64::consts::{PI, TAU};

/// Numbers in a [`Quad`].
const LANES: usize = 4;

/// The transforms of [`super::fourier::LatticeFourier`] where the spacing is whole and the grid a power of two.
pub struct Residues<T: Real> {
    /// `B`.
    count: usize,
    /// `M`.
    length: usize,
    /// Index of each lattice index in a short FFT.
    bins: Vec<usize>,
    /// For each four residues `s`, and each lattice index `m`, `exp(j pi d m) w^(d m s)`.
    turns: Vec<Vec<Quad<T>>>,
    fft: SideBySide<T>,
}

impl<T: Real> Residues<T> {
    /// Plans for a lattice; nothing unless its spacing is whole and the grid a power of two of at least 16.
    pub fn of(lattice: &Lattice, grid: usize) -> Option<Self> {
        Self::new(grid, lattice.spacing, lattice.span())
    }

    /// The same for a lattice of `span` points.
    pub fn new(grid: usize, spacing: f64, span: usize) -> Option<Self> {
        let whole = (spacing - spacing.round()).abs() * (span as f64) < 1e-9;
        if !whole || !grid.is_power_of_two() || grid < 4 * LANES {
            return None;
        }
        let length = span.next_power_of_two().min(grid / (2 * LANES));
        let count = grid / length;
        let stride = spacing.round() as usize;
        let turn = |m: usize, s: usize| {
            let steps = (stride * m % grid) * s % grid;
            cis::<T>(PI * spacing * m as f64 - TAU * steps as f64 / grid as f64)
        };
        let four = |m: usize, s: usize| {
            let turns: [_; LANES] = std::array::from_fn(|lane| turn(m, s + lane));
            quad::<T>(turns.map(|z| z.re).into(), turns.map(|z| z.im).into())
        };
        Some(Self {
            count,
            length,
            bins: (0..span).map(|m| stride * m % length).collect(),
            turns: (0..count)
                .step_by(LANES)
                .map(|s| (0..span).map(|m| four(m, s)).collect())
                .collect(),
            fft: SideBySide::new(length)?,
        })
    }
}

impl<T: Real> LagTransforms<T> for Residues<T> {
    fn lags(&mut self, values: &[T], lags: &mut [Complex<T>]) {
        lags.fill(Complex::zero());
        let half: T = T::one() / (T::one() + T::one());
        for (pair, turns) in self.turns.as_chunks::<2>().0.iter().enumerate() {
            // Values are real: a residue goes along as the imaginary part of another.
            let rows = values.chunks_exact(self.count);
            for (z, row) in self.fft.input().iter_mut().zip(rows) {
                let (fours, _) = row[2 * LANES * pair..2 * LANES * (pair + 1)].as_chunks();
                *z = quad::<T>(fours[0].into(), fours[1].into());
            }
            let found = self.fft.run();
            let [first, second] = turns;
            let turns = first.iter().zip(second);
            for ((lag, &bin), (t, u)) in lags.iter_mut().zip(&self.bins).zip(turns) {
                let [x_re, x_im] = parts::<T>(found[bin]);
                let [y_re, y_im] = parts::<T>(found[(self.length - bin) % self.length]);
                let (a_re, a_im) = (x_re + y_re, x_im - y_im);
                let (b_re, b_im) = (x_im + y_im, y_re - x_re);
                let ([t_re, t_im], [u_re, u_im]) = (parts::<T>(*t), parts::<T>(*u));
                let re = t_re * a_re - t_im * a_im + u_re * b_re - u_im * b_im;
                let im = t_re * a_im + t_im * a_re + u_re * b_im + u_im * b_re;
                let (re, im): ([T; LANES], [T; LANES]) = (re.into(), im.into());
                lag.re = lag.re + half * ((re[0] + re[1]) + (re[2] + re[3]));
                lag.im = lag.im - half * ((im[0] + im[1]) + (im[2] + im[3]));
            }
        }
    }

    fn hermitian(&mut self, lags: &[Complex<T>], out: &mut [T]) {
        for (pair, turns) in self.turns.as_chunks::<2>().0.iter().enumerate() {
            let input = self.fft.input();
            input.fill([Complex::zero(); LANES]);
            let [first, second] = turns;
            let turns = first.iter().zip(second);
            for (m, ((lag, &bin), (t, u))) in lags.iter().zip(&self.bins).zip(turns).enumerate() {
                let ([a_re, a_im], [b_re, b_im]) = (turned(lag, t), turned(lag, u));
                if m == 0 {
                    add(&mut input[bin], a_re, b_re);
                    continue;
                }
                add(&mut input[bin], a_re - b_im, a_im + b_re);
                add(&mut input[(self.length - bin) % self.length], a_re + b_im, b_re - a_im);
            }
            let found = self.fft.run();
            for (row, z) in out.chunks_exact_mut(self.count).zip(found) {
                let (fours, _) = row[2 * LANES * pair..2 * LANES * (pair + 1)].as_chunks_mut();
                [fours[0], fours[1]] = parts::<T>(*z).map(Into::into);
            }
        }
    }

    fn add_power(&mut self, x: &[Complex<T>], out: &mut [T]) {
        for (four, turns) in self.turns.iter().enumerate() {
            let input = self.fft.input();
            input.fill([Complex::zero(); LANES]);
            for ((x, &bin), t) in x.iter().zip(&self.bins).zip(turns) {
                let [re, im] = turned(x, t);
                add(&mut input[bin], re, im);
            }
            let found = self.fft.run();
            for (row, z) in out.chunks_exact_mut(self.count).zip(found) {
                let (fours, _) = row[LANES * four..LANES * (four + 1)].as_chunks_mut();
                let [re, im] = parts::<T>(*z);
                fours[0] = (T::Four::from(fours[0]) + (re * re + im * im)).into();
            }
        }
    }
}

/// `x` times four numbers.
#[inline(always)]
fn turned<T: Real>(x: &Complex<T>, t: &Quad<T>) -> [T::Four; 2] {
    let [re, im] = parts::<T>(*t);
    [re * x.re - im * x.im, im * x.re + re * x.im]
}

/// Adds to four numbers.
#[inline(always)]
fn add<T: Real>(sum: &mut Quad<T>, re: T::Four, im: T::Four) {
    let [sum_re, sum_im] = parts::<T>(*sum);
    *sum = quad::<T>(sum_re + re, sum_im + im);
}
