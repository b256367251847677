//! Counting sources by what each further source explains of the power that those before leave.
//!
//! A covariance of one vector has no eigenvalues of noise to compare with. The share of the residual that the next source
//! explains is compared instead with the share that the peak of noise of unknown power has ([`Shares`]).

use crate::model::cosines::Geometry;
use crate::options::{EstimatorOptions, NompOptions};
use crate::order::false_alarm::{Shares, Volumes};
use boresight_core::Array;

/// Further sources that are looked for beyond one that does not stand out: sources of equal power hide each other.
const AHEAD: usize = 6;
/// Share of the power below which nothing but rounding is left.
const EXHAUSTED: f64 = 1e-12;

/// What noise explains with a given probability.
pub(crate) struct Threshold {
    shares: Shares,
    volumes: Volumes,
    false_alarm: f64,
    /// Noise power of one element, where it is given.
    noise_power: Option<f64>,
}

impl Threshold {
    /// With the noise power of the options, if they give one.
    pub fn new(
        volumes: Volumes,
        geometry: &Geometry,
        options: &NompOptions,
        false_alarm: f64,
    ) -> Self {
        let shares = Shares::new(volumes, geometry, false_alarm);
        Self { shares, volumes, false_alarm, noise_power: options.noise_power }
    }

    /// Whether a source that explains `gain` of the power `left` by `found` others is more than noise. Of noise of unknown
    /// power that cannot be told, and is not so, where too few degrees of freedom are left.
    pub fn is_exceeded(
        &mut self,
        gain: f64,
        left: f64,
        total: f64,
        found: usize,
        snapshots: usize,
    ) -> bool {
        if gain.is_nan() || gain <= EXHAUSTED * total {
            return false;
        }
        match self.noise_power {
            Some(noise) => {
                let snapshots = Shares::counted(snapshots);
                let level = self.volumes.level(self.false_alarm, snapshots);
                gain * snapshots as f64 > noise * level
            }
            None => self.shares.after(found, snapshots).is_some_and(|share| gain > share * left),
        }
    }
}

/// The count, for one array.
pub(crate) struct ResidualCount {
    /// While every source stood out.
    direct: Threshold,
    /// Beyond one that did not; these tests share half the probability of a false alarm.
    ahead: Threshold,
    most: usize,
}

impl ResidualCount {
    /// For at most `most` sources, with the false-alarm probability and noise power of [`EstimatorOptions::nomp`].
    pub fn new(
        array: &Array,
        geometry: &Geometry,
        options: &EstimatorOptions,
        most: usize,
    ) -> Self {
        let volumes = Volumes::new(array, geometry, options.elevation_field_of_view_rad);
        let nomp = &options.nomp;
        let threshold = |false_alarm| Threshold::new(volumes, geometry, nomp, false_alarm);
        Self {
            direct: threshold(nomp.false_alarm),
            ahead: threshold(0.5 * nomp.false_alarm / AHEAD as f64),
            most: most.min(nomp.max_sources),
        }
    }

    /// The number of sources, from the power that 0, 1, 2, ... sources leave, in this order. Stops at `enough`.
    pub fn count(
        &mut self,
        snapshots: usize,
        enough: usize,
        mut residual: impl FnMut(usize) -> f64,
    ) -> usize {
        let total = residual(0);
        let (mut left, mut sources) = (total, 0);
        for found in 0..self.most {
            if left <= EXHAUSTED * total || found > sources + AHEAD || sources >= enough {
                break;
            }
            // The fit of one source more is no worse; the search for it may end elsewhere.
            let next = residual(found + 1).min(left);
            let test = if sources == found { &mut self.direct } else { &mut self.ahead };
            if test.is_exceeded(left - next, left, total, found, snapshots) {
                sources = found + 1;
            }
            left = next;
        }
        sources
    }
}
