//! How strong a peak noise alone makes with a given probability.
//!
//! Over a continuum of directions the normalised beam power of noise is a smooth random field. At a
//! high level the number of peaks above it is nearly its expected Euler characteristic (Worsley
//! 1994 for chi-squared fields; the one-dimensional term is Rice's count of upcrossings), and the
//! probability of at least one is `1 - exp(-number)`. With unknown noise power the peak is measured
//! against the power of the data themselves: then the field lives on a sphere, whose densities
//! follow from those of the Gaussian field by conditioning on the total power.

use crate::model::cosines::Geometry;
use boresight_core::Array;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Intrinsic volumes of the set of directions, in units of the field's slope: the number of points
/// (1), half the circumference (or the length of an interval), and the area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Volumes {
    length: f64,
    area: f64,
}

impl Volumes {
    /// For all azimuths, over one period in the sine if that is shorter, and elevations up to
    /// `elevation_rad` on arrays that span an area.
    pub fn new(array: &Array, geometry: &Geometry, elevation_rad: f64) -> Self {
        let spread = geometry.spread();
        if geometry.axes == 1 {
            let range = array.lattice().map_or(2.0, |lattice| (2.0 / lattice.spacing).min(2.0));
            return Self { length: range * spread[0].max(0.0).sqrt(), area: 0.0 };
        }
        // The set is |v| <= sqrt(1 - w^2), |w| <= sin(elevation).
        let (sin, cos) = elevation_rad.sin_cos();
        let area = 2.0 * (elevation_rad + sin * cos);
        let determinant = (spread[0] * spread[2] - spread[1] * spread[1]).max(0.0);
        let length = 2.0 * (spread[0].sqrt() + sin * spread[2].sqrt()) * FRAC_1_SQRT_2.max(cos);
        Self { length, area: area * determinant.sqrt() }
    }

    /// For a rectangle of these sides, in units of the field's slope along each.
    pub fn of_rectangle(sides: [f64; 2]) -> Self {
        Self { length: sides[0] + sides[1], area: sides[0] * sides[1] }
    }

    /// Expected number of peaks of `sum_n |a^H y_n|^2 / K` above `level` noise powers, over
    /// `snapshots`.
    fn peaks_in_known_noise(&self, level: f64, snapshots: usize) -> f64 {
        let n = snapshots as f64;
        let log = |power: f64, gamma: f64| (power * level.ln() - level - gamma).exp();
        // Probability that a gamma variable of order n exceeds the level: a Poisson sum.
        let mut tail = 0.0;
        let mut term = log(n - 1.0, libm::lgamma(n));
        for k in (0..snapshots).rev() {
            tail += term;
            if term <= 1e-17 * tail && (k as f64) < level {
                break;
            }
            term *= k as f64 / level;
        }
        let edge = log(n - 0.5, libm::lgamma(n)) / PI.sqrt();
        let face = log(n - 1.0, libm::lgamma(n)) * (2.0 * level - (2.0 * n - 1.0)) / (2.0 * PI);
        tail + self.length * edge + self.area * face
    }

    /// The same for a peak that holds the share `b` of the power of data with `freedom` complex
    /// degrees of freedom in all.
    fn peaks_in_unknown_noise(&self, b: f64, snapshots: usize, freedom: f64) -> f64 {
        let n = snapshots as f64;
        let rest = |x: f64, y: f64, gamma: f64| {
            (libm::lgamma(freedom) - libm::lgamma(n) - libm::lgamma(gamma)
                + x * b.ln()
                + y * (-b).ln_1p())
            .exp()
        };
        // Probability that a beta variable exceeds b: as many terms as snapshots.
        let mut tail = 0.0;
        let mut term = rest(n - 1.0, freedom - n, freedom - n + 1.0);
        for k in (0..snapshots).rev() {
            tail += term;
            if term <= 1e-17 * tail && (k as f64) < b * freedom {
                break;
            }
            term *= k as f64 * (1.0 - b) / (b * (freedom - k as f64));
        }
        let edge = rest(n - 0.5, freedom - n - 0.5, freedom - n + 0.5) / PI.sqrt();
        let face = (2.0 * rest(n, freedom - n - 1.0, freedom - n)
            - (2.0 * n - 1.0) * rest(n - 1.0, freedom - n, freedom - n + 1.0))
            / (2.0 * PI);
        tail + self.length * edge + self.area * face
    }

    /// Level, in noise powers, that noise exceeds somewhere with probability `false_alarm`.
    pub fn level(&self, false_alarm: f64, snapshots: usize) -> f64 {
        let wanted = -(-false_alarm).ln_1p();
        // The count falls with the level beyond a few standard deviations above the mean.
        let mut low = snapshots as f64 + 1.0;
        let mut high = 2.0 * low + 50.0;
        while self.peaks_in_known_noise(high, snapshots) > wanted && high < 1e12 {
            high *= 2.0;
        }
        bisect(&mut low, &mut high, |level| self.peaks_in_known_noise(level, snapshots) > wanted);
        0.5 * (low + high)
    }

    /// Share of the power that noise of unknown power exceeds somewhere with probability
    /// `false_alarm`; nothing if there are too few degrees of freedom to tell.
    pub fn share(&self, false_alarm: f64, snapshots: usize, freedom: f64) -> Option<f64> {
        let n = snapshots as f64;
        if freedom <= n + 1.0 {
            return None;
        }
        let wanted = -(-false_alarm).ln_1p();
        let (mut low, mut high) = ((n + 0.5) / (freedom + 0.5), 1.0 - 1e-15);
        let above = |b: f64| self.peaks_in_unknown_noise(b, snapshots, freedom) > wanted;
        if above(high) {
            return None;
        }
        bisect(&mut low, &mut high, above);
        Some(0.5 * (low + high))
    }
}

/// Shares of the residual power that the peak of noise of unknown power has with a probability, by
/// the number of sources taken off before; computed once for a number of snapshots.
pub(crate) struct Shares {
    volumes: Volumes,
    false_alarm: f64,
    elements: usize,
    /// Real unknowns of a direction.
    axes: usize,
    snapshots: usize,
    shares: Vec<Option<f64>>,
}

impl Shares {
    pub fn new(volumes: Volumes, geometry: &Geometry, false_alarm: f64) -> Self {
        Self::of(volumes, geometry.elements(), geometry.axes, false_alarm)
    }

    /// For vectors of so many values and sources of so many real unknowns.
    pub fn of(volumes: Volumes, elements: usize, axes: usize, false_alarm: f64) -> Self {
        Self { volumes, false_alarm, elements, axes, snapshots: 0, shares: Vec::new() }
    }

    /// Takes vectors of so many values from now on.
    pub fn set_elements(&mut self, elements: usize) {
        if self.elements != elements {
            self.elements = elements;
            self.shares.clear();
        }
    }

    /// Snapshots as they are counted: beyond a million the shares hardly change any more.
    pub fn counted(snapshots: usize) -> usize {
        snapshots.min(1_000_000)
    }

    /// After `found` sources in `snapshots`; nothing where too few degrees of freedom are left,
    /// `snapshots (elements - found) - found / 2` for sources of one angle.
    pub fn after(&mut self, found: usize, snapshots: usize) -> Option<f64> {
        let snapshots = Self::counted(snapshots);
        if self.snapshots != snapshots {
            self.snapshots = snapshots;
            self.shares.clear();
        }
        while self.shares.len() <= found {
            let taken = self.shares.len();
            let angles = 0.5 * (self.axes * taken) as f64;
            let freedom = (snapshots * self.elements.saturating_sub(taken)) as f64 - angles;
            self.shares.push(self.volumes.share(self.false_alarm, snapshots, freedom));
        }
        self.shares[found]
    }
}

fn bisect(low: &mut f64, high: &mut f64, above: impl Fn(f64) -> bool) {
    for _ in 0..100 {
        let middle = 0.5 * (*low + *high);
        if above(middle) {
            *low = middle;
        } else {
            *high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT: Volumes = Volumes { length: 0.0, area: 0.0 };

    #[test]
    fn a_single_direction_has_the_tail_of_its_distribution() {
        // One snapshot: exponential. P = exp(-t), with 1 - exp(-P') = P.
        let level = POINT.level(0.01, 1);
        assert!((1.0 - (-(-level).exp()).exp() - 0.01).abs() < 1e-12, "{level}");
        let share = POINT.share(0.01, 1, 10.0).unwrap();
        assert!((1.0 - (-(1.0 - share).powi(9)).exp() - 0.01).abs() < 1e-12, "{share}");
        // Two: gamma of order 2, P = (1 + t) exp(-t).
        let level = POINT.level(0.01, 2);
        assert!((1.0 - (-(1.0 + level) * (-level).exp()).exp() - 0.01).abs() < 1e-6, "{level}");
    }

    #[test]
    fn with_many_degrees_of_freedom_unknown_noise_is_known() {
        let line = Volumes { length: 40.0, area: 0.0 };
        let plane = Volumes { length: 40.0, area: 300.0 };
        for volumes in [line, plane] {
            for snapshots in [1, 5] {
                let level = volumes.level(0.05, snapshots);
                let freedom = 1e7;
                let share = volumes.share(0.05, snapshots, freedom).unwrap() * freedom;
                assert!((share / level - 1.0).abs() < 1e-4, "{share} {level}");
            }
        }
        assert!(line.share(0.05, 3, 3.5).is_none());
    }
}
