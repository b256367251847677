//! What the drives of a vehicle have in common.

use super::CAR;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Whether drives share an unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sharing {
    /// One for all drives, about which a drive's own lies as far off as the drives prove to.
    #[default]
    Shared,
    /// One a drive, each with the prior by itself.
    Drive,
}

/// What to take the unknowns of a vehicle's drives for.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct MergeOptions {
    /// Scale of the yaw rate.
    pub scale: Sharing,
    /// Bias of the yaw rate.
    #[option(default = Sharing::Drive)]
    pub bias: Sharing,
    /// Slip gradient of the rear axle.
    pub slip: Sharing,
    /// Delay of the radars.
    pub delay: Sharing,
    /// Standard deviation, before the drives tell it, of what a radar's angle is off by in one drive and not in another: load, tyre
    /// pressures, weather, and how straight the car goes.
    #[option(default = 0.03_f64.to_radians(), positive)]
    pub drive_sigma_rad: f64,
}

impl MergeOptions {
    /// Which unknowns of the car drives share, in the order of the equations.
    pub(super) fn shared(&self) -> [bool; CAR] {
        [self.scale, self.bias, self.slip, self.delay].map(|sharing| sharing == Sharing::Shared)
    }
}
