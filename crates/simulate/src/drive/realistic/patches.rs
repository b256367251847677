//! Errors of azimuth that last: glint, merging and multipath shift what comes from one patch of
//! ground by one angle for as long as a radar sees it.

use super::model;
use boresight_core::Random;

/// Offsets of the patches as one radar sees them.
#[derive(Debug, Clone)]
pub(crate) struct Patches {
    key: u64,
}

impl Patches {
    pub(crate) fn new(random: &mut Random) -> Self {
        Self { key: random.bits() }
    }

    /// The azimuth offset of what stands at a place on the ground and is seen at a range, rad.
    pub(crate) fn offset(&self, x_m: f64, y_m: f64, range_m: f64) -> f64 {
        let [x, y] = [x_m, y_m].map(|at| (at / model::PATCH_M).floor() as i32);
        let stream = u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned());
        sigma_rad(range_m) * Random::new(self.key, stream).normal()
    }
}

/// Standard deviation of the offsets at a range, rad.
pub(crate) fn sigma_rad(range_m: f64) -> f64 {
    let [from, to] = model::PATCH_RANGE_M;
    let [near, far] = model::PATCH_SIGMA_RAD;
    near + (far - near) * ((range_m - from) / (to - from)).clamp(0.0, 1.0)
}
