//! When a radar scans: its own phase, cycles that jitter, scans that get lost.

use super::model;
use boresight_core::Random;

/// Times of the scans that arrive, s.
pub(crate) fn scan_times(duration_s: f64, random: &mut Random) -> Vec<f64> {
    let [from, to] = model::CYCLE_MEAN_S;
    let mean = random.uniform(from, to);
    let mut time = 0.08 + random.uniform(0.0, mean);
    let mut times = vec![];
    while time <= duration_s {
        if random.unit() >= model::LOST_SHARE {
            times.push(time);
        }
        let [shortest, longest] = model::CYCLE_S;
        time += (mean + model::CYCLE_SIGMA_S * random.normal()).clamp(shortest, longest);
    }
    times
}
