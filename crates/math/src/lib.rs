//! Numerics without radar concepts: dense complex linear algebra, Fourier transforms, seeded random numbers, decibels, and the
//! error type that all crates share.
//!
//! # Example
//!
//! ```
//! use boresight_math::linalg::hermitian_eigen;
//! use ndarray::array;
//! use num_complex::Complex64;
//!
//! let one = Complex64::new(1.0, 0.0);
//! let eigen = hermitian_eigen(array![[2.0 * one, one], [one, 2.0 * one]].view())?;
//! assert!((eigen.values[0] - 3.0).abs() < 1e-12 && (eigen.values[1] - 1.0).abs() < 1e-12);
//! # Ok::<(), boresight_math::InputError>(())
//! ```

pub mod decibels;
pub mod error;
pub mod fft;
pub mod linalg;
pub mod order;
pub mod phasor;
pub mod random;

pub use error::{Details, Diagnose, InputError};
pub use random::Random;
