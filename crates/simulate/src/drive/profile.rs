//! How far a simulated drive is from an ideal one.

use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// What the errors of radars and car are like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DriveProfile {
    /// White noise as the options say, and a few false detections: isolates what an estimator does.
    #[default]
    Clean,
    /// Dense scans with lasting errors, heights, ghosts, slip and delay, as in `RadarScenes`.
    Radarscenes,
}

/// What measures the yaw rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum YawRateSensor {
    /// An integrated navigation system: scale within 0.2 %, hardly any bias.
    Navigation,
    /// A series sensor: scale from 0.98 to 1.02, bias from -0.2 to 0.2 deg/s that walks.
    Series,
}
