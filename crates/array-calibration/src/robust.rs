//! Which cells one plane wave fits, and what each weighs.

use crate::fit::{Fit, Fitted};

/// Rounds of weighing.
const ROUNDS: usize = 6;

/// Misfit, in times of what is usual, from which a cell weighs less and less.
const UNUSUAL: f64 = 4.0;

/// A fit with the weight of each cell.
pub(crate) struct Weighed {
    pub fit: Fitted,
    /// The inverse of the variance of each cell in one channel.
    pub weights: Vec<f64>,
}

/// Fits cells whose misfit is noise and an excess common to all, in which cells that fit far worse weigh little.
///
/// Reflections and neighbours change a target's response by a share of its power, whatever that is; so a strong cell does
/// not outweigh the others by its power.
pub(crate) fn weighed(fit: &Fit) -> Weighed {
    let noise: Vec<f64> = fit.seen.iter().map(|cell| cell.variance).collect();
    let mut weights: Vec<f64> = noise.iter().map(|variance| 1.0 / (variance + 0.01)).collect();
    let mut found = fit.best_of_starts(&weights);
    for round in 0..ROUNDS {
        // What cells have beyond noise, over their power: reflections, and what a plane wave does not tell.
        let excess = excess_of(&found.residuals, &noise);
        weights = found
            .residuals
            .iter()
            .zip(&noise)
            .map(|(left, variance)| {
                let usual = variance + excess;
                let unusual = (left / (UNUSUAL * usual).max(f64::MIN_POSITIVE)).powi(2);
                1.0 / (usual.max(1e-12) * (1.0 + unusual))
            })
            .collect();
        // Starts anew once, when the outliers are known.
        found = if round == 0 {
            fit.best_of_starts(&weights)
        } else {
            fit.settle(found.factors, &weights)
        };
    }
    Weighed { fit: found, weights }
}

/// The median of what residuals have beyond noise.
fn excess_of(residuals: &[f64], noise: &[f64]) -> f64 {
    let mut beyond: Vec<f64> =
        residuals.iter().zip(noise).map(|(left, variance)| (left - variance).max(0.0)).collect();
    boresight_math::order::sort_numbers(&mut beyond);
    // The lower of two in the middle: half of the cells may hold more than a target.
    beyond.get(beyond.len().saturating_sub(1) / 2).copied().unwrap_or_default()
}
