//! Powers of two by Stockham's self-sorting form of the FFT (Cochran et al. 1967), radix 4: its
//! inner loops run over neighbouring numbers, which compilers turn into SIMD by themselves.

use rustfft::num_complex::Complex;
use rustfft::{Direction, Fft, FftDirection, FftNum, Length};
use std::f64::consts::TAU;

/// A transform whose length is a power of two.
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

impl<T: FftNum> PowerOfTwo<T> {
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

    /// Transforms `x` in place; `y` is of the same length.
    fn run(&self, x: &mut [Complex<T>], y: &mut [Complex<T>]) {
        let (mut from, mut to) = (x, y);
        let mut swapped = false;
        for stage in &self.stages {
            match self.direction {
                FftDirection::Forward => stage.run::<true>(from, to),
                FftDirection::Inverse => stage.run::<false>(from, to),
            }
            std::mem::swap(&mut from, &mut to);
            swapped = !swapped;
        }
        if self.halves {
            let (a, b) = from.split_at(self.length / 2);
            let (sums, differences) = to.split_at_mut(self.length / 2);
            for (((sum, difference), a), b) in sums.iter_mut().zip(differences).zip(a).zip(b) {
                *sum = a + b;
                *difference = a - b;
            }
            std::mem::swap(&mut from, &mut to);
            swapped = !swapped;
        }
        if swapped {
            to.copy_from_slice(from);
        }
    }
}

impl<T: FftNum> Stage<T> {
    fn run<const FORWARD: bool>(&self, x: &[Complex<T>], y: &mut [Complex<T>]) {
        let quarter = x.len() / 4;
        let (x0, rest) = x.split_at(quarter);
        let (x1, rest) = rest.split_at(quarter);
        let (x2, x3) = rest.split_at(quarter);
        let inputs = x0.iter().zip(x1).zip(x2).zip(x3);
        if self.stride == 1 {
            for ((y, w), (((a, b), c), d)) in y.chunks_exact_mut(4).zip(&self.twiddles).zip(inputs)
            {
                let out = butterfly::<T, FORWARD>([*a, *b, *c, *d], w);
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
                    butterfly::<T, FORWARD>([x0[q], x1[q], x2[q], x3[q]], w);
            }
        }
    }
}

/// Transform of four numbers, turned by the twiddle factors.
#[inline(always)]
fn butterfly<T: FftNum, const FORWARD: bool>(
    [a, b, c, d]: [Complex<T>; 4],
    [w1, w2, w3]: &[Complex<T>; 3],
) -> [Complex<T>; 4] {
    let (even_sum, even_difference) = (a + c, a - c);
    let (odd_sum, odd) = (b + d, b - d);
    // -j (b - d) forward, +j (b - d) inverse.
    let turned =
        if FORWARD { Complex::new(odd.im, -odd.re) } else { Complex::new(-odd.im, odd.re) };
    [
        even_sum + odd_sum,
        (even_difference + turned) * w1,
        (even_sum - odd_sum) * w2,
        (even_difference - turned) * w3,
    ]
}

fn twiddle<T: FftNum>(phase_rad: f64) -> Complex<T> {
    let z = crate::steering::cis(phase_rad);
    let part = |x: f64| T::from_f64(x).unwrap_or_else(T::zero);
    Complex::new(part(z.re), part(z.im))
}

impl<T: FftNum> Fft<T> for PowerOfTwo<T> {
    fn process_with_scratch(&self, buffer: &mut [Complex<T>], scratch: &mut [Complex<T>]) {
        for block in buffer.chunks_exact_mut(self.length) {
            self.run(block, &mut scratch[..self.length]);
        }
    }

    fn process_outofplace_with_scratch(
        &self,
        input: &mut [Complex<T>],
        output: &mut [Complex<T>],
        _scratch: &mut [Complex<T>],
    ) {
        let blocks = input.chunks_exact_mut(self.length);
        for (from, to) in blocks.zip(output.chunks_exact_mut(self.length)) {
            to.copy_from_slice(from);
            self.run(to, from);
        }
    }

    fn process_immutable_with_scratch(
        &self,
        input: &[Complex<T>],
        output: &mut [Complex<T>],
        scratch: &mut [Complex<T>],
    ) {
        output.copy_from_slice(input);
        self.process_with_scratch(output, scratch);
    }

    fn get_inplace_scratch_len(&self) -> usize {
        self.length
    }

    fn get_outofplace_scratch_len(&self) -> usize {
        0
    }

    fn get_immutable_scratch_len(&self) -> usize {
        self.length
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
