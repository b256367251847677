//! What becomes of the sources that were pursued, or given: all of them refined together, without
//! those that noise explains.

use super::{EXHAUSTED, Nomp};
use crate::data::Data;
use crate::estimate::Source;
use crate::model::cosines::Point;
use crate::model::normalised::Normalised;
use crate::model::powers::sources_at;
use crate::refinement::gauss_newton::{Fit, Limits, refine_points, total_power};
use boresight_core::{Complex64, Direction};

/// Gauss-Newton steps over all sources.
const STEPS: Limits = Limits { iterations: 10, tolerance: 1e-8 };
/// Share of their powers that two sources that cancel leave at most.
const CANCELLED: f64 = 0.01;

impl Nomp {
    /// Those of `start` that are more than noise, and the sources that stand out beside them,
    /// refined together.
    pub fn complete(&mut self, normalised: &Normalised, start: Vec<Point>) -> Vec<Point> {
        let y = &normalised.snapshots;
        let data = Data::Snapshots(y.view());
        let noise_power = self.noise_power_in(normalised);
        let start = self.without_noise(start, data, noise_power, false);
        let (fitted, _) = self.pursue(y, start, noise_power);
        self.polish(fitted.points, data, noise_power)
    }

    /// Those of the points that are more than noise, refined together.
    pub fn prune(&mut self, points: Vec<Point>, data: Data<'_>) -> Vec<Point> {
        self.without_noise(points, data, self.options.noise_power, false)
    }

    /// The sources at `points` in the field of view, with their powers.
    ///
    /// Sources of one snapshot within half a beam that cancel by more than 20 dB are a fit to first
    /// order of one at their centre, `a_1 v_1 + a_2 v_2` over `a_1 + a_2`: that is returned in place
    /// of several of absurd power.
    pub fn sources(&self, points: Vec<Point>, data: Data<'_>) -> Vec<Source> {
        let directions: Vec<Direction> =
            points.iter().map(|&p| self.geometry.direction(p)).collect();
        let mut points = points;
        let mut sources = sources_at(&self.array, &directions, data);
        let mut apart: Vec<(Point, Point)> = Vec::new();
        let half_beam = self.geometry.half_beam();
        while let Some((i, k)) = self.closest(&points, half_beam, &apart) {
            if !self.amount_to_one(&[i, k], &mut points, &mut sources) {
                apart.push((points[i], points[k]));
            }
        }
        // Three and more may cancel of which no two do.
        let mut seed = 0;
        while seed < points.len() {
            let near = |&k: &usize| self.geometry.distance(points[seed], points[k]) < half_beam;
            let group: Vec<usize> = (0..points.len()).filter(near).collect();
            if group.len() < 3 || !self.amount_to_one(&group, &mut points, &mut sources) {
                seed += 1;
            }
        }
        sources.retain(|source| self.sees(*source.direction));
        sources
    }

    /// Puts one source in place of those of an ascending `group` if they cancel: at their centre,
    /// with the sum of their amplitudes.
    fn amount_to_one(
        &self,
        group: &[usize],
        points: &mut Vec<Point>,
        sources: &mut Vec<Source>,
    ) -> bool {
        let amplitudes: Option<Vec<_>> = group.iter().map(|&i| sources[i].amplitude).collect();
        let (Some(amplitudes), Some(&first)) = (amplitudes, group.first()) else { return false };
        let sum: Complex64 = amplitudes.iter().sum();
        let powers: f64 = amplitudes.iter().map(|amplitude| amplitude.norm_sqr()).sum();
        if sum.norm_sqr() > CANCELLED * powers {
            return false;
        }
        let half_beam = self.geometry.half_beam();
        let step = [0, 1].map(|axis| {
            let parts = group.iter().zip(&amplitudes).map(|(&k, amplitude)| {
                (sum.conj() * amplitude).re * (points[k][axis] - points[first][axis])
            });
            let centre = parts.sum::<f64>() / sum.norm_sqr().max(f64::MIN_POSITIVE);
            centre.clamp(-half_beam, half_beam)
        });
        points[first] = self.geometry.moved(points[first], step);
        sources[first] = Source {
            amplitude: Some(sum),
            ..Source::new(self.geometry.direction(points[first]), sum.norm_sqr())
        };
        for &k in group[1..].iter().rev() {
            points.remove(k);
            sources.remove(k);
        }
        true
    }

    /// Refined, merged and without noise.
    pub fn polish(
        &mut self,
        points: Vec<Point>,
        data: Data<'_>,
        noise_power: Option<f64>,
    ) -> Vec<Point> {
        let points = self.merged(points, data, noise_power);
        self.without_noise(points, data, noise_power, true)
    }

    /// Removes, one by one, the source whose removal costs least, as long as noise would gain as
    /// much; the rest is refined, unless `refined` says that it is, and tested again.
    fn without_noise(
        &mut self,
        mut points: Vec<Point>,
        data: Data<'_>,
        noise_power: Option<f64>,
        mut refined: bool,
    ) -> Vec<Point> {
        let snapshots = data.snapshots();
        let total = total_power(data);
        while !points.is_empty() {
            let Some(fit) = Fit::new(&self.geometry, &points, data, total) else {
                // Two of them cannot be told apart: the weaker one is none.
                let closest = self.closest(&points, f64::INFINITY, &[]);
                points.remove(closest.map_or(points.len() - 1, |(_, later)| later));
                continue;
            };
            let gains = fit.gains().into_iter().enumerate();
            let Some((weakest, gain)) = gains.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let left = fit.residual.max(0.0) + gain;
            let energies = [gain, left].map(|power| power * snapshots as f64);
            let is_source = gain > EXHAUSTED * total
                && self.is_source(
                    energies[0],
                    energies[1],
                    total * snapshots as f64,
                    points.len() - 1,
                    snapshots,
                    noise_power,
                );
            if !is_source {
                points.remove(weakest);
                refined = false;
            } else if refined {
                break;
            } else {
                points = refine_points(&self.geometry, points, data, STEPS).0;
                refined = true;
            }
        }
        points
    }

    /// Refined, with one source in place of two that stand within half a beam of each other where
    /// that costs no more than noise gains: such a pair is often one source and what an earlier,
    /// inexact fit of it had left, grown to two large amplitudes that cancel.
    fn merged(
        &mut self,
        points: Vec<Point>,
        data: Data<'_>,
        noise_power: Option<f64>,
    ) -> Vec<Point> {
        let snapshots = data.snapshots();
        let total = total_power(data) * snapshots as f64;
        let (mut points, mut outcome) = refine_points(&self.geometry, points, data, STEPS);
        let mut kept: Vec<(Point, Point)> = Vec::new();
        while let Some((i, k)) = self.closest(&points, self.geometry.half_beam(), &kept) {
            let mut fewer = points.clone();
            let second = fewer.remove(k);
            fewer[i] = [0, 1].map(|axis| 0.5 * (fewer[i][axis] + second[axis]));
            let (fewer, merged) = refine_points(&self.geometry, fewer, data, STEPS);
            let gain = merged.residual_power - outcome.residual_power;
            let energies = [gain, merged.residual_power].map(|power| power * snapshots as f64);
            let fewer_count = fewer.len();
            if self.is_source(energies[0], energies[1], total, fewer_count, snapshots, noise_power)
            {
                kept.push((points[i], points[k]));
            } else {
                (points, outcome) = (fewer, merged);
            }
        }
        points
    }

    /// The two closest points less than `within` apart, the earlier first, but none of the pairs in
    /// `but`.
    fn closest(
        &self,
        points: &[Point],
        within: f64,
        but: &[(Point, Point)],
    ) -> Option<(usize, usize)> {
        (0..points.len())
            .flat_map(|k| (0..k).map(move |i| (i, k)))
            .filter(|&(i, k)| !but.contains(&(points[i], points[k])))
            .map(|(i, k)| (self.geometry.distance(points[i], points[k]), (i, k)))
            .filter(|(distance, _)| *distance < within)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, pair)| pair)
    }
}
