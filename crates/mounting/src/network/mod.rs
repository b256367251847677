//! Networks that weigh detections and smooth motion: DeepEgo (Zhu, Yarovoy and Fioranelli 2023) and DeepEgo+ (Zhu et
//! al. 2025), as far as they are published; sizes and features are ours. `research/training/boresight_training/drives` trains
//! them.

mod deepego;
mod dense;
mod error;
mod fit;
mod hypotheses;
mod motion_network;
mod recurrent;
mod smoother;
mod weights;

#[cfg(test)]
mod tests;

pub use deepego::{DeepEgo, WeighedMotion};
pub use error::NetworkError;
pub use hypotheses::Near;
pub use motion_network::MotionNetwork;
pub use smoother::{DeepEgoPlus, SmoothedMotion, WindowFrame};
pub use weights::Weights;
