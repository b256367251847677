//! Brings the share of moving detections to what was asked for.

use super::radar::Labelled;
use boresight_core::Random;
use std::collections::BTreeMap;

/// Scans at lower speeds do not count, m/s.
pub(crate) const COUNTED_MPS: f64 = 1.0;

/// Leaves out whole movers, the last of them in part, where too much moves, and detections of
/// standing things where too little does.
/// Each scan comes with whether it counts.
pub(crate) fn trim(scans: &mut [(&mut Vec<Labelled>, bool)], share: f64, random: &mut Random) {
    let (mut standing, mut moving) = (0.0, 0.0);
    let mut tracks: BTreeMap<u32, f64> = BTreeMap::new();
    for (scan, _) in scans.iter().filter(|(_, counted)| *counted) {
        for one in scan.iter() {
            if one.moving {
                moving += 1.0;
                *tracks.entry(one.track).or_default() += 1.0;
            } else {
                standing += 1.0;
            }
        }
    }
    let wanted = share / (1.0 - share) * standing;
    if moving > wanted {
        let mut order: Vec<(u64, u32)> = tracks.keys().map(|t| (random.bits(), *t)).collect();
        boresight_math::order::sort_by(&mut order, Ord::cmp);
        // Share of its detections that a track keeps.
        let mut keep: BTreeMap<u32, f64> = BTreeMap::new();
        let mut excess = moving - wanted;
        for (_, track) in order {
            let count = tracks[&track];
            keep.insert(track, 1.0 - (excess / count).clamp(0.0, 1.0));
            excess = (excess - count).max(0.0);
        }
        for (scan, _) in scans.iter_mut() {
            scan.retain(|one| {
                let keep = keep.get(&one.track).copied().unwrap_or(1.0);
                let draw = random.unit();
                !one.moving || draw < keep
            });
        }
    } else if share > 0.0 && moving > 0.0 {
        let keep = moving * (1.0 - share) / (share * standing.max(1.0));
        for (scan, _) in scans.iter_mut() {
            scan.retain(|one| {
                let draw = random.unit();
                one.moving || draw < keep
            });
        }
    }
}
