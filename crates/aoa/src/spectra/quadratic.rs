//! Values of a Hermitian form `a^H Q a` over steering vectors `a`: the core of every spectral
//! method.
//!
//! Elements on a lattice see the form through the sums of `Q` along equal lags alone: with
//! `q_m` the sum of `Q_kl` over `n_k - n_l = m`, `a^H Q a = sum_m q_m exp(-j pi d m u)`, one
//! transform for a whole grid of `u`.

use crate::estimators::iaa::fourier::{LagTransforms, LatticeFourier};
use crate::grid::Grid;
use crate::spectra::lags::LagPolynomial;
use boresight_core::steering::{steering_derivatives, steering_vector};
use boresight_core::{Array, Complex64, Direction, Extent, Lattice};
use boresight_math::order::ascending;
use boresight_math::phasor::cis;
use boresight_signal::sample_covariance;
use ndarray::{Array1, ArrayView2};
use std::f64::consts::PI;

/// Evaluates forms on a grid, by the fastest way the array allows.
pub(crate) struct QuadraticSpectrum {
    array: Array,
    grid: Grid,
    way: Way,
}

enum Way {
    /// Along y on a lattice: one transform.
    Lattice { lattice: Lattice, transform: Box<LatticeFourier<f64>>, circle: Vec<f64> },
    /// In a plane of constant x: sums over equal pairs of lags, then Horner's rule in azimuth.
    Plane(Plane),
    /// Any positions.
    Dense,
}

/// Pairs of elements with equal differences of position, in a plane of constant x.
struct Plane {
    /// For each pair `l < k`, row by row: index into `baselines`, and whether to conjugate.
    slots: Vec<(usize, bool)>,
    /// Differences of position: whole steps along y (not negative), distance along z.
    baselines: Vec<(usize, f64)>,
    spacing: f64,
    longest: usize,
}

impl QuadraticSpectrum {
    /// Prepares evaluation for `array` on `grid`.
    pub fn new(array: &Array, grid: &Grid) -> Self {
        let way = match array.lattice() {
            Some(lattice) => Way::lattice(lattice, grid),
            None => Plane::of(array).map_or(Way::Dense, Way::Plane),
        };
        Self { array: array.clone(), grid: grid.clone(), way }
    }

    /// Prepares evaluation without using any regularity of the array.
    #[cfg(test)]
    pub fn dense(array: &Array, grid: &Grid) -> Self {
        Self { array: array.clone(), grid: grid.clone(), way: Way::Dense }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// `a^H Q a` at every grid point, elevation-major. The lower triangle of `form` is read.
    pub fn evaluate(&mut self, form: ArrayView2<Complex64>) -> Vec<f64> {
        match &mut self.way {
            Way::Lattice { lattice, transform, circle } => {
                transform.hermitian(LagPolynomial::new(lattice, form).lags(), circle);
                let inside = self.grid.first..self.grid.first + self.grid.sines.len();
                circle[inside].to_vec()
            }
            Way::Plane(plane) => plane.evaluate(form, &self.grid),
            Way::Dense => (0..self.grid.len())
                .map(|g| {
                    hermitian_form(form, &steering_vector(&self.array, self.grid.direction(g)))
                })
                .collect(),
        }
    }

    /// `sum_n |a^H y_n|^2` at every grid point for the columns `y_n`, elevation-major.
    pub fn evaluate_snapshots(&mut self, y: ArrayView2<Complex64>) -> Vec<f64> {
        let Way::Lattice { lattice, transform, circle } = &mut self.way else {
            let count = y.ncols() as f64;
            return self.evaluate(sample_covariance(y).mapv(|z| z * count).view());
        };
        circle.fill(0.0);
        let mut placed = vec![Complex64::ZERO; lattice.span()];
        for column in y.columns() {
            placed.fill(Complex64::ZERO);
            for (&index, y) in lattice.indices.iter().zip(column) {
                placed[index] += y;
            }
            transform.add_power(&placed, circle);
        }
        let inside = self.grid.first..self.grid.first + self.grid.sines.len();
        circle[inside].to_vec()
    }

    /// Moves `start` to the nearest stationary point of `a^H Q a` that is a minimum (or a maximum)
    /// by Newton steps on the exact form, never further than one grid step; returns where it ended
    /// and the form's value there.
    pub fn refine(
        &self,
        form: ArrayView2<Complex64>,
        start: Direction,
        towards: Towards,
    ) -> (Direction, f64) {
        match &self.way {
            // A long lattice with few elements costs more lag by lag than pair by pair.
            Way::Lattice { lattice, .. } if lattice.span() <= form.len() => {
                let step = 2.0 / self.grid.full_points as f64;
                let polynomial = LagPolynomial::new(lattice, form);
                let (sine, value) = polynomial.refine(start.azimuth_rad.sin(), step, towards);
                (Direction::azimuth(sine.asin()), value)
            }
            _ => refine(&self.array, form, start, towards, &self.grid),
        }
    }
}

/// Which stationary point to look for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Towards {
    /// A minimum.
    Minimum,
    /// A maximum.
    Maximum,
}

impl Way {
    fn lattice(lattice: Lattice, grid: &Grid) -> Self {
        let transform = LatticeFourier::new(grid.full_points, lattice.spacing, lattice.span());
        Self::Lattice {
            lattice,
            transform: Box::new(transform),
            circle: vec![0.0; grid.full_points],
        }
    }
}

/// Steps along y of elements in a plane of constant x, where they are few enough for lags to pay.
pub(crate) fn steps_in_plane(array: &Array) -> Option<Lattice> {
    let positions = array.positions();
    let x = positions[0][0];
    if positions.iter().any(|p| (p[0] - x).abs() > 1e-9) {
        return None;
    }
    let flat: Vec<[f64; 3]> = positions.iter().map(|p| [0.0, p[1], 0.0]).collect();
    Lattice::of(&flat).filter(|lattice| lattice.span() - 1 <= 4 * positions.len() * positions.len())
}

impl Plane {
    fn of(array: &Array) -> Option<Self> {
        let positions = array.positions();
        let lattice = steps_in_plane(array)?;
        let longest = lattice.span() - 1;
        let mut pairs: Vec<(usize, f64, bool)> =
            Vec::with_capacity(positions.len() * (positions.len() - 1) / 2);
        for k in 0..positions.len() {
            for l in 0..k {
                let (nk, nl) = (lattice.indices[k], lattice.indices[l]);
                let height = positions[k][2] - positions[l][2];
                let conjugate = nk < nl;
                pairs.push(if conjugate {
                    (nl - nk, -height, true)
                } else {
                    (nk - nl, height, false)
                });
            }
        }
        let by_height = ascending(pairs.iter().map(|pair| pair.1));
        let by_lag = ascending(by_height.iter().map(|&pair| pairs[pair].0 as f64));
        let mut slots = vec![(0, false); pairs.len()];
        let mut baselines: Vec<(usize, f64)> = Vec::new();
        for pair in by_lag.into_iter().map(|place| by_height[place]) {
            let (lag, height, conjugate) = pairs[pair];
            if baselines.last().is_none_or(|last| last.0 != lag || height - last.1 > 1e-9) {
                baselines.push((lag, height));
            }
            slots[pair] = (baselines.len() - 1, conjugate);
        }
        Some(Self { slots, baselines, spacing: lattice.spacing, longest })
    }

    fn evaluate(&self, form: ArrayView2<Complex64>, grid: &Grid) -> Vec<f64> {
        let mut sums = vec![Complex64::ZERO; self.baselines.len()];
        let mut slots = self.slots.iter();
        let mut trace = 0.0;
        for k in 0..form.nrows() {
            trace += form[[k, k]].re;
            for (l, &(slot, conjugate)) in (0..k).zip(&mut slots) {
                let value = form[[k, l]];
                sums[slot] += if conjugate { value.conj() } else { value };
            }
        }
        let azimuths = grid.sines.len();
        let mut values = vec![0.0; grid.len()];
        let (mut re, mut im) = (vec![0.0; azimuths], vec![0.0; azimuths]);
        for (e, &elevation) in grid.elevation_rad.iter().enumerate() {
            let (sin_e, cos_e) = elevation.sin_cos();
            let mut lags = vec![Complex64::ZERO; self.longest + 1];
            for (&(lag, height), sum) in self.baselines.iter().zip(&sums) {
                lags[lag] += sum * cis(-PI * height * sin_e) * 2.0;
            }
            lags[0] += trace;
            let turns: Vec<Complex64> =
                grid.sines.iter().map(|u| cis(-PI * self.spacing * cos_e * u)).collect();
            re.fill(0.0);
            im.fill(0.0);
            for lag in lags.iter().rev() {
                for ((x, y), w) in re.iter_mut().zip(&mut im).zip(&turns) {
                    let real = *x * w.re - *y * w.im + lag.re;
                    *y = *x * w.im + *y * w.re + lag.im;
                    *x = real;
                }
            }
            values[e * azimuths..(e + 1) * azimuths].copy_from_slice(&re);
        }
        values
    }
}

/// `a^H Q a` for Hermitian `Q`, of which the lower triangle is read.
pub(crate) fn hermitian_form(form: ArrayView2<Complex64>, a: &Array1<Complex64>) -> f64 {
    let mut sum = 0.0;
    for (k, row) in form.rows().into_iter().enumerate() {
        let below: Complex64 = row.iter().zip(a).take(k).map(|(q, z)| q * z).sum();
        sum += row[k].re * a[k].norm_sqr() + 2.0 * (a[k].conj() * below).re;
    }
    sum
}

/// `Q x` for Hermitian `Q`, of which the lower triangle is read.
fn hermitian_product(form: ArrayView2<Complex64>, x: &Array1<Complex64>) -> Array1<Complex64> {
    let mut product = Array1::zeros(x.len());
    for (k, row) in form.rows().into_iter().enumerate() {
        let mut sum = row[k].re * x[k];
        for (l, q) in row.iter().enumerate().take(k) {
            sum += q * x[l];
            product[l] += q.conj() * x[k];
        }
        product[k] += sum;
    }
    product
}

fn refine(
    array: &Array,
    form: ArrayView2<Complex64>,
    start: Direction,
    towards: Towards,
    grid: &Grid,
) -> (Direction, f64) {
    let with_elevation = array.extent() == Extent::Area;
    let sign = if towards == Towards::Minimum { 1.0 } else { -1.0 };
    let cost = |at: Direction| sign * hermitian_form(form, &steering_vector(array, at));
    // One grid step, in azimuth as wide as the cosine makes it.
    let step = 2.0 / grid.full_points as f64;
    let widest = (step / start.azimuth_rad.cos().max(step.sqrt())).max(step);
    let tallest = grid.elevation_rad.get(1).map_or(0.0, |e| e - grid.elevation_rad[0]);
    let mut at = start;
    let mut value = cost(at);
    for _ in 0..8 {
        let (gradient, hessian) = derivatives(array, form, at, sign);
        let mut change = newton_step(gradient, hessian, with_elevation);
        change[0] = change[0].clamp(-0.5 * widest, 0.5 * widest);
        change[1] = change[1].clamp(-0.5 * tallest, 0.5 * tallest);
        let mut accepted = false;
        for _ in 0..6 {
            let next = Direction::new(
                (at.azimuth_rad + change[0]).clamp(-0.5 * PI, 0.5 * PI),
                at.elevation_rad + change[1],
            );
            let there = cost(next);
            let strayed = (next.azimuth_rad - start.azimuth_rad).abs() > widest
                || (next.elevation_rad - start.elevation_rad).abs() > tallest.max(1e-12);
            if there <= value && !strayed {
                at = next;
                value = there;
                accepted = true;
                break;
            }
            change = [0.25 * change[0], 0.25 * change[1]];
        }
        if !accepted || change[0].abs().max(change[1].abs()) < 1e-12 {
            break;
        }
    }
    (at, sign * value)
}

/// Newton's step where the Hessian is positive definite, else a step down the gradient.
fn newton_step(g: [f64; 2], h: [f64; 3], with_elevation: bool) -> [f64; 2] {
    let descent = |g: f64, h: f64| {
        if h > 0.0 {
            -g / h
        } else if g == 0.0 {
            0.0
        } else {
            -g.signum()
        }
    };
    if !with_elevation {
        return [descent(g[0], h[0]), 0.0];
    }
    let determinant = h[0] * h[2] - h[1] * h[1];
    if h[0] > 0.0 && determinant > 1e-12 * h[0] * h[2] {
        return [
            (-g[0] * h[2] + g[1] * h[1]) / determinant,
            (-g[1] * h[0] + g[0] * h[1]) / determinant,
        ];
    }
    [descent(g[0], h[0]), descent(g[1], h[2])]
}

/// Gradient by azimuth and elevation, and Hessian (aa, ae, ee), of `sign * a^H Q a`.
fn derivatives(
    array: &Array,
    form: ArrayView2<Complex64>,
    at: Direction,
    sign: f64,
) -> ([f64; 2], [f64; 3]) {
    let a = steering_vector(array, at);
    let (by_azimuth, by_elevation) = steering_derivatives(array, at);
    let (sin_a, cos_a) = at.azimuth_rad.sin_cos();
    let (sin_e, cos_e) = at.elevation_rad.sin_cos();
    let second = |direction: [f64; 3], p: &Array1<Complex64>, q: &Array1<Complex64>| {
        // a'' = (j pi p.u'' + (j pi p.u')(j pi p.v')) a, and a' q' / a is the second term.
        let mut d = Array1::zeros(a.len());
        for (k, position) in array.positions().iter().enumerate() {
            let along: f64 = position.iter().zip(&direction).map(|(x, y)| x * y).sum();
            d[k] = a[k] * Complex64::new(0.0, PI * along) + p[k] * q[k] * a[k].conj();
        }
        d
    };
    let aa = second([-cos_e * cos_a, -cos_e * sin_a, 0.0], &by_azimuth, &by_azimuth);
    let ae = second([sin_e * sin_a, -sin_e * cos_a, 0.0], &by_azimuth, &by_elevation);
    let ee = second([-cos_e * cos_a, -cos_e * sin_a, -sin_e], &by_elevation, &by_elevation);
    let qa = hermitian_product(form, &a);
    let q_azimuth = hermitian_product(form, &by_azimuth);
    let q_elevation = hermitian_product(form, &by_elevation);
    let real = |x: &Array1<Complex64>, y: &Array1<Complex64>| {
        2.0 * sign * x.iter().zip(y).map(|(p, q)| (p.conj() * q).re).sum::<f64>()
    };
    (
        [real(&by_azimuth, &qa), real(&by_elevation, &qa)],
        [
            real(&aa, &qa) + real(&by_azimuth, &q_azimuth),
            real(&ae, &qa) + real(&by_elevation, &q_azimuth),
            real(&ee, &qa) + real(&by_elevation, &q_elevation),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::EstimatorOptions;
    use boresight_core::Random;
    use boresight_core::presets::preset;
    use boresight_math::linalg::adjoint;
    use ndarray::Array2;

    fn random_form(n: usize, random: &mut Random) -> Array2<Complex64> {
        let x = Array2::from_shape_fn((n, 3), |_| random.complex_normal(1.0));
        x.dot(&adjoint(x.view()))
    }

    #[test]
    fn the_fast_ways_equal_the_dense_one() {
        let mut random = Random::new(11, 0);
        let ula = |n: usize, d: f64| {
            let at: Vec<[f64; 3]> = (0..n).map(|k| [0.0, 1.0 + d * k as f64, 0.3]).collect();
            Array::new(&at).unwrap()
        };
        let arrays = [
            ula(8, 1.0),
            ula(5, 2.0),
            ula(6, 0.7),
            ula(40, 5.0),
            preset("lrr48").unwrap(),
            preset("awr1642").unwrap(),
            preset("awr1843").unwrap(),
        ];
        let options = EstimatorOptions {
            grid_points: 180,
            elevation_points: 5,
            field_of_view_rad: 1.2,
            ..EstimatorOptions::default()
        };
        for array in arrays {
            let grid = Grid::new(&array, &options);
            let form = random_form(array.len(), &mut random);
            let fast = QuadraticSpectrum::new(&array, &grid).evaluate(form.view());
            let dense = QuadraticSpectrum::dense(&array, &grid).evaluate(form.view());
            let scale = dense.iter().copied().fold(0.0, f64::max);
            for (f, d) in fast.iter().zip(&dense) {
                assert!((f - d).abs() < 1e-12 * scale, "{} elements: {f} {d}", array.len());
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let mut random = Random::new(12, 0);
        let positions: Vec<[f64; 3]> = (0..6)
            .map(|_| [random.uniform(0.0, 1.0), random.uniform(0.0, 4.0), random.normal()])
            .collect();
        let array = Array::new(&positions).unwrap();
        let form = random_form(6, &mut random);
        let (a, e) = (0.4, -0.2);
        let value =
            |a, e| hermitian_form(form.view(), &steering_vector(&array, Direction::new(a, e)));
        let (gradient, hessian) = derivatives(&array, form.view(), Direction::new(a, e), 1.0);
        let h = 1e-4;
        let numeric = [
            (value(a + h, e) - value(a - h, e)) / (2.0 * h),
            (value(a, e + h) - value(a, e - h)) / (2.0 * h),
            (value(a + h, e) - 2.0 * value(a, e) + value(a - h, e)) / (h * h),
            (value(a + h, e + h) - value(a + h, e - h) - value(a - h, e + h) + value(a - h, e - h))
                / (4.0 * h * h),
            (value(a, e + h) - 2.0 * value(a, e) + value(a, e - h)) / (h * h),
        ];
        let exact = [gradient[0], gradient[1], hessian[0], hessian[1], hessian[2]];
        for (x, n) in exact.iter().zip(numeric) {
            assert!((x - n).abs() < 1e-4 * (1.0 + x.abs()), "{exact:?} {numeric:?}");
        }
    }

    #[test]
    fn refinement_ends_on_the_source() {
        let array = preset("awr1843").unwrap();
        let options = EstimatorOptions::default();
        let grid = Grid::new(&array, &options);
        let truth = Direction::new(0.1234, 0.0567);
        let a = steering_vector(&array, truth).insert_axis(ndarray::Axis(1));
        let r = a.dot(&adjoint(a.view()));
        let spectrum = QuadraticSpectrum::new(&array, &grid);
        let start = Direction::new(0.1234 + 1e-3, 0.0567 - 5e-3);
        let (at, value) = spectrum.refine(r.view(), start, Towards::Maximum);
        assert!((at.azimuth_rad - truth.azimuth_rad).abs() < 1e-8, "{at:?}");
        assert!((at.elevation_rad - truth.elevation_rad).abs() < 1e-8, "{at:?}");
        assert!((value - 144.0).abs() < 1e-9);
    }
}
