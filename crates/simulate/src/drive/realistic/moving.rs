//! How much moves in a scene, and how it is shared among the radars.

use super::model;
use boresight_core::Random;

/// The moving share of a scene: three quarters of them have little.
pub(crate) fn draw_share(random: &mut Random) -> f64 {
    let mut draw = random.unit();
    let within = random.unit();
    for [weight, from, to] in model::MOVING_SCENES {
        if draw < weight {
            return from + (to - from) * within;
        }
        draw -= weight;
    }
    0.0
}

/// The moving share of a radar that looks `yaw_rad` to the left, of the one asked for.
pub(crate) fn share_of(asked: f64, yaw_rad: f64) -> f64 {
    asked * model::by_direction(&model::MOVING_FACTOR, yaw_rad)
}
