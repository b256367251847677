//! Powers of two by Stockham's self-sorting form of the FFT (Cochran et al. 1967), radix 4. Of many
//! transforms, four run side by side: every step of theirs is one on whole vectors.

use super::Transforms;
use rustfft::num_complex::Complex;
use rustfft::{Direction, Fft, FftDirection, Length};
use std::f64::consts::TAU;
use std::ops::{Add, Mul, Sub};

/// Transforms that run side by side.
pub(super) const LANES: usize = 4;
/// Longest transform that does: twice four of them should fit into the cache.
const LONGEST: usize = 1024;

/// A transform whose length is a power of two.
///
/// Buffers hold any number of whole blocks of this length, and inputs as many as outputs. Unlike `rustfft`, which panics
/// otherwise, this planner leaves numbers after the last whole block unchanged: a panic would end the WebAssembly
/// instance. With debug assertions it panics as well, so that tests find such a call.
pub struct PowerOfTwo<T> {
    length: usize,
    direction: FftDirection,
    stages: Vec<Stage<T>>,
    /// Whether a stage of radix 2 remains at the end.
    halves: bool,
}

/// One stage of radix 4.
struct Stage<T> {
    /// Numbers that share their twiddle factors.
    stride: usize,
    /// `w^p`, `w^2p` and `w^3p` for each group `p`.
    twiddles: Vec<[Complex<T>; 3]>,
}

/// A complex number, or one of each of the transforms that run side by side.
pub(super) trait Point<T>: Copy {
    type Part: Copy
        + Add<Output = Self::Part>
        + Sub<Output = Self::Part>
        + Mul<T, Output = Self::Part>;
    fn parts(self) -> [Self::Part; 2];
    fn of(parts: [Self::Part; 2]) -> Self;
}

impl<T: Transforms> Point<T> for Complex<T> {
    type Part = T;

    #[inline(always)]
    fn parts(self) -> [T; 2] {
        [self.re, self.im]
    }

    #[inline(always)]
    fn of([re, im]: [T; 2]) -> Self {
        Self { re, im }
    }
}

/// Four real parts, then four imaginary ones, in the memory of four complex numbers.
impl<T: Transforms> Point<T> for [Complex<T>; LANES] {
    type Part = T::Four;

    #[inline(always)]
    fn parts(self) -> [T::Four; 2] {
        let [a, b, c, d] = self;
        [[a.re, a.im, b.re, b.im].into(), [c.re, c.im, d.re, d.im].into()]
    }

    #[inline(always)]
    fn of([re, im]: [T::Four; 2]) -> Self {
        let (re, im): ([T; LANES], [T; LANES]) = (re.into(), im.into());
        [(re[0], re[1]), (re[2], re[3]), (im[0], im[1]), (im[2], im[3])]
            .map(|(re, im)| Complex { re, im })
    }
}

impl<T: Transforms> PowerOfTwo<T> {
    /// Plans transforms of `length` numbers, a power of two.
    pub fn new(length: usize, direction: FftDirection) -> Self {
        let sign = match direction {
            FftDirection::Forward => -1.0,
            FftDirection::Inverse => 1.0,
        };
        let mut stages = vec![];
        let (mut left, mut stride) = (length, 1);
        while left >= 4 {
            let twiddles = (0..left / 4)
                .map(|p| [1, 2, 3].map(|k| twiddle(sign * TAU * (k * p) as f64 / left as f64)))
                .collect();
            stages.push(Stage { stride, twiddles });
            left /= 4;
            stride *= 4;
        }
        Self { length, direction, stages, halves: left == 2 }
    }

    /// Transforms `x`, with `y` of the same length as scratch space. Whether the result is in `y`.
    pub(super) fn run<P: Point<T>>(&self, x: &mut [P], y: &mut [P]) -> bool {
        let (mut from, mut to) = (x, y);
        let mut swapped = false;
        for stage in &self.stages {
            match self.direction {
                FftDirection::Forward => stage.run::<P, true>(from, to),
                FftDirection::Inverse => stage.run::<P, false>(from, to),
            }
            std::mem::swap(&mut from, &mut to);
            swapped = !swapped;
        }
        if self.halves {
            let (a, b) = from.split_at(self.length / 2);
            let (sums, differences) = to.split_at_mut(self.length / 2);
            for (((sum, difference), a), b) in sums.iter_mut().zip(differences).zip(a).zip(b) {
                let ([a_re, a_im], [b_re, b_im]) = (a.parts(), b.parts());
                *sum = P::of([a_re + b_re, a_im + b_im]);
                *difference = P::of([a_re - b_re, a_im - b_im]);
            }
            swapped = !swapped;
        }
        swapped
    }

    /// Transforms `x` in place.
    fn run_one(&self, x: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        if self.run(x, scratch) {
            x.copy_from_slice(scratch);
        }
    }

    /// Transforms four rows in place, side by side.
    fn run_lanes(&self, rows: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        let (x, y) = scratch[..2 * LANES * self.length].split_at_mut(LANES * self.length);
        let (x, y) = (x.as_chunks_mut().0, y.as_chunks_mut().0);
        let (a, rest) = rows.split_at_mut(self.length);
        let (b, rest) = rest.split_at_mut(self.length);
        let (c, d) = rest.split_at_mut(self.length);
        for ((((x, a), b), c), d) in x.iter_mut().zip(&*a).zip(&*b).zip(&*c).zip(&*d) {
            let (re, im) = ([a.re, b.re, c.re, d.re], [a.im, b.im, c.im, d.im]);
            *x = Point::<T>::of([re.into(), im.into()]);
        }
        let result = if self.run(x, y) { y } else { x };
        for ((((x, a), b), c), d) in result.iter().zip(a).zip(b).zip(c).zip(d) {
            let [re, im]: [[T; LANES]; 2] = x.parts().map(Into::into);
            *a = Complex { re: re[0], im: im[0] };
            *b = Complex { re: re[1], im: im[1] };
            *c = Complex { re: re[2], im: im[2] };
            *d = Complex { re: re[3], im: im[3] };
        }
    }
}

impl<T: Transforms> Stage<T> {
    fn run<P: Point<T>, const FORWARD: bool>(&self, x: &[P], y: &mut [P]) {
        let quarter = x.len() / 4;
        let (x0, rest) = x.split_at(quarter);
        let (x1, rest) = rest.split_at(quarter);
        let (x2, x3) = rest.split_at(quarter);
        let inputs = x0.iter().zip(x1).zip(x2).zip(x3);
        if self.stride == 1 {
            for ((y, w), (((a, b), c), d)) in y.chunks_exact_mut(4).zip(&self.twiddles).zip(inputs)
            {
                let out = butterfly::<T, P, FORWARD>([*a, *b, *c, *d], w);
                y.copy_from_slice(&out);
            }
            return;
        }
        let s = self.stride;
        for (p, (y, w)) in y.chunks_exact_mut(4 * s).zip(&self.twiddles).enumerate() {
            let (y0, rest) = y.split_at_mut(s);
            let (y1, rest) = rest.split_at_mut(s);
            let (y2, y3) = rest.split_at_mut(s);
            let group = p * s..(p + 1) * s;
            let [x0, x1, x2, x3] = [x0, x1, x2, x3].map(|x| &x[group.clone()]);
            for q in 0..s {
                [y0[q], y1[q], y2[q], y3[q]] =
                    butterfly::<T, P, FORWARD>([x0[q], x1[q], x2[q], x3[q]], w);
            }
        }
    }
}

/// Transform of four numbers, turned by the twiddle factors.
#[inline(always)]
fn butterfly<T: Transforms, P: Point<T>, const FORWARD: bool>(
    points: [P; 4],
    [w1, w2, w3]: &[Complex<T>; 3],
) -> [P; 4] {
    let [[a_re, a_im], [b_re, b_im], [c_re, c_im], [d_re, d_im]] = points.map(P::parts);
    let (even_re, even_im) = (a_re + c_re, a_im + c_im);
    let (even_difference_re, even_difference_im) = (a_re - c_re, a_im - c_im);
    let (odd_re, odd_im) = (b_re + d_re, b_im + d_im);
    let (odd_difference_re, odd_difference_im) = (b_re - d_re, b_im - d_im);
    // Plus and minus -j (b - d) forward, +j (b - d) inverse.
    let plus = [even_difference_re + odd_difference_im, even_difference_im - odd_difference_re];
    let minus = [even_difference_re - odd_difference_im, even_difference_im + odd_difference_re];
    let (first, third) = if FORWARD { (plus, minus) } else { (minus, plus) };
    let turned = |[re, im]: [P::Part; 2], w: &Complex<T>| {
        P::of([re * w.re - im * w.im, re * w.im + im * w.re])
    };
    [
        P::of([even_re + odd_re, even_im + odd_im]),
        turned(first, w1),
        turned([even_re - odd_re, even_im - odd_im], w2),
        turned(third, w3),
    ]
}

/// Checks in debug builds that a buffer holds whole blocks.
fn debug_check<T>(buffer: &[Complex<T>], length: usize) {
    debug_assert!(
        buffer.len().is_multiple_of(length),
        "a buffer of {} numbers; expected a multiple of {length}",
        buffer.len()
    );
}

fn twiddle<T: Transforms>(phase_rad: f64) -> Complex<T> {
    let z = crate::phasor::cis(phase_rad);
    let part = |x: f64| T::from_f64(x).unwrap_or_else(T::zero);
    Complex::new(part(z.re), part(z.im))
}

impl<T: Transforms> Fft<T> for PowerOfTwo<T> {
    fn process_with_scratch(&self, buffer: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        debug_check(buffer, self.length);
        let fours = if self.length <= LONGEST { buffer.len() / (LANES * self.length) } else { 0 };
        let (fours, rest) = buffer.split_at_mut(fours * LANES * self.length);
        for rows in fours.chunks_exact_mut(LANES * self.length) {
            self.run_lanes(rows, scratch);
        }
        for row in rest.chunks_exact_mut(self.length) {
            self.run_one(row, &mut scratch[..self.length]);
        }
    }

    fn process_outofplace_with_scratch(
        &self,
        input: &mut [Complex<T>],
        output: &mut [Complex<T>],
        _scratch: &mut [Complex<T>],
    ) {
        debug_check(input, self.length);
        debug_assert_eq!(input.len(), output.len(), "input and output of a transform");
        let blocks = input.chunks_exact_mut(self.length);
        for (from, to) in blocks.zip(output.chunks_exact_mut(self.length)) {
            to.copy_from_slice(from);
            self.run_one(to, from);
        }
    }

    fn process_immutable_with_scratch(
        &self,
        input: &[Complex<T>],
        output: &mut [Complex<T>],
        scratch: &mut [Complex<T>],
    ) {
        debug_assert_eq!(input.len(), output.len(), "input and output of a transform");
        let length = input.len().min(output.len());
        let output = &mut output[..length];
        output.copy_from_slice(&input[..length]);
        self.process_with_scratch(output, scratch);
    }

    fn get_inplace_scratch_len(&self) -> usize {
        if self.length <= LONGEST { 2 * LANES * self.length } else { self.length }
    }

    fn get_outofplace_scratch_len(&self) -> usize {
        0
    }

    fn get_immutable_scratch_len(&self) -> usize {
        self.get_inplace_scratch_len()
    }
}

impl<T> Length for PowerOfTwo<T> {
    fn len(&self) -> usize {
        self.length
    }
}

impl<T> Direction for PowerOfTwo<T> {
    fn fft_direction(&self) -> FftDirection {
        self.direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(length: usize) -> Vec<Complex<f64>> {
        let plan = PowerOfTwo::<f64>::new(4, FftDirection::Forward);
        let mut buffer = vec![Complex::new(1.0, 0.0); length];
        let mut scratch = vec![Complex::default(); plan.get_inplace_scratch_len()];
        plan.process_with_scratch(&mut buffer, &mut scratch);
        buffer
    }

    #[test]
    fn whole_blocks_are_transformed() {
        for blocks in 0..10 {
            let expected = [[4.0, 0.0, 0.0, 0.0]].repeat(blocks).concat();
            assert_eq!(call(4 * blocks), expected.iter().map(Complex::from).collect::<Vec<_>>());
        }
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic = "a buffer of 6 numbers; expected a multiple of 4"]
    fn a_partial_block_is_found_in_debug_builds() {
        call(6);
    }

    #[test]
    #[cfg(not(debug_assertions))]
    fn a_partial_block_is_left_unchanged() {
        let re: Vec<f64> = call(6).iter().map(|z| z.re).collect();
        assert_eq!(re, [4.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    }
}
