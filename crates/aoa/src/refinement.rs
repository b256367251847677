//! Refinement of an estimate: the matched model of all its sources, without those that noise
//! explains.
//!
//! An estimator's peaks are a model of the data, of which some may be sidelobes and all are off by
//! its bias and its grid. Here all of them are fitted at once; the one whose removal costs least
//! is removed if noise would gain it as much as often as the false-alarm probability says (the
//! test of NOMP, see `nomp`), and so on; the rest is refined by Gauss-Newton steps
//! ([`crate::gauss_newton`]) and tested again. In snapshots, sources that the estimator has missed
//! and that stand out of what is left are added as NOMP does, since they would bias all others.
//! What comes out reaches the Cramer-Rao bound where targets stand apart.

use crate::cosines::{Geometry, Point};
use crate::data::Data;
use crate::error::AoaError;
use crate::estimate::Source;
use crate::false_alarm::{Shares, Volumes};
use crate::gauss_newton::{Fit, Limits, refine_points, total_power};
use crate::nomp::Nomp;
use crate::normalised::Normalised;
use crate::options::Options;
use crate::powers::sources_at;
use boresight_core::{Array, Direction};

/// Gauss-Newton steps once nothing is left to remove.
const STEPS: Limits = Limits { iterations: 10, tolerance: 1e-9 };

/// A refinement prepared for one array.
pub struct Refinement {
    array: Array,
    geometry: Geometry,
    shares: Shares,
    nomp: Nomp,
}

impl Refinement {
    /// For an array; of the options those of NOMP hold.
    ///
    /// # Errors
    /// As [`crate::Estimator::new`] for NOMP.
    pub fn new(array: &Array, options: &Options) -> Result<Self, AoaError> {
        options.check()?;
        let nomp = Nomp::new(array, options)?;
        let geometry = Geometry::new(array);
        let volumes = Volumes::new(array, &geometry, options.elevation_field_of_view_rad);
        let shares = Shares::new(volumes, &geometry, options.nomp.false_alarm);
        Ok(Self { array: array.clone(), shares, geometry, nomp })
    }

    /// Refines `directions`, strongest first, on snapshots or a covariance. Returns the sources that
    /// are kept in the same order. Of more directions than half the elements the first are taken.
    ///
    /// # Errors
    /// As [`Data::check`]; [`boresight_core::CoreError::OutOfRange`] for a direction more than a
    /// quarter turn off boresight.
    pub fn refine(
        &mut self,
        directions: &[Direction],
        data: Data<'_>,
    ) -> Result<Vec<Source>, AoaError> {
        data.check(self.array.len())?;
        for direction in directions {
            direction.check()?;
        }
        let most = self.array.len() / 2;
        let points: Vec<Point> =
            directions.iter().take(most).map(|&d| self.geometry.point(d)).collect();
        let mut points = self.kept(points, data);
        if let Data::Snapshots(y) = data
            && let Some(normalised) = Normalised::new(y)
        {
            points = self.nomp.complete(&normalised, points);
        }
        let directions: Vec<Direction> =
            points.iter().map(|&p| self.geometry.direction(p)).collect();
        let mut sources = sources_at(&self.array, &directions, data);
        sources.retain(|source| self.nomp.sees(source.direction));
        Ok(sources)
    }

    /// The points that are more than noise, refined.
    fn kept(&mut self, mut points: Vec<Point>, data: Data<'_>) -> Vec<Point> {
        let total = total_power(data);
        let mut refined = false;
        loop {
            let Some(fit) = Fit::new(&self.geometry, &points, data, total) else {
                // Two of them cannot be told apart: the weaker one is none.
                match self.closest(&points) {
                    Some(weaker) => points.remove(weaker),
                    None => return points,
                };
                continue;
            };
            let gains = fit.gains();
            let weakest = (0..gains.len()).min_by(|&a, &b| gains[a].total_cmp(&gains[b]));
            let Some(weakest) = weakest else { return points };
            let left = fit.residual.max(0.0) + gains[weakest];
            let share = self.shares.after(points.len() - 1, data.snapshots());
            let is_source = share.is_some_and(|least| gains[weakest] > least * left);
            if !is_source {
                points.remove(weakest);
                refined = false;
            } else if refined {
                return points;
            } else {
                points = refine_points(&self.geometry, points, data, STEPS).0;
                refined = true;
            }
        }
    }

    /// The later of the two closest points; nothing where there are no two.
    fn closest(&self, points: &[Point]) -> Option<usize> {
        let mut closest = None;
        for (later, &b) in points.iter().enumerate() {
            for &a in &points[..later] {
                let distance = self.geometry.distance(a, b);
                if closest.is_none_or(|(least, _)| distance < least) {
                    closest = Some((distance, later));
                }
            }
        }
        closest.map(|(_, later)| later)
    }
}
