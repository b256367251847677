//! Inner loops over complex vectors held as separate real and imaginary parts, which compilers
//! turn into SIMD instructions. They do so with sums into a vector by themselves; sums of products
//! into one number name their vectors.

use wide::f64x2;

/// Real and imaginary parts of a complex vector.
pub(super) type Parts<'a> = (&'a [f64], &'a [f64]);

/// Real and imaginary parts of a complex vector to be changed.
pub(super) type PartsMut<'a> = (&'a mut [f64], &'a mut [f64]);

/// `sum conj(x_k) y_k`, as far as both reach.
#[inline]
pub(super) fn dot_conjugate(x: Parts<'_>, y: Parts<'_>) -> (f64, f64) {
    let n = x.0.len().min(y.0.len());
    let ((xr, xr_end), (xi, xi_end)) = (x.0[..n].as_chunks(), x.1[..n].as_chunks());
    let ((yr, yr_end), (yi, yi_end)) = (y.0[..n].as_chunks(), y.1[..n].as_chunks());
    let (mut rr, mut ii, mut ri, mut ir) = (f64x2::ZERO, f64x2::ZERO, f64x2::ZERO, f64x2::ZERO);
    for ((&xr, &xi), (&yr, &yi)) in xr.iter().zip(xi).zip(yr.iter().zip(yi)) {
        let (xr, xi) = (f64x2::new(xr), f64x2::new(xi));
        let (yr, yi) = (f64x2::new(yr), f64x2::new(yi));
        rr += xr * yr;
        ii += xi * yi;
        ri += xr * yi;
        ir += xi * yr;
    }
    let (mut re, mut im) = ((rr + ii).reduce_add(), (ri - ir).reduce_add());
    if let ([xr], [xi], [yr], [yi]) = (xr_end, xi_end, yr_end, yi_end) {
        re += xr * yr + xi * yi;
        im += xr * yi - xi * yr;
    }
    (re, im)
}

/// `y += (re + j im) x`.
#[inline]
pub(super) fn add_scaled(y: PartsMut<'_>, (re, im): (f64, f64), x: Parts<'_>) {
    let n = y.0.len().min(x.0.len());
    let (yr, yi, xr, xi) = (&mut y.0[..n], &mut y.1[..n], &x.0[..n], &x.1[..n]);
    for k in 0..n {
        yr[k] += re * xr[k] - im * xi[k];
        yi[k] += re * xi[k] + im * xr[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use num_complex::Complex64;

    #[test]
    fn agree_with_complex_arithmetic_at_every_length() {
        let mut random = Random::new(8, 0);
        for n in 0..11 {
            let x: Vec<Complex64> = (0..n).map(|_| random.complex_normal(1.0)).collect();
            let y: Vec<Complex64> = (0..n).map(|_| random.complex_normal(1.0)).collect();
            let parts = |z: &[Complex64]| -> (Vec<f64>, Vec<f64>) {
                (z.iter().map(|z| z.re).collect(), z.iter().map(|z| z.im).collect())
            };
            let ((xr, xi), (mut yr, mut yi)) = (parts(&x), parts(&y));
            let mixed: Complex64 = x.iter().zip(&y).map(|(x, y)| x.conj() * y).sum();
            let (re, im) = dot_conjugate((&xr, &xi), (&yr, &yi));
            assert!((Complex64::new(re, im) - mixed).norm() < 1e-14);
            let scale = Complex64::new(0.3, -2.0);
            add_scaled((&mut yr, &mut yi), (scale.re, scale.im), (&xr, &xi));
            for k in 0..n {
                assert!((Complex64::new(yr[k], yi[k]) - y[k] - scale * x[k]).norm() < 1e-14);
            }
        }
    }
}
