//! What a snapshot takes by method.

use super::cell::Plan;
use super::{AoaExperiment, Condition};
use crate::error::EvaluateError;

/// Snapshots that are timed together.
const SNAPSHOTS: u64 = 128;
/// How often.
const ROUNDS: usize = 5;
/// What is in them.
const CONDITION: Condition = Condition::new(6, 25.0);

/// Time of one of many snapshots, s, by what is compared: the median over some rounds on one thread, of snapshots of 6
/// targets at 25 dB. Methods and networks are prepared before.
///
/// # Errors
/// Those of the methods.
pub fn times(options: &AoaExperiment) -> Result<Vec<(String, f64)>, EvaluateError> {
    let plan = Plan::new(options)?;
    let (scenes, _) = plan.scenes(0, CONDITION, 0, SNAPSHOTS)?;
    let mut all = vec![];
    for (name, mut task) in plan.tasks(CONDITION.targets)? {
        all.push((name, time_of(|| task(scenes.view()))? / SNAPSHOTS as f64));
    }
    Ok(all)
}

/// Time of a task, s: the median over some rounds after one that is not timed.
///
/// # Errors
/// Those of the task.
pub(crate) fn time_of(
    mut task: impl FnMut() -> Result<(), EvaluateError>,
) -> Result<f64, EvaluateError> {
    task()?;
    let mut rounds = [0.0; ROUNDS];
    for round in &mut rounds {
        let started = std::time::Instant::now();
        task()?;
        *round = started.elapsed().as_secs_f64();
    }
    rounds.sort_by(f64::total_cmp);
    Ok(rounds[ROUNDS / 2])
}
