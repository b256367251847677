//! Inner loops over complex vectors held as separate real and imaginary parts, which compilers
//! turn into SIMD instructions.

/// Partial sums of a reduction; independent, so that they vectorise.
const LANES: usize = 4;

/// Real and imaginary parts of a complex vector.
pub(super) type Parts<'a> = (&'a [f64], &'a [f64]);

/// Real and imaginary parts of a complex vector to be changed.
pub(super) type PartsMut<'a> = (&'a mut [f64], &'a mut [f64]);

/// `sum conj(x_k) y_k`, as far as both reach.
#[inline]
pub(super) fn dot_conjugate(x: Parts<'_>, y: Parts<'_>) -> (f64, f64) {
    let n = x.0.len().min(y.0.len());
    let (xr, xi, yr, yi) = (&x.0[..n], &x.1[..n], &y.0[..n], &y.1[..n]);
    let (mut rr, mut ii, mut ri, mut ir) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
    let whole = n - n % LANES;
    let (a, b, c, d) = (
        xr[..whole].chunks_exact(LANES),
        xi[..whole].chunks_exact(LANES),
        yr[..whole].chunks_exact(LANES),
        yi[..whole].chunks_exact(LANES),
    );
    for (((a, b), c), d) in a.zip(b).zip(c).zip(d) {
        for l in 0..LANES {
            rr[l] += a[l] * c[l];
            ii[l] += b[l] * d[l];
            ri[l] += a[l] * d[l];
            ir[l] += b[l] * c[l];
        }
    }
    for k in whole..n {
        rr[0] += xr[k] * yr[k];
        ii[0] += xi[k] * yi[k];
        ri[0] += xr[k] * yi[k];
        ir[0] += xi[k] * yr[k];
    }
    let total = |s: [f64; LANES]| (s[0] + s[1]) + (s[2] + s[3]);
    let (rr, ii, ri, ir) = (total(rr), total(ii), total(ri), total(ir));
    (rr + ii, ri - ir)
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
    use crate::Complex64;
    use crate::random::Random;

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
