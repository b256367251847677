//! The number of sources, and whether sources are more than noise.

pub mod counted;
pub mod counting;
pub(crate) mod false_alarm;
pub(crate) mod largest_root;
pub(crate) mod residual_count;
pub(crate) mod significance;
