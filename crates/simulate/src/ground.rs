//! Reflection by the road: each leg of a path goes straight or by way of the ground.

use crate::cube::CubeTarget;
use boresight_core::Direction;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// A flat road that reflects.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Ground {
    /// Height of the radar over it.
    #[option(default = 0.5, range = 0.01..=100)]
    pub radar_height_m: f64,
    /// Amplitude of the reflection over that of the incident wave. Its phase is reversed.
    #[option(default = 0.5, range = 0..=1)]
    pub reflection: f64,
}

/// A leg of a path between radar and target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leg {
    pub length_m: f64,
    pub rate_mps: f64,
    pub direction: Direction,
    /// Factor of the amplitude.
    pub gain: f64,
}

impl Leg {
    /// Straight to the target.
    pub fn direct(target: &CubeTarget) -> Self {
        let CubeTarget { range_m, rate_mps, direction, .. } = *target;
        Self { length_m: range_m, rate_mps, direction: *direction, gain: 1.0 }
    }
}

impl Ground {
    /// By way of the ground: as from the target's mirror image. None for a target below the ground.
    pub(crate) fn leg(&self, target: &CubeTarget) -> Option<Leg> {
        let (sine, cosine) = target.direction.elevation_rad.sin_cos();
        let along = target.range_m * cosine;
        // From the radar down to the image.
        let down = 2.0 * self.radar_height_m + target.range_m * sine;
        if down <= self.radar_height_m {
            return None;
        }
        let length_m = along.hypot(down);
        Some(Leg {
            length_m,
            rate_mps: target.rate_mps * (along * cosine + down * sine) / length_m,
            direction: Direction::new(target.direction.azimuth_rad, -down.atan2(along)),
            gain: -self.reflection,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_image_lies_as_far_below_the_ground_as_the_target_above() {
        let ground = Ground { radar_height_m: 0.5, reflection: 0.7 };
        // 40 m away, 1.5 m over the ground.
        let direction = Direction::new(0.1, (1.0f64 / 40.0).atan());
        let range_m = 40.0f64.hypot(1.0);
        let target = CubeTarget {
            range_m,
            rate_mps: -10.0,
            direction: direction.into(),
            ..CubeTarget::default()
        };
        let leg = ground.leg(&target).unwrap();
        assert!((leg.length_m - 40.0f64.hypot(2.0)).abs() < 1e-9, "{leg:?}");
        assert!((leg.direction.elevation_rad + (2.0f64 / 40.0).atan()).abs() < 1e-9);
        let later = CubeTarget { range_m: range_m - 1e-4, ..target };
        let rate = (ground.leg(&later).unwrap().length_m - leg.length_m) / 1e-5;
        assert!((leg.rate_mps - rate).abs() < 1e-4, "{} {rate}", leg.rate_mps);
        let below = CubeTarget { direction: Direction::new(0.0, -0.1).into(), ..target };
        assert_eq!(ground.leg(&below), None);
    }
}
