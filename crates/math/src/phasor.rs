//! Points of the unit circle.

use num_complex::Complex64;

/// `exp(j phase_rad)`, the same to the last bit on every platform.
pub fn cis(phase_rad: f64) -> Complex64 {
    let (sin, cos) = libm::sincos(phase_rad);
    Complex64::new(cos, sin)
}
