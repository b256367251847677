//! A network that gives a radar's motion, whichever of the two.

use super::{DeepEgo, DeepEgoPlus, NetworkError, Weights};

/// DeepEgo or DeepEgo+, from the file of its weights.
#[derive(Debug, Clone)]
pub enum MotionNetwork {
    /// DeepEgo: single frames.
    Single(Box<DeepEgo>),
    /// DeepEgo+: single frames, and what smooths several.
    Smoothing(Box<DeepEgoPlus>),
}

impl MotionNetwork {
    /// The network that a file of weights is of; its tensors' names tell which.
    ///
    /// # Errors
    /// Those of [`Weights::read`], [`DeepEgo::new`] and [`DeepEgoPlus::new`].
    pub fn read(bytes: &[u8]) -> Result<Self, NetworkError> {
        let weights = Weights::read(bytes)?;
        Ok(match weights.shape("single.encode.0.weight") {
            Some(_) => Self::Smoothing(Box::new(DeepEgoPlus::new(&weights)?)),
            None => Self::Single(Box::new(DeepEgo::new(&weights)?)),
        })
    }

    /// The network of single frames.
    pub fn single(&self) -> &DeepEgo {
        match self {
            Self::Single(network) => network,
            Self::Smoothing(network) => network.single(),
        }
    }

    /// The network that smooths; none of single frames.
    pub fn smoothing(&self) -> Option<&DeepEgoPlus> {
        match self {
            Self::Single(_) => None,
            Self::Smoothing(network) => Some(network),
        }
    }
}
