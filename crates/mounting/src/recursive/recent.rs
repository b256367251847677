//! The last half minute, held apart from what is known before it: whether the angle has changed since.

use super::block::Sum;
use super::information::{Information, Vector};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Blocks held apart.
const MOST_BLOCKS: usize = 6;
/// Fewest blocks that a change is believed from, and fewest before them.
const LEAST_BLOCKS: usize = 3;
const LEAST_BEFORE: f64 = 4.0;
/// A change is at least this large, rad (0.4 deg), and this many standard deviations.
const LEAST_RAD: f64 = 0.007;
const DEVIATIONS: f64 = 6.0;
/// The blocks after a change agree with each other: mean square of their residuals in units of what is expected.
const AGREEMENT: f64 = 4.0;

/// The last blocks, in their order.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Recent {
    blocks: VecDeque<Sum>,
}

impl Recent {
    /// Takes a block, and gives the one that is no longer recent.
    pub(crate) fn push(&mut self, block: Sum) -> Option<Sum> {
        self.blocks.push_back(block);
        if self.blocks.len() > MOST_BLOCKS { self.blocks.pop_front() } else { None }
    }

    /// Whether there are no more than are kept.
    pub(crate) fn is_sound(&self) -> bool {
        self.blocks.len() <= MOST_BLOCKS && self.blocks.iter().all(Sum::is_sound)
    }

    pub(crate) fn last(&self) -> Option<&Sum> {
        self.blocks.back()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Sum> {
        self.blocks.iter()
    }

    /// Where the last blocks, three or more, lie off the angle known before by more than chance, and agree with each other: the angle that those have by
    /// themselves that say so most clearly. Blocks before the change are then dropped.
    pub(crate) fn changed(&mut self, known: &Information) -> Option<f64> {
        if known.blocks() < LEAST_BEFORE {
            return None;
        }
        let x: Vector = std::array::from_fn(|i| known.mean()[i] - known.reference()[i]);
        let (lasting, design_effect) = (known.lasting(), known.design_effect().max(1.0));
        let (mut sum, mut squares, mut total) = (0.0, 0.0, 0.0);
        let mut best = (DEVIATIONS, None);
        for (index, block) in self.blocks.iter().rev().enumerate() {
            let weight = 1.0 / (block.own_variance() + lasting);
            let residual = block.residual_at(&x);
            sum += weight * residual;
            squares += weight * residual * residual;
            total += weight;
            let change = sum / total;
            let scatter = (squares - change * sum) / index.max(1) as f64;
            let strength = change.abs() / (design_effect / total + known.covariance()[0][0]).sqrt();
            if index + 1 >= LEAST_BLOCKS
                && scatter < AGREEMENT * design_effect
                && change.abs() > LEAST_RAD
                && strength > best.0
            {
                best = (strength, Some((index + 1, change)));
            }
        }
        let (count, change) = best.1?;
        self.blocks.drain(..self.blocks.len() - count);
        Some(known.mean()[0] + change)
    }
}
