//! Equations of frames into blocks, and blocks into what is known.

use super::block::Scatter;
use super::equation::Equation;
use super::information::{Information, Vector};
use super::{ANGLE_PRIOR_RAD, LearntScatter, MOST_SCATTER_BLOCKS, Recursive};
use crate::angle::wrap;
use crate::frame::FrameOutcome;

/// Blocks before which each frame moves the angle at once.
const FIRST_BLOCKS: u64 = 3;

impl Recursive {
    /// Adds the frame's equation.
    pub(super) fn inform(
        &mut self,
        time_s: f64,
        speed_mps: f64,
        equation: &Equation,
        outcome: &mut FrameOutcome,
    ) {
        if let Some(driven_s) = self.state.block.ends_before(time_s, speed_mps) {
            self.end_block(time_s, driven_s);
        }
        self.state.block.add(equation.row);
        let state = &self.state;
        let variance = equation.row.variance + state.scatter.scatter.excess;
        outcome.angle_rad = Some(wrap(state.now.mean()[0] + equation.innovation));
        outcome.angle_sigma_rad = Some((variance + state.now.lasting()).sqrt());
        outcome.weight = 1.0 / variance;
        if state.blocks < FIRST_BLOCKS {
            self.state.now = self.complete();
        }
    }

    /// What is known with all blocks, and with the one that is not complete.
    pub(super) fn complete(&self) -> Information {
        let state = &self.state;
        let mut known = state.before;
        for block in state.recent.iter() {
            known.add(block);
        }
        known.with(&state.block.sum(&offset(&known), state.scatter.scatter))
    }

    fn end_block(&mut self, time_s: f64, driven_s: f64) {
        let state = &mut self.state;
        let block = state.block.sum(&offset(&state.now), state.scatter.scatter);
        state.doubts.free_scale.add(&state.block);
        state.block.clear();
        state.speed_scale.end_block();
        state.blocks += 1;
        let LearntScatter { scatter: Scatter { excess, correlated }, blocks } = &mut state.scatter;
        *excess = (*excess + (block.excess - *excess) / (*blocks + 1.0)).max(1e-8);
        *correlated += (block.correlated.unwrap_or(*correlated) - *correlated) / (*blocks + 1.0);
        *blocks = (*blocks + 1.0).min(MOST_SCATTER_BLOCKS);
        if let Some(old) = state.recent.push(block) {
            state.before.add(&old);
            state.before.forget((-driven_s / self.options.memory_s).exp());
        }
        if let Some(angle) = state.recent.changed(&state.before) {
            state.before.reset_angle(angle, ANGLE_PRIOR_RAD);
            state.changed_s = Some(time_s);
        }
        self.state.now = self.complete();
        let angles = &mut self.state.angles;
        *angles = [Some(self.state.now.mean()[0]), angles[0], angles[1]];
    }
}

/// Unknowns less what blocks' equations are written about.
pub(super) fn offset(known: &Information) -> Vector {
    std::array::from_fn(|i| known.mean()[i] - known.reference()[i])
}
