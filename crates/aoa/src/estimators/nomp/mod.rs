//! Newtonized orthogonal matching pursuit (Mamandipoor, Ramasamy and Madhow 2016), of one or
//! several snapshots with common directions.
//!
//! Sources are taken from the residual one by one: the strongest beam of a coarse grid, Newton
//! steps on it, Newton steps on all sources in turn, amplitudes by least squares. It ends when the
//! strongest beam is what noise alone would make with the false-alarm probability. The paper tests
//! the beams of an unoversampled DFT; here the exact peak is tested against the distribution of the
//! maximum over all directions, so that the rate holds for any array (see `false_alarm`).
//!
//! With `noise_power` absent, each test is against the residual itself, whose power under the
//! hypothesis that nothing is left is all noise: the peak's share of the residual power is compared
//! with what a share of noise of unknown power can be with the residual's degrees of freedom,
//! `N (K - D) - D/2` for `N` snapshots, `K` elements and `D` sources so far (`D` in place of `D/2`
//! with elevation). Sources not yet found are in that residual, too, and may hide each other: ten of
//! equal power hold a tenth of it each. So a beam that fails the test is still taken off while a plain
//! pursuit ahead ([`look_ahead`]) finds a beam that passes, or while one of the next [`AHEAD`] could. It
//! becomes a source once a later beam passes, or once the joint fit with it explains more of the residual
//! than noise: beams that interfere are weaker than what their sources explain together.
//!
//! An array that is off its plan leaves a part of every source in the residual, which would be taken for further sources.
//! With [`EstimatorOptions::mismatch_db`] a beam has to exceed noise by what such an error seldom gains.

mod look_ahead;
mod newton;
mod polish;

use crate::checks::{ambiguity, check_array, conclude};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Warning};
use crate::grid::Grid;
use crate::method::Method;
use crate::model::cosines::{Geometry, Point};
use crate::model::normalised::Normalised;
use crate::options::{EstimatorOptions, NompOptions};
use crate::order::false_alarm::{Shares, Volumes};
use crate::plan::Plan;
use crate::spectra::quadratic::QuadraticSpectrum;
use boresight_core::{Array, Complex64, Direction};
use boresight_math::linalg::least_squares;
use ndarray::Array2;
use newton::{beam_power, step};
use std::f64::consts::FRAC_PI_2;

/// Most azimuths and most elevations of the coarse grid.
const MAX_POINTS: usize = 1 << 14;
const MAX_ELEVATIONS: usize = 1 << 7;

/// Sources beyond the last certain one that are fitted without one that a plain pursuit ahead finds.
const AHEAD: usize = 4;
/// Share of the false-alarm probability that the tests of joint fits with these have together.
const AHEAD_SHARE: f64 = 0.1;
/// Share of the power below which the residual is nothing but rounding.
const EXHAUSTED: f64 = 1e-24;

/// NOMP prepared for one array.
pub(crate) struct Nomp {
    array: Array,
    pub geometry: Geometry,
    options: NompOptions,
    spectrum: QuadraticSpectrum,
    volumes: Volumes,
    /// Number of snapshots and the threshold in noise powers that holds for it.
    level: Option<(usize, f64)>,
    shares: Shares,
    /// The same for joint fits with sources that did not pass.
    shares_ahead: Shares,
    /// What an error of the array adds to the strongest beam with the false-alarm probability, over the power that the
    /// sources explain.
    mismatch: f64,
    field_of_view: [f64; 2],
    ambiguity: Option<Warning>,
}

/// What the strongest beam of a residual is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// More than noise makes.
    Source,
    /// No more than noise makes if all of the residual is noise, which other sources may belie.
    Hidden,
    /// Noise.
    Noise,
}

/// Sources so far.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    pub points: Vec<Point>,
    /// Sources x snapshots.
    pub amplitudes: Array2<Complex64>,
    pub residual: Array2<Complex64>,
}

impl Nomp {
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        Self::of(Method::Nomp, array, options)
    }

    /// For a method that is made of its parts.
    pub fn of(method: Method, array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        check_array(method, array, options)?;
        let geometry = Geometry::new(array);
        let extent = |axis: usize| {
            let along = |p: &[f64; 3]| p[axis];
            let low = array.positions().iter().map(along).fold(f64::INFINITY, f64::min);
            let high = array.positions().iter().map(along).fold(f64::NEG_INFINITY, f64::max);
            (high - low + 1.0).ceil() as usize
        };
        let points = |axis: usize, least: usize, most: usize| {
            let wanted = options.nomp.oversampling.saturating_mul(extent(axis));
            wanted.clamp(least, most).next_power_of_two().min(most)
        };
        let coarse = EstimatorOptions {
            field_of_view_rad: FRAC_PI_2,
            grid_points: points(1, 16, MAX_POINTS),
            elevation_points: points(2, 4, MAX_ELEVATIONS) + 1,
            ..*options
        };
        let grid = Grid::new(array, &coarse);
        let volumes = Volumes::new(array, &geometry, options.elevation_field_of_view_rad);
        Ok(Self {
            array: array.clone(),
            shares: Shares::new(volumes, &geometry, options.nomp.false_alarm),
            shares_ahead: Shares::new(
                volumes,
                &geometry,
                AHEAD_SHARE * options.nomp.false_alarm / AHEAD as f64,
            ),
            mismatch: match options.mismatch_db {
                Some(_) => {
                    let level = volumes.level(options.nomp.false_alarm, 1);
                    options.mismatch() * level / geometry.elements() as f64
                }
                None => 0.0,
            },
            volumes,
            level: None,
            geometry,
            options: options.nomp,
            spectrum: QuadraticSpectrum::new(array, &grid),
            field_of_view: [options.field_of_view_rad, options.elevation_field_of_view_rad],
            ambiguity: ambiguity(array, options),
        })
    }

    /// Whether a direction is in the field of view.
    pub fn sees(&self, direction: Direction) -> bool {
        let [azimuth, elevation] = self.field_of_view;
        direction.azimuth_rad.abs() <= azimuth + 1e-9
            && direction.elevation_rad.abs() <= elevation + 1e-9
    }

    /// What is to be said of the array.
    pub fn warnings(&self) -> Vec<Warning> {
        self.ambiguity.iter().cloned().collect()
    }

    /// The estimate of the sources at `points`, polished, in the unit of the data as given.
    pub fn conclude(
        &mut self,
        method: Method,
        points: Vec<Point>,
        normalised: &Normalised,
        iterations: usize,
        warnings: Vec<Warning>,
    ) -> Estimate {
        let scaled = Data::Snapshots(normalised.snapshots.view());
        let points = self.polish(points, scaled, self.noise_power_in(normalised));
        let mut sources = self.sources(points, scaled);
        sources.iter_mut().for_each(|source| *source = normalised.source_out(*source));
        let mut estimate = conclude(method, sources, None, None, iterations, warnings);
        estimate.sources.truncate(self.options.max_sources);
        estimate
    }

    /// The noise power that is given, in the unit of normalised snapshots.
    pub fn noise_power_in(&self, normalised: &Normalised) -> Option<f64> {
        self.options.noise_power.map(|power| normalised.power_in(power))
    }

    /// The strongest beam in `residual`, refined, and its power. Beams of the coarse grid that have `rivals` of the
    /// strongest one's power there are refined as well: 1 for none.
    pub fn strongest(&mut self, residual: &Array2<Complex64>, rivals: f64) -> (Point, f64) {
        let values = self.spectrum.evaluate_snapshots(residual.view());
        let best = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0);
        let mut strongest = (Point::default(), -1.0);
        for i in 0..values.len() {
            if i != best && values[i] <= rivals * values[best] {
                continue;
            }
            let mut point = self.geometry.point(self.spectrum.grid().direction(i));
            for _ in 0..self.options.single_refinements {
                point = step(&self.geometry, residual, point);
                // The false-alarm rate counts the directions within these elevations.
                let highest = self.field_of_view[1].sin();
                point[1] = point[1].clamp(-highest, highest);
            }
            let power = beam_power(&self.geometry, residual, point);
            if power > strongest.1 {
                strongest = (point, power);
            }
        }
        strongest
    }

    /// Whether a beam of this power is more than noise makes, after `found` sources in data of energy `total`.
    fn stands_out(
        &mut self,
        power: f64,
        residual: &Array2<Complex64>,
        total: f64,
        found: usize,
        noise_power: Option<f64>,
    ) -> Verdict {
        let (elements, snapshots) = residual.dim();
        let gain = power / elements as f64;
        let left = energy(residual);
        if self.is_source(gain, left, total, found, snapshots, noise_power) {
            return Verdict::Source;
        }
        if noise_power.is_some() || self.is_mismatch(gain, left, total) {
            return Verdict::Noise;
        }
        let most = self.options.max_sources.saturating_sub(found);
        match self.may_hide(gain / left, found, snapshots, most) {
            true => Verdict::Hidden,
            false => Verdict::Noise,
        }
    }

    /// Whether a beam that holds `share` of the residual after `found` sources, or one of the next beams, up to `most` in
    /// all, could be a source: beams hardly grow as sources are taken off.
    fn may_hide(&mut self, share: f64, found: usize, snapshots: usize, most: usize) -> bool {
        for more in 0..most {
            let left = 1.0 - more as f64 * share;
            let Some(least) = self.shares.after(found + more, snapshots) else { return false };
            if left <= 0.0 || share > least * left {
                return true;
            }
        }
        false
    }

    /// Whether noise and the array's error seldom gain that much of an energy `left` of `total`, summed over elements and
    /// snapshots, after `found` sources.
    fn is_source(
        &mut self,
        gain: f64,
        left: f64,
        total: f64,
        found: usize,
        snapshots: usize,
        noise_power: Option<f64>,
    ) -> bool {
        let Some(noise) = noise_power else {
            let least = self.shares.after(found, snapshots);
            return least.is_some_and(|least| gain > least * left)
                && !self.is_mismatch(gain, left, total);
        };
        gain > noise * self.level(snapshots) + self.by_mismatch(left, total)
    }

    /// Whether the array's error may gain that much beside noise of unknown power, which gains an element's share of what
    /// the beam leaves.
    fn is_mismatch(&self, gain: f64, left: f64, total: f64) -> bool {
        let noise = (left - gain).max(0.0) / self.geometry.elements() as f64;
        self.mismatch > 0.0 && gain <= self.by_mismatch(left, total) + noise
    }

    /// What the error of the array seldom exceeds in a beam, where `left` of the energy `total` is not explained. The error of
    /// a source is one vector that all snapshots share, scaled by its amplitude in each: what noise in one snapshot
    /// would be whose power is the share of the mismatch in what the sources explain.
    fn by_mismatch(&self, left: f64, total: f64) -> f64 {
        self.mismatch * (total - left).max(0.0)
    }

    /// What noise gains in the strongest beam with the false-alarm probability, in noise powers.
    pub fn level(&mut self, snapshots: usize) -> f64 {
        let level = match self.level {
            Some((count, level)) if count == snapshots => level,
            _ => self.volumes.level(self.options.false_alarm, snapshots),
        };
        self.level = Some((snapshots, level));
        level
    }

    /// A Newton step on every source in turn, with all others taken off, and its amplitudes: those of its beam, which
    /// loses `threshold` of its norm over the snapshots.
    pub fn cycle(&self, fitted: &mut Fitted, threshold: f64) {
        for i in 0..fitted.points.len() {
            let before = self.geometry.steering(fitted.points[i]).vector;
            let own = add_source(&fitted.residual, &before, fitted.amplitudes.row(i), 1.0);
            fitted.points[i] = step(&self.geometry, &own, fitted.points[i]);
            let after = self.geometry.steering(fitted.points[i]).vector;
            let mut power = 0.0;
            for (n, column) in own.columns().into_iter().enumerate() {
                let x: Complex64 = after.iter().zip(column).map(|(a, y)| a.conj() * y).sum();
                fitted.amplitudes[[i, n]] = x;
                power += x.norm_sqr();
            }
            let left = (1.0 - threshold / power.sqrt().max(f64::MIN_POSITIVE)).max(0.0);
            let share = left / self.geometry.elements() as f64;
            fitted.amplitudes.row_mut(i).iter_mut().for_each(|s| *s *= share);
            fitted.residual = add_source(&own, &after, fitted.amplitudes.row(i), -1.0);
        }
    }

    /// Least-squares amplitudes of `points`, and what they leave; nothing if two sources coincide.
    fn fit(&self, y: &Array2<Complex64>, points: Vec<Point>) -> Option<Fitted> {
        let vectors: Vec<Vec<Complex64>> =
            points.iter().map(|&p| self.geometry.steering(p).vector).collect();
        let a = Array2::from_shape_fn((y.nrows(), points.len()), |(k, i)| vectors[i][k]);
        let amplitudes = least_squares(a.view(), y.view()).ok().flatten()?;
        let residual = y - &a.dot(&amplitudes);
        Some(Fitted { points, amplitudes, residual })
    }

    /// Pursues sources beyond `start`; also whether it ended for another reason than its limit on
    /// sources.
    pub fn pursue(
        &mut self,
        y: &Array2<Complex64>,
        start: Vec<Point>,
        noise_power: Option<f64>,
    ) -> (Fitted, bool) {
        let total = energy(y);
        let nothing = || {
            let none = Array2::zeros((0, y.ncols()));
            Fitted { points: Vec::new(), amplitudes: none, residual: y.clone() }
        };
        let fitted = if start.is_empty() { None } else { self.fit(y, start) };
        let mut fitted = fitted.unwrap_or_else(nothing);
        // What was found when a beam last stood out, and how many sources are expected at least.
        let mut sure = fitted.clone();
        let mut expected = 0;
        loop {
            let found = fitted.points.len();
            if energy(&fitted.residual) <= EXHAUSTED * total || found + 1 >= y.nrows() {
                return (sure, true);
            }
            let (point, power) = self.strongest(&fitted.residual, 1.0);
            let mut verdict = self.stands_out(power, &fitted.residual, total, found, noise_power);
            let left = energy(&fitted.residual);
            if verdict == Verdict::Hidden && found >= expected {
                expected = self.look_ahead(&fitted, total);
                let share = power / y.nrows() as f64 / left;
                let most = (sure.points.len() + AHEAD).saturating_sub(found);
                if expected == 0 && self.may_hide(share, found, y.ncols(), most) {
                    expected = found + 1;
                }
            }
            if verdict == Verdict::Noise || (verdict == Verdict::Hidden && found >= expected) {
                return (sure, true);
            }
            if found >= self.options.max_sources {
                return (sure, verdict == Verdict::Hidden);
            }
            let apart = 1e-3 * self.geometry.half_beam();
            if fitted.points.iter().any(|&p| self.geometry.distance(p, point) < apart) {
                return (sure, true);
            }
            let mut points = fitted.points.clone();
            points.push(point);
            let Some(mut next) = self.fit(y, points) else {
                return (sure, true);
            };
            for _ in 0..self.options.cyclic_refinements {
                self.cycle(&mut next, 0.0);
            }
            // Two sources that have run into each other are one.
            match self.fit(y, next.points) {
                Some(next) if energy(&next.residual) < left => fitted = next,
                _ => return (sure, true),
            }
            if verdict == Verdict::Hidden {
                let gain = left - energy(&fitted.residual);
                let least = self.shares_ahead.after(found, y.ncols());
                if least.is_some_and(|least| gain > least * left)
                    && !self.is_mismatch(gain, left, total)
                {
                    verdict = Verdict::Source;
                }
            }
            if verdict == Verdict::Source {
                sure = fitted.clone();
            }
        }
    }
}

pub(crate) fn energy(y: &Array2<Complex64>) -> f64 {
    y.iter().map(|z| z.norm_sqr()).sum()
}

/// `y + sign a s^T`.
fn add_source(
    y: &Array2<Complex64>,
    a: &[Complex64],
    s: ndarray::ArrayView1<Complex64>,
    sign: f64,
) -> Array2<Complex64> {
    let mut sum = y.clone();
    for (mut row, a) in sum.rows_mut().into_iter().zip(a) {
        for (z, s) in row.iter_mut().zip(s) {
            *z += a * s * sign;
        }
    }
    sum
}

impl Plan for Nomp {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let method = Method::Nomp;
        let Data::Snapshots(y) = data else {
            return Err(AoaError::NeedsSnapshots { method: method.name() });
        };
        let mut warnings = self.warnings();
        let Some(normalised) = Normalised::new(y) else {
            return Ok(conclude(method, vec![], None, None, 0, warnings));
        };
        let y = &normalised.snapshots;
        let noise_power = self.noise_power_in(&normalised);
        let (fitted, ended) = self.pursue(y, Vec::new(), noise_power);
        let found = fitted.points.len();
        if !ended {
            warnings.push(Warning::NotConverged { iterations: found });
        }
        Ok(self.conclude(method, fitted.points, &normalised, found, warnings))
    }
}

#[cfg(test)]
mod tests;
