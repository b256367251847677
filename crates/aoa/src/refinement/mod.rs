//! Refinement of an estimate: the matched model of all its sources, without those that noise
//! explains.
//!
//! An estimator's peaks are a model of the data, of which some may be sidelobes and all are off by
//! its bias and its grid. Here all of them are fitted at once; the one whose removal costs least
//! is removed if noise would gain it as much as often as the false-alarm probability says (the
//! test of NOMP, see `nomp`), and so on; the rest is refined by Gauss-Newton steps
//! ([`crate::refinement::gauss_newton`]) and tested again. In snapshots, sources that the estimator has missed
//! and that stand out of what is left are added as NOMP does, since they would bias all others.
//! What comes out reaches the Cramer-Rao bound where targets stand apart.

pub mod gauss_newton;

use crate::checks::settle;
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Warning};
use crate::estimators::nomp::Nomp;
use crate::model::cosines::Point;
use crate::model::normalised::Normalised;
use crate::options::EstimatorOptions;
use boresight_core::{Array, Direction};

/// A refinement prepared for one array.
pub struct Refinement {
    nomp: Nomp,
}

impl Refinement {
    /// For an array; of the options those of NOMP hold.
    ///
    /// # Errors
    /// As [`crate::Estimator::new`] for NOMP.
    pub fn new(array: &Array, options: &EstimatorOptions) -> Result<Self, AoaError> {
        options.check()?;
        Ok(Self { nomp: Nomp::new(array, options)? })
    }

    /// Refines `directions`, strongest first, on snapshots or a covariance. Returns the sources that
    /// are kept in the same order. Of more directions than half the elements the first are taken.
    ///
    /// # Errors
    /// As [`Data::check`]; [`boresight_core::InputError::OutOfRange`] for a direction more than a
    /// quarter turn off boresight.
    pub fn refine(
        &mut self,
        directions: &[Direction],
        data: Data<'_>,
    ) -> Result<Vec<Source>, AoaError> {
        let elements = self.nomp.geometry.elements();
        data.check(elements)?;
        for direction in directions {
            direction.check()?;
        }
        let most = directions.iter().take(elements / 2);
        let points: Vec<Point> = most.map(|&d| self.nomp.geometry.point(d)).collect();
        let points = match data {
            Data::Snapshots(y) => match Normalised::new(y) {
                Some(normalised) => self.nomp.complete(&normalised, points),
                None => Vec::new(),
            },
            Data::Covariance { .. } => self.nomp.prune(points, data),
        };
        Ok(self.nomp.sources(points, data))
    }

    /// Puts the refined sources in place of those of an estimate; its spectrum stays as it is. A source keeps the
    /// confidence of the one it was before: of those within half a beam each other's nearest.
    pub(crate) fn apply(
        &mut self,
        estimate: &mut Estimate,
        data: Data<'_>,
    ) -> Result<(), AoaError> {
        let directions: Vec<Direction> = estimate.sources.iter().map(|s| *s.direction).collect();
        let mut refined = self.refine(&directions, data)?;
        self.keep_confidences(&estimate.sources, &mut refined);
        estimate.sources = refined;
        estimate.warnings.retain(|warning| *warning != Warning::NoSources);
        let (resolved, expected) = (estimate.resolved, estimate.expected);
        settle(estimate, None);
        estimate.resolved &= resolved;
        estimate.expected = expected;
        Ok(())
    }

    fn keep_confidences(&self, before: &[Source], after: &mut [Source]) {
        if before.iter().all(|source| source.confidence.is_none()) {
            return;
        }
        let geometry = &self.nomp.geometry;
        let points = |sources: &[Source]| -> Vec<Point> {
            sources.iter().map(|source| geometry.point(*source.direction)).collect()
        };
        let (old, new) = (points(before), points(after));
        let nearest = |to: Point, among: &[Point]| {
            let distances = among.iter().map(|&point| geometry.distance(to, point)).enumerate();
            distances.min_by(|a, b| a.1.total_cmp(&b.1))
        };
        for (at, source) in after.iter_mut().enumerate() {
            let Some((of, distance)) = nearest(new[at], &old) else { continue };
            let mutual = nearest(old[of], &new).is_some_and(|(back, _)| back == at);
            if mutual && distance <= geometry.half_beam() {
                source.confidence = before[of].confidence;
            }
        }
    }
}
