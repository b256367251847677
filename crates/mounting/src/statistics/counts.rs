//! How often a radar scans, and how much it detects.

use super::robust::{deviation, median, quantile};
use super::{Counts, Row, Untold};
use crate::intake;
use boresight_core::Scan;
use boresight_core::drive::STATIC_LABEL;

/// A cycle longer than this many medians is one with a lost scan.
const LOST_CYCLES: f64 = 1.5;

/// Counts of a radar's scans, in order of time; notes what they do not tell.
pub(super) fn counts(scans: &[&Scan], untold: &mut Vec<Untold>) -> Counts {
    let cycles: Vec<f64> = scans.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    let cycle_s = median(&cycles);
    let whole: Vec<f64> =
        cycles.iter().copied().filter(|cycle| *cycle < LOST_CYCLES * cycle_s).collect();
    if cycles.is_empty() {
        untold.push(Untold::new(Row::Cycle, "there are fewer than two scans"));
    }
    let mut numbers: Vec<f64> = scans.iter().map(|scan| scan.detections.len() as f64).collect();
    let detections: f64 = numbers.iter().sum();
    let valid = scans.iter().flat_map(|scan| &scan.detections).filter(|d| intake::is_valid(d));
    let span = valid.map(|d| f64::from(d.azimuth_rad)).fold(None, |span, azimuth| {
        let [low, high] = span.unwrap_or([azimuth; 2]);
        Some([f64::min(low, azimuth), f64::max(high, azimuth)])
    });
    let labels = || scans.iter().flat_map(|scan| &scan.labels);
    let labelled = labels().count();
    let moving = labels().filter(|label| **label != STATIC_LABEL).count();
    if labelled == 0 {
        untold.push(Untold::new(Row::MovingShare, "the log has no labels"));
    }
    Counts {
        scans: scans.len() as u64,
        detections: detections as u64,
        cycle_s,
        cycle_jitter_s: deviation(&whole, median(&whole)),
        lost_share: (cycles.len() - whole.len()) as f64 / cycles.len() as f64,
        mean_count: detections / scans.len() as f64,
        count_range: [quantile(&mut numbers, 0.05), quantile(&mut numbers, 0.95)],
        most: numbers.last().copied().unwrap_or(f64::NAN),
        azimuth_span_rad: span.unwrap_or([f64::NAN; 2]),
        moving_share: moving as f64 / labelled as f64,
    }
}
