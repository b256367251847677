//! Four transforms at a time, for data that is made in that order.

use super::Transforms;
use super::power_of_two::{LANES, Point, PowerOfTwo};
use rustfft::FftDirection;
use rustfft::num_complex::Complex;

/// A number of each of four sequences: four real parts, then four imaginary ones, in the memory of four
/// complex numbers.
pub type Quad<T> = [Complex<T>; LANES];

/// Four numbers of these real and imaginary parts.
#[inline(always)]
pub fn quad<T: Transforms>(re: T::Four, im: T::Four) -> Quad<T> {
    Point::of([re, im])
}

/// The real and the imaginary parts of four numbers.
#[inline(always)]
pub fn parts<T: Transforms>(numbers: Quad<T>) -> [T::Four; 2] {
    numbers.parts()
}

/// Forward transforms of four sequences side by side: `X[k] = sum x[n] exp(-2 pi j n k / length)` of each.
pub struct SideBySide<T: Transforms> {
    transform: PowerOfTwo<T>,
    /// The numbers, and room for as many.
    points: [Vec<Quad<T>>; 2],
}

impl<T: Transforms> SideBySide<T> {
    /// Plans for sequences of `length` numbers; nothing unless that is a power of two.
    pub fn new(length: usize) -> Option<Self> {
        let zero = [Complex::new(T::zero(), T::zero()); LANES];
        length.is_power_of_two().then(|| Self {
            transform: PowerOfTwo::new(length, FftDirection::Forward),
            points: [vec![zero; length], vec![zero; length]],
        })
    }

    /// The numbers to transform, as the last transform left them.
    pub fn input(&mut self) -> &mut [Quad<T>] {
        &mut self.points[0]
    }

    /// Transforms what [`SideBySide::input`] holds, and overwrites it.
    pub fn run(&mut self) -> &[Quad<T>] {
        let [x, y] = &mut self.points;
        if self.transform.run(x, y) { y } else { x }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use num_complex::Complex64;

    #[test]
    fn each_sequence_has_its_own_transform() {
        assert!(SideBySide::<f64>::new(12).is_none() && SideBySide::<f64>::new(0).is_none());
        let mut random = Random::new(8, 0);
        for length in [1, 2, 4, 8, 32, 64, 128] {
            let rows: [Vec<Complex64>; LANES] =
                std::array::from_fn(|_| (0..length).map(|_| random.complex_normal(1.0)).collect());
            let mut fft = SideBySide::<f64>::new(length).unwrap();
            for (n, x) in fft.input().iter_mut().enumerate() {
                let row = [0, 1, 2, 3].map(|lane: usize| rows[lane][n]);
                *x = quad::<f64>(row.map(|z| z.re).into(), row.map(|z| z.im).into());
            }
            let found: Vec<[[f64; LANES]; 2]> =
                fft.run().iter().map(|&x| parts::<f64>(x).map(Into::into)).collect();
            for (lane, mut row) in rows.into_iter().enumerate() {
                f64::plan_forward(length).process(&mut row);
                for (x, expected) in found.iter().zip(&row) {
                    let x = Complex64::new(x[0][lane], x[1][lane]);
                    assert!((x - expected).norm() < 1e-13 * length as f64, "{length}, {lane}");
                }
            }
        }
    }
}
