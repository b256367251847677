//! What a snapshot takes by method.

use super::cell::Plan;
use super::{AoaExperiment, Condition};
use crate::EvaluateError;

/// Snapshots that are timed together.
const SNAPSHOTS: u64 = 128;
/// How often.
const ROUNDS: usize = 5;
/// What is in them.
const CONDITION: Condition = Condition { targets: 6, snr_db: 25.0 };

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
        task(scenes.view())?;
        let mut rounds = vec![];
        for _ in 0..ROUNDS {
            let started = std::time::Instant::now();
            task(scenes.view())?;
            rounds.push(started.elapsed().as_secs_f64() / SNAPSHOTS as f64);
        }
        rounds.sort_by(f64::total_cmp);
        all.push((name, rounds[ROUNDS / 2]));
    }
    Ok(all)
}
