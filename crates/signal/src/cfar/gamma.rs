//! Gamma distributions, whose shapes need not be whole: the mean of `L` exponential powers has
//! shape `L`, that of `n` such cells shape `n L`.

/// Logarithms of the regularised incomplete gamma functions `P(shape, x)` and `Q = 1 - P`, by
/// series below `shape + 1` and by continued fraction above.
pub fn ln_incomplete(shape: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (f64::NEG_INFINITY, 0.0);
    }
    let ln_front = shape * x.ln() - x - libm::lgamma(shape);
    if x < shape + 1.0 {
        let (mut term, mut sum, mut k) = (1.0 / shape, 1.0 / shape, shape);
        while term > sum * 1e-17 {
            k += 1.0;
            term *= x / k;
            sum += term;
        }
        let ln_p = (ln_front + sum.ln()).min(0.0);
        (ln_p, ln_complement(ln_p))
    } else {
        // 1 / (x + 1 - a - 1 (1 - a) / (x + 3 - a - ...)).
        let mut fraction = Lentz::new(x + 1.0 - shape);
        for k in 1..100_000 {
            let k = f64::from(k);
            if fraction.step(-k * (k - shape), x + 1.0 - shape + 2.0 * k) < 1e-15 {
                break;
            }
        }
        let ln_q = (ln_front - fraction.value.ln()).min(0.0);
        (ln_complement(ln_q), ln_q)
    }
}

/// Logarithms of the regularised incomplete beta function `I_x(a, b)` and of `1 - I`, for the logarithms of `x` and
/// `1 - x`: by continued fraction, of the smaller of the two.
pub fn ln_incomplete_beta(a: f64, b: f64, ln_x: f64, ln_rest: f64) -> (f64, f64) {
    if ln_x == f64::NEG_INFINITY {
        return (f64::NEG_INFINITY, 0.0);
    }
    let x = ln_x.exp();
    if x > (a + 1.0) / (a + b + 2.0) {
        let (ln_above, ln_below) = ln_beta_by_fraction(b, a, ln_rest, ln_x);
        (ln_below, ln_above)
    } else {
        ln_beta_by_fraction(a, b, ln_x, ln_rest)
    }
}

fn ln_beta_by_fraction(a: f64, b: f64, ln_x: f64, ln_rest: f64) -> (f64, f64) {
    if ln_x == f64::NEG_INFINITY {
        return (f64::NEG_INFINITY, 0.0);
    }
    let x = ln_x.exp();
    let ln_front =
        libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * ln_x + b * ln_rest - a.ln();
    let mut fraction = Lentz::new(1.0);
    for m in 0..10_000 {
        let m = f64::from(m);
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let even = (m + 1.0) * (b - m - 1.0) * x / ((a + 2.0 * m + 1.0) * (a + 2.0 * m + 2.0));
        fraction.step(odd, 1.0);
        if fraction.step(even, 1.0) < 1e-15 {
            break;
        }
    }
    let ln = (ln_front - fraction.value.ln()).min(0.0);
    (ln, ln_complement(ln))
}

/// Lentz's evaluation of a continued fraction `b0 + a1 / (b1 + a2 / (b2 + ...))`, modified by Thompson and Barnett.
struct Lentz {
    value: f64,
    c: f64,
    d: f64,
}

impl Lentz {
    fn new(b: f64) -> Self {
        Self { value: b, c: b, d: 0.0 }
    }

    /// Takes a further partial fraction; how much the value changed, as a share.
    fn step(&mut self, a: f64, b: f64) -> f64 {
        const TINY: f64 = 1e-300;
        let nonzero = |x: f64| if x.abs() < TINY { TINY } else { x };
        self.d = 1.0 / nonzero(a * self.d + b);
        self.c = nonzero(b + a / self.c);
        self.value *= self.c * self.d;
        (self.c * self.d - 1.0).abs()
    }
}

/// Logarithm of the density of `ln z`, for the mean `z` of a gamma distribution of mean 1.
pub fn ln_density_of_ln(shape: f64, ln_z: f64) -> f64 {
    shape * (shape.ln() + ln_z) - shape * ln_z.exp() - libm::lgamma(shape)
}

/// Integral over the real line of `exp(ln_integrand(t))`, which has to be log-concave and
/// negligible outside -120 and 7; the trapezoidal rule converges exponentially for such.
pub fn integrate_log_concave(ln_integrand: impl Fn(f64) -> f64) -> f64 {
    const LOW: f64 = -120.0;
    const HIGH: f64 = 7.0;
    const NEGLIGIBLE: f64 = 40.0;
    const NODES: u32 = 160;
    let (mut a, mut b) = (LOW, HIGH);
    while b - a > 1e-3 {
        let (left, right) = (a + (b - a) * 0.382, a + (b - a) * 0.618);
        if ln_integrand(left) < ln_integrand(right) { a = left } else { b = right }
    }
    let peak = 0.5 * (a + b);
    let floor = ln_integrand(peak) - NEGLIGIBLE;
    let edge = |outside: f64| {
        let (mut out, mut inside) = (outside, peak);
        while (out - inside).abs() > 0.01 * (out - peak).abs() + 1e-6 {
            let middle = 0.5 * (out + inside);
            if ln_integrand(middle) < floor { out = middle } else { inside = middle }
        }
        out
    };
    let (low, high) = (edge(LOW), edge(HIGH));
    let step = (high - low) / f64::from(NODES);
    (0..=NODES).map(|k| ln_integrand(low + step * f64::from(k)).exp()).sum::<f64>() * step
}

/// `ln(1 - exp(x))` for `x <= 0`.
fn ln_complement(x: f64) -> f64 {
    if x > -0.5 { (-x.exp_m1()).ln() } else { (-x.exp()).ln_1p() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// scipy.special.gammainc and gammaincc.
    #[test]
    fn incomplete_gamma_functions_are_those_of_scipy() {
        GOLDEN.iter().for_each(|&(shape, x, p, q)| {
            let (ln_p, ln_q) = ln_incomplete(shape, x);
            assert!((ln_p.exp() / p - 1.0).abs() < 1e-11, "P({shape}, {x}) = {}", ln_p.exp());
            assert!((ln_q.exp() / q - 1.0).abs() < 1e-11, "Q({shape}, {x}) = {}", ln_q.exp());
        });
    }

    /// scipy.special.betainc and betaincc.
    #[test]
    fn incomplete_beta_functions_are_those_of_scipy() {
        for (a, b, x, below, above) in BETA {
            let (ln_below, ln_above) = ln_incomplete_beta(a, b, f64::ln(x), f64::ln_1p(-x));
            assert!((ln_below.exp() / below - 1.0).abs() < 1e-11, "I({a}, {b}, {x})");
            assert!((ln_above.exp() / above - 1.0).abs() < 1e-11, "1 - I({a}, {b}, {x})");
        }
        assert_eq!(ln_incomplete_beta(2.0, 3.0, f64::NEG_INFINITY, 0.0).1, 0.0);
        assert_eq!(ln_incomplete_beta(2.0, 3.0, 0.0, f64::NEG_INFINITY).0, 0.0);
    }

    const BETA: [(f64, f64, f64, f64, f64); 4] = [
        (2.3, 4.1, 0.3, 0.4086607467861006, 0.5913392532138997),
        (0.7, 9.2, 0.001, 0.04072639504196918, 0.9592736049580308),
        (12.5, 3.2, 0.9, 0.8586693308308555, 0.1413306691691445),
        (1.0, 1.0, 0.4, 0.4, 0.6),
    ];

    #[test]
    fn densities_integrate_to_one() {
        for shape in [1.0, 1.7, 8.0, 128.0, 5504.0] {
            let one = integrate_log_concave(|t| ln_density_of_ln(shape, t));
            assert!((one - 1.0).abs() < 1e-9, "{shape}: {one}");
        }
    }

    const GOLDEN: [(f64, f64, f64, f64); 8] = [
        (1.0, 0.3, 0.25918177931828207, 0.740818220681718),
        (1.0, 20.0, 0.9999999979388464, 2.0611536224385566e-09),
        (1.7, 0.01, 0.00025611012923307827, 0.9997438898707669),
        (8.0, 3.0, 0.01190450385635739, 0.9880954961436426),
        (8.0, 30.0, 0.9999994766265833, 5.233734167070702e-07),
        (128.0, 90.0, 9.42954316546573e-05, 0.9999057045683453),
        (128.0, 200.0, 0.999999979053984, 2.094601605403981e-08),
        (5504.0, 5600.0, 0.9016537519862291, 0.09834624801377093),
    ];
}
