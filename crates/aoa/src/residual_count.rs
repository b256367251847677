//! Counting sources in a single vector by what each further source explains of the power that those before leave.
//!
//! A covariance of one vector has no eigenvalues of noise to compare with. The share of the residual that the next source of
//! the best fit explains is compared instead with the share that the peak of noise of unknown power has ([`Shares`]).

use crate::cosines::Geometry;
use crate::false_alarm::{Shares, Volumes};
use crate::options::EstimatorOptions;
use boresight_core::Array;

/// Further sources that are looked for beyond one that does not stand out: sources of equal power hide each other.
const AHEAD: usize = 6;
/// Share of the power below which nothing but rounding is left.
const EXHAUSTED: f64 = 1e-12;

/// The test, for one array.
pub(crate) struct ResidualCount {
    /// Levels while every source stood out.
    direct: Shares,
    /// Levels beyond one that did not, which share half the probability of a false alarm.
    ahead: Shares,
    most: usize,
}

impl ResidualCount {
    /// For at most `most` sources, with the false-alarm probability of [`EstimatorOptions::nomp`].
    pub fn new(
        array: &Array,
        geometry: &Geometry,
        options: &EstimatorOptions,
        most: usize,
    ) -> Self {
        let volumes = Volumes::new(array, geometry, options.elevation_field_of_view_rad);
        let shares = |false_alarm| Shares::new(volumes, geometry, false_alarm);
        let false_alarm = options.nomp.false_alarm;
        let ahead = shares(0.5 * false_alarm / AHEAD as f64);
        Self { direct: shares(false_alarm), ahead, most: most.min(options.nomp.max_sources) }
    }

    /// The number of sources in one vector, from the power that the best fit of so many sources leaves.
    pub fn count(&mut self, mut residual: impl FnMut(usize) -> f64) -> usize {
        let total = residual(0);
        let (mut left, mut sources) = (total, 0);
        for found in 0..self.most {
            let direct = sources == found;
            let shares = if direct { &mut self.direct } else { &mut self.ahead };
            let Some(least) = shares.after(found, 1) else { break };
            if left <= EXHAUSTED * total || found > sources + AHEAD {
                break;
            }
            // The fit of one source more is no worse; the search for it may end elsewhere.
            let next = residual(found + 1).min(left);
            if left - next > least * left {
                sources = found + 1;
            }
            left = next;
        }
        sources
    }
}
