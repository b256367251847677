//! What simulated samples cost.

/// What noise of a sample costs, in operations.
const NOISE_OPERATIONS: usize = 50;

/// Operations of a sample that is the sum of so many echoes and noise.
pub(crate) fn sum_operations(echoes: usize) -> f64 {
    (echoes + NOISE_OPERATIONS) as f64
}
