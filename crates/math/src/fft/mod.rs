//! Fast Fourier transforms in single and double precision. No transform normalises.
//!
//! Natively plans come from `rustfft`. For wasm its planner would link hundreds of kernels for
//! lengths nobody asks for, a fifth of the whole module; there [`compact`] takes its place, which
//! has one kernel for powers of two and puts other lengths together from it.
//!
//! Planned here once for each precision, transforms are not compiled again in every crate that
//! uses them.

pub mod compact;
mod power_of_two;
mod real;
mod side_by_side;

pub use real::RealFft;
use rustfft::{Fft, FftDirection, FftNum};
pub use side_by_side::{Quad, SideBySide, parts, quad};
use std::ops::{Add, Mul, Sub};
use std::sync::Arc;

/// A precision that transforms can be planned in: `f32` or `f64`.
pub trait Transforms: FftNum {
    /// Four numbers in vector registers.
    type Four: Copy
        + Send
        + Sync
        + From<[Self; 4]>
        + Into<[Self; 4]>
        + Add<Output = Self::Four>
        + Sub<Output = Self::Four>
        + Mul<Output = Self::Four>
        + Mul<Self, Output = Self::Four>;

    /// `X[k] = sum x[n] exp(-2 pi j n k / length)`.
    fn plan_forward(length: usize) -> Arc<dyn Fft<Self>>;

    /// `x[n] = sum X[k] exp(+2 pi j n k / length)`.
    fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>>;
}

macro_rules! transforms {
    ($real:ty, $four:ty) => {
        impl Transforms for $real {
            type Four = $four;

            fn plan_forward(length: usize) -> Arc<dyn Fft<Self>> {
                plan(length, FftDirection::Forward)
            }

            fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>> {
                plan(length, FftDirection::Inverse)
            }
        }
    };
}

transforms!(f32, wide::f32x4);
transforms!(f64, wide::f64x4);

#[cfg(target_arch = "wasm32")]
use compact::plan;

#[cfg(not(target_arch = "wasm32"))]
fn plan<T: FftNum>(length: usize, direction: FftDirection) -> Arc<dyn Fft<T>> {
    rustfft::FftPlanner::new().plan_fft(length, direction)
}
