//! Errors of azimuth that last: glint, merging and multipath shift what comes from one patch of
//! ground by one angle for as long as a radar sees it.

use super::model;
use boresight_core::Random;

/// Offsets of the patches as one radar sees them.
#[derive(Debug, Clone)]
pub(crate) struct Patches {
    keys: [u64; 2],
    factor: f64,
}

impl Patches {
    /// Those of a radar that looks `yaw_rad` to the left.
    pub(crate) fn new(yaw_rad: f64, random: &mut Random) -> Self {
        let factor = model::by_direction(&model::PATCH_FACTOR, yaw_rad);
        Self { keys: [random.bits(), random.bits()], factor }
    }

    /// The azimuth offset of what stands at a place on the ground, rad.
    pub(crate) fn offset(&self, x_m: f64, y_m: f64) -> f64 {
        let sizes = self.keys.iter().zip(model::PATCHES_M).zip(model::PATCH_SIGMAS_RAD);
        let sum: f64 = sizes
            .map(|((key, side_m), sigma)| sigma * square(*key, x_m, y_m, side_m).normal())
            .sum();
        self.factor * sum
    }
}

/// Random numbers of the square of ground that a place lies in.
pub(crate) fn square(key: u64, x_m: f64, y_m: f64, side_m: f64) -> Random {
    let [x, y] = [x_m, y_m].map(|at| (at / side_m).floor() as i32);
    Random::new(key, u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned()))
}
