//! Hermitian matrices to tridiagonal form by Householder reflections, and the eigenvalues of that by
//! the implicit QL algorithm (Golub and Van Loan, Matrix Computations, 8.3). Real and imaginary
//! parts are kept apart, so that the inner loops compile to vector instructions.

use super::hermitian::LANES;
use crate::error::{InputError, check_finite};
use ndarray::ArrayView2;
use num_complex::Complex64;
use wide::f64x2;

/// A row of four numbers, one of each of the vectors transformed together.
type Lanes = [f64; LANES];

/// Entries below this fraction of the largest are treated as zero. Squares of larger ones neither
/// underflow nor lead to quotients that overflow, and the perturbation is far below rounding.
const NEGLIGIBLE: f64 = 1e-30;

/// `A = scale Q T Q^H` with a real tridiagonal `T` and a unitary `Q` kept as reflections.
pub(super) struct Tridiagonal {
    /// Diagonal of `T`.
    pub diagonal: Vec<f64>,
    /// `off_diagonal[i]` couples `i` and `i + 1`; the last is 0.
    pub off_diagonal: Vec<f64>,
    /// What the matrix was divided by.
    pub scale: f64,
    reflections: Planes,
    /// `2 / |v|^2` of the reflection held in each row; 0 where there is none.
    strengths: Vec<f64>,
    /// Unit numbers that make the off-diagonal real.
    phases: Vec<Complex64>,
}

/// Square matrix in two planes of rows.
struct Planes {
    n: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Planes {
    fn row(&self, i: usize, length: usize) -> (&[f64], &[f64]) {
        let start = i * self.n;
        (&self.re[start..start + length], &self.im[start..start + length])
    }

    fn row_mut(&mut self, i: usize, length: usize) -> (&mut [f64], &mut [f64]) {
        let start = i * self.n;
        (&mut self.re[start..start + length], &mut self.im[start..start + length])
    }
}

impl Tridiagonal {
    /// Reduces a finite matrix, of which the lower triangle is read, from its last row upwards.
    ///
    /// # Errors
    /// [`InputError::NotFinite`] if an intermediate value overflows.
    pub fn new(matrix: ArrayView2<Complex64>) -> Result<Self, InputError> {
        let n = matrix.nrows();
        let largest = |m: f64, z: &Complex64| m.max(z.re.abs()).max(z.im.abs());
        let scale = matrix.iter().fold(0.0, largest);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let mut a = Planes { n, re: vec![0.0; n * n], im: vec![0.0; n * n] };
        for i in 0..n {
            let (re, im) = a.row_mut(i, i + 1);
            for (k, (re, im)) in re.iter_mut().zip(im).enumerate() {
                *re = matrix[[i, k]].re / scale;
                *im = matrix[[i, k]].im / scale;
            }
        }
        let mut diagonal = vec![0.0; n];
        let mut coupling = vec![Complex64::ZERO; n];
        let mut strengths = vec![0.0; n];
        let (mut v, mut w) = ((vec![0.0; n], vec![0.0; n]), (vec![0.0; n], vec![0.0; n]));
        for i in (1..n).rev() {
            diagonal[i] = a.re[i * n + i];
            let (vre, vim) = (&mut v.0[..i], &mut v.1[..i]);
            let (strength, end) = reflection(a.row(i, i), (vre, vim));
            coupling[i - 1] = end;
            strengths[i] = strength;
            if strength > 0.0 {
                reflect_both_sides(&mut a, strength, (vre, vim), (&mut w.0[..i], &mut w.1[..i]));
            }
            let (re, im) = a.row_mut(i, i);
            re.copy_from_slice(vre);
            im.copy_from_slice(vim);
        }
        diagonal[0] = a.re[0];
        let mut phases = vec![Complex64::new(1.0, 0.0); n];
        let mut off_diagonal = vec![0.0; n];
        for i in 0..n - 1 {
            let size = coupling[i].norm();
            (off_diagonal[i], phases[i + 1]) = if size > NEGLIGIBLE {
                (size, phases[i] * (coupling[i].conj() / size))
            } else {
                (0.0, phases[i])
            };
        }
        let entries = diagonal.iter().chain(&off_diagonal).chain(&strengths).copied();
        check_finite("tridiagonal form of the matrix", entries)?;
        Ok(Self { diagonal, off_diagonal, scale, reflections: a, strengths, phases })
    }

    /// `Q z` of four real vectors `z`, as real and imaginary parts.
    pub fn back_transform(&self, z: &[Lanes]) -> (Vec<Lanes>, Vec<Lanes>) {
        let times = |part: fn(&Complex64) -> f64| -> Vec<Lanes> {
            self.phases.iter().zip(z).map(|(phase, z)| z.map(|z| part(phase) * z)).collect()
        };
        let (mut re, mut im) = (times(|p| p.re), times(|p| p.im));
        for i in 1..z.len() {
            let strength = self.strengths[i];
            if strength == 0.0 {
                continue;
            }
            let (vre, vim) = self.reflections.row(i, i);
            let (mut sre, mut sim) = ([0.0; LANES], [0.0; LANES]);
            for (((&vr, &vi), zr), zi) in vre.iter().zip(vim).zip(&re).zip(&im) {
                for lane in 0..LANES {
                    sre[lane] += vr * zr[lane] + vi * zi[lane];
                    sim[lane] += vr * zi[lane] - vi * zr[lane];
                }
            }
            let (sre, sim) = (sre.map(|s| s * strength), sim.map(|s| s * strength));
            for (((&vr, &vi), zr), zi) in vre.iter().zip(vim).zip(&mut re).zip(&mut im) {
                for lane in 0..LANES {
                    zr[lane] -= vr * sre[lane] - vi * sim[lane];
                    zi[lane] -= vr * sim[lane] + vi * sre[lane];
                }
            }
        }
        (re, im)
    }
}

/// The `v` for which `I - strength v v^H` maps the conjugate of a row onto its last entry alone,
/// with `strength = 2 / |v|^2`, and that entry; strength 0 where the other entries are negligible.
fn reflection(row: (&[f64], &[f64]), v: (&mut [f64], &mut [f64])) -> (f64, Complex64) {
    let last = row.0.len() - 1;
    v.0.copy_from_slice(row.0);
    v.1.iter_mut().zip(row.1).for_each(|(v, a)| *v = -a);
    let square = |re: &[f64], im: &[f64]| -> f64 {
        re.iter().zip(im).map(|(re, im)| re * re + im * im).sum()
    };
    let rest = square(&v.0[..last], &v.1[..last]);
    let alpha = Complex64::new(v.0[last], v.1[last]);
    if rest <= NEGLIGIBLE * NEGLIGIBLE {
        return (0.0, alpha);
    }
    let length = (rest + alpha.norm_sqr()).sqrt();
    let size = alpha.norm();
    let turn = if size > 0.0 { alpha / size } else { Complex64::new(1.0, 0.0) };
    let moved = alpha + turn * length;
    (v.0[last], v.1[last]) = (moved.re, moved.im);
    (2.0 / (rest + moved.norm_sqr()), -turn * length)
}

/// `A -> H A H` with `H = I - strength v v^H` on the leading rows and columns that `v` spans.
fn reflect_both_sides(
    a: &mut Planes,
    strength: f64,
    v: (&[f64], &[f64]),
    w: (&mut [f64], &mut [f64]),
) {
    let m = v.0.len();
    w.0.fill(0.0);
    w.1.fill(0.0);
    for i in 0..m {
        let own = a.re[i * a.n + i];
        let (vr, vi) = (v.0[i], v.1[i]);
        let (before_re, after_re) = w.0.split_at_mut(i);
        let (before_im, after_im) = w.1.split_at_mut(i);
        let (re, im) =
            product_and_spread(a.row(i, i), (&v.0[..i], &v.1[..i]), (vr, vi), before_re, before_im);
        after_re[0] += re + own * vr;
        after_im[0] += im + own * vi;
    }
    let inner: f64 = (0..m).map(|i| v.0[i] * w.0[i] + v.1[i] * w.1[i]).sum();
    let share = 0.5 * strength * strength * inner;
    for i in 0..m {
        w.0[i] = strength * w.0[i] - share * v.0[i];
        w.1[i] = strength * w.1[i] - share * v.1[i];
    }
    for i in 0..m {
        let (vr, vi, wr, wi) = (v.0[i], v.1[i], w.0[i], w.1[i]);
        let length = i + 1;
        let (re, im) = a.row_mut(i, length);
        let (xr, xi) = (&v.0[..length], &v.1[..length]);
        let (yr, yi) = (&w.0[..length], &w.1[..length]);
        for k in 0..length {
            re[k] -= vr * yr[k] + vi * yi[k] + wr * xr[k] + wi * xi[k];
            im[k] -= vi * yr[k] - vr * yi[k] + wi * xr[k] - wr * xi[k];
        }
    }
}

/// `sum a_k v_k` of a row `a`, and at the same pass `w_k += conj(a_k) s`.
fn product_and_spread(
    a: (&[f64], &[f64]),
    v: (&[f64], &[f64]),
    s: (f64, f64),
    wre: &mut [f64],
    wim: &mut [f64],
) -> (f64, f64) {
    let (sr, si) = (f64x2::splat(s.0), f64x2::splat(s.1));
    let (mut rr, mut ii, mut ri, mut ir) = (f64x2::ZERO, f64x2::ZERO, f64x2::ZERO, f64x2::ZERO);
    let ((a_re, a_re_end), (a_im, a_im_end)) = (a.0.as_chunks(), a.1.as_chunks());
    let ((v_re, v_re_end), (v_im, v_im_end)) = (v.0.as_chunks(), v.1.as_chunks());
    let ((w_re, w_re_end), (w_im, w_im_end)) = (wre.as_chunks_mut(), wim.as_chunks_mut());
    let row = a_re.iter().zip(a_im).zip(v_re.iter().zip(v_im)).zip(w_re.iter_mut().zip(w_im));
    for (((&ar, &ai), (&vr, &vi)), (wr, wi)) in row {
        let (ar, ai) = (f64x2::new(ar), f64x2::new(ai));
        let (vr, vi) = (f64x2::new(vr), f64x2::new(vi));
        rr += ar * vr;
        ii += ai * vi;
        ri += ar * vi;
        ir += ai * vr;
        *wr = (f64x2::new(*wr) + (ar * sr + ai * si)).to_array();
        *wi = (f64x2::new(*wi) + (ar * si - ai * sr)).to_array();
    }
    let mut re = (rr - ii).reduce_add();
    let mut im = (ri + ir).reduce_add();
    if let ([ar], [ai], [vr], [vi], [wr], [wi]) =
        (a_re_end, a_im_end, v_re_end, v_im_end, w_re_end, w_im_end)
    {
        re += ar * vr - ai * vi;
        im += ar * vi + ai * vr;
        *wr += ar * s.0 + ai * s.1;
        *wi += ar * s.1 - ai * s.0;
    }
    (re, im)
}

/// A plane rotation of entries `first` and `first + 1`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rotation {
    first: usize,
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// Turns the rows `first` and `first + 1`.
    pub fn apply(&self, z: &mut [Lanes]) {
        let (cos, sin) = (self.cos, self.sin);
        let [upper, lower] = [z[self.first], z[self.first + 1]];
        for lane in 0..LANES {
            z[self.first][lane] = cos * upper[lane] + sin * lower[lane];
            z[self.first + 1][lane] = cos * lower[lane] - sin * upper[lane];
        }
    }
}

/// Sweeps per row after which the iteration is abandoned. LAPACK's `steqr` allows as many; two to
/// three are usual.
const SWEEPS_PER_ROW: usize = 30;

/// Replaces the diagonal of a finite symmetric tridiagonal matrix by its eigenvalues, in no order,
/// and returns the rotations whose product, the first one leftmost, is the matrix of eigenvectors.
///
/// # Errors
/// [`InputError::NotConverged`] after 30 sweeps per row.
pub(super) fn ql(d: &mut [f64], e: &mut [f64]) -> Result<Vec<Rotation>, InputError> {
    let n = d.len();
    let norm = d.iter().chain(e.iter()).fold(0.0_f64, |m, x| m.max(x.abs()));
    let floor = NEGLIGIBLE * norm;
    let mut rotations = Vec::with_capacity(n * n);
    let mut sweeps = 0;
    for l in 0..n {
        loop {
            let converged = |m: usize| {
                let size = e[m].abs();
                size <= f64::EPSILON * (d[m].abs() + d[m + 1].abs()) || size <= floor
            };
            let m = (l..n - 1).find(|&m| converged(m)).unwrap_or(n - 1);
            if m == l {
                break;
            }
            if sweeps == SWEEPS_PER_ROW * n {
                return Err(InputError::NotConverged {
                    what: "eigenvalues of the Hermitian matrix".into(),
                    iterations: sweeps,
                });
            }
            sweeps += 1;
            ql_sweep(d, e, l, m, &mut rotations);
        }
    }
    Ok(rotations)
}

/// One implicit QL step with Wilkinson's shift on the block from `l` to `m`.
fn ql_sweep(d: &mut [f64], e: &mut [f64], l: usize, m: usize, rotations: &mut Vec<Rotation>) {
    let half = (d[l + 1] - d[l]) / (2.0 * e[l]);
    let root = (half * half + 1.0).sqrt();
    let mut g = d[m] - d[l] + e[l] / (half + root.copysign(half));
    let (mut sin, mut cos, mut shift) = (1.0, 1.0, 0.0);
    for i in (l..m).rev() {
        let f = sin * e[i];
        let b = cos * e[i];
        let r = (f * f + g * g).sqrt();
        // The block separates here. A smaller `r` has lost digits to underflow, and its rotation
        // would not be orthogonal.
        if r < f64::MIN_POSITIVE.sqrt() {
            e[i + 1] = 0.0;
            d[i + 1] -= shift;
            e[m] = 0.0;
            return;
        }
        e[i + 1] = r;
        let inverse = 1.0 / r;
        sin = f * inverse;
        cos = g * inverse;
        g = d[i + 1] - shift;
        let t = (d[i] - g) * sin + 2.0 * cos * b;
        shift = sin * t;
        d[i + 1] = g + shift;
        g = cos * t - b;
        rotations.push(Rotation { first: i, cos, sin });
    }
    d[l] -= shift;
    e[l] = g;
    e[m] = 0.0;
}
