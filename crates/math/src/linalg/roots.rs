//! Roots of complex polynomials by the method of Aberth (1973) and Ehrlich (1967).

use crate::phasor::cis;
use num_complex::Complex64;

const MAX_ITERATIONS: usize = 200;

/// All roots of `c[0] + c[1] z + ... + c[n] z^n`, iterated together with cubic convergence; `None`
/// if a coefficient is not finite or the iteration does not settle. Leading zeros of the highest
/// powers are dropped; a constant has no roots.
pub fn polynomial_roots(coefficients: &[Complex64]) -> Option<Vec<Complex64>> {
    if coefficients.iter().any(|c| !(c.re.is_finite() && c.im.is_finite())) {
        return None;
    }
    let largest = coefficients.iter().map(|c| c.norm()).fold(0.0, f64::max);
    let last = coefficients.iter().rposition(|c| c.norm() > largest * 1e-300)?;
    let first = coefficients.iter().position(|c| c.norm() > largest * 1e-300)?;
    let reduced: Vec<Complex64> = coefficients[first..=last].iter().map(|c| c / largest).collect();
    let mut roots = vec![Complex64::ZERO; first];
    roots.extend(aberth(&reduced)?);
    Some(roots)
}

fn aberth(c: &[Complex64]) -> Option<Vec<Complex64>> {
    let degree = c.len() - 1;
    let mut roots = starting_points(c);
    let mut settled = vec![false; degree];
    for _ in 0..MAX_ITERATIONS {
        for k in 0..degree {
            if settled[k] {
                continue;
            }
            let z = roots[k];
            let (newton, at_rounding) = newton_step(c, z);
            if at_rounding {
                settled[k] = true;
                continue;
            }
            let mut repulsion = Complex64::ZERO;
            for (m, &other) in roots.iter().enumerate() {
                if m != k {
                    let gap = z - other;
                    if gap.norm_sqr() > 0.0 {
                        repulsion += gap.inv();
                    }
                }
            }
            let step = newton / (Complex64::new(1.0, 0.0) - newton * repulsion);
            if !(step.re.is_finite() && step.im.is_finite()) {
                roots[k] += cis(k as f64) * (1e-3 * (1.0 + z.norm()));
                continue;
            }
            roots[k] -= step;
            settled[k] = step.norm() <= 4.0 * f64::EPSILON * roots[k].norm();
        }
        if settled.iter().all(|&done| done) {
            return Some(roots);
        }
    }
    None
}

/// `p(z) / p'(z)`, and whether `p(z)` is zero to rounding. Outside the unit circle the reversed
/// polynomial is used, which cannot overflow.
fn newton_step(c: &[Complex64], z: Complex64) -> (Complex64, bool) {
    let degree = (c.len() - 1) as f64;
    let inside = z.norm_sqr() <= 1.0;
    let x = if inside { z } else { z.inv() };
    let size = x.norm();
    let (mut value, mut slope, mut bound) = (Complex64::ZERO, Complex64::ZERO, 0.0);
    let mut step = |a: Complex64| {
        slope = slope * x + value;
        value = value * x + a;
        bound = bound * size + a.norm();
    };
    if inside {
        c.iter().rev().for_each(|&a| step(a));
    } else {
        c.iter().for_each(|&a| step(a));
    }
    let at_rounding = value.norm() <= 4.0 * f64::EPSILON * bound;
    if inside {
        return (value / slope, at_rounding);
    }
    // p(z) = z^n q(1/z), so p/p' = z / (n - x q'(x) / q(x)).
    (z / (Complex64::new(degree, 0.0) - x * slope / value), at_rounding)
}

/// Points on circles whose radii follow the upper hull of `log |c|` (Bini 1996).
fn starting_points(c: &[Complex64]) -> Vec<Complex64> {
    let logs: Vec<f64> = c.iter().map(|a| a.norm().ln()).collect();
    let mut hull: Vec<usize> = Vec::new();
    for k in 0..c.len() {
        if logs[k] == f64::NEG_INFINITY {
            continue;
        }
        while let [.., i, j] = hull[..] {
            let rise = |a: usize, b: usize| (logs[b] - logs[a]) / (b - a) as f64;
            if rise(i, j) <= rise(j, k) {
                hull.pop();
            } else {
                break;
            }
        }
        hull.push(k);
    }
    let mut points = Vec::with_capacity(c.len() - 1);
    for pair in hull.windows(2) {
        let count = pair[1] - pair[0];
        let radius = ((logs[pair[0]] - logs[pair[1]]) / count as f64).exp();
        for k in 0..count {
            let turn = std::f64::consts::TAU * (k as f64 / count as f64 + pair[0] as f64 * 0.37);
            points.push(cis(turn + 0.7) * radius);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn expand(roots: &[Complex64]) -> Vec<Complex64> {
        let mut c = vec![Complex64::new(1.0, 0.0)];
        for r in roots {
            c.insert(0, Complex64::ZERO);
            for k in 0..c.len() - 1 {
                let above = c[k + 1];
                c[k] -= above * r;
            }
        }
        c
    }

    #[test]
    fn finds_the_roots_a_polynomial_was_made_from() {
        let mut random = Random::new(5, 0);
        for degree in [1usize, 2, 5, 14, 30] {
            let wanted: Vec<Complex64> =
                (0..degree).map(|_| cis(random.phase()) * random.uniform(0.5, 1.5)).collect();
            let found = polynomial_roots(&expand(&wanted)).unwrap();
            assert_eq!(found.len(), degree);
            for root in &wanted {
                let nearest = found.iter().map(|z| (z - root).norm()).fold(1.0, f64::min);
                assert!(nearest < 1e-6, "degree {degree}: {root} off by {nearest}");
            }
        }
    }

    #[test]
    fn roots_of_unity_and_zero() {
        let mut c = vec![Complex64::ZERO; 64];
        c[1] = Complex64::new(-1.0, 0.0);
        c[63] = Complex64::new(1.0, 0.0);
        let found = polynomial_roots(&c).unwrap();
        assert_eq!(found.iter().filter(|z| z.norm() == 0.0).count(), 1);
        assert_eq!(found.iter().filter(|z| (z.norm() - 1.0).abs() < 1e-12).count(), 62);
    }

    #[test]
    fn hopeless_input_gives_nothing() {
        assert!(polynomial_roots(&[]).is_none());
        assert!(polynomial_roots(&[Complex64::ZERO; 4]).is_none());
        assert!(polynomial_roots(&[Complex64::new(f64::NAN, 0.0); 3]).is_none());
        assert_eq!(polynomial_roots(&[Complex64::new(2.0, 0.0)]).unwrap().len(), 0);
    }
}
