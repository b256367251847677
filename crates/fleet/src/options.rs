//! How the records of a fleet are put together.

use crate::history::HistoryOptions;
use boresight_mounting::MergeOptions;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Options of what the records of a fleet come to.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct FleetOptions {
    /// The alarm is raised where an angle differs from nominal by more than this, beyond chance.
    #[option(default = 1.0_f64.to_radians(), range = 1e-9..=180)]
    pub alarm_rad: f64,
    /// Share of radars without a knock in which one is told.
    #[option(default = 1e-3, range = 1e-9..=0.5)]
    pub knock_chance: f64,
    /// Share of radars without a drift in which one is told.
    #[option(default = 1e-3, range = 1e-9..=0.5)]
    pub drift_chance: f64,
    /// Knocks and drifts that change the angle by less, over all drives, are not told.
    #[option(default = 0.05_f64.to_radians(), range = 0..=180)]
    pub least_change_rad: f64,
    /// What the drives of a vehicle have in common.
    pub joint: MergeOptions,
}

impl FleetOptions {
    /// Those of a radar's history.
    #[must_use]
    pub fn history(&self) -> HistoryOptions {
        HistoryOptions {
            knock_false_alarm: self.knock_chance,
            drift_false_alarm: self.drift_chance,
            least_change_rad: self.least_change_rad,
        }
    }
}
