//! Things that stand pass by as the radar moves: they come nearer where their range rate says so, and turn by
//! what the car turns the other way.
//!
//! The standing detections of a scan are moved to where a scan 0.3 s later should have them, under each pair of signs:
//! with velocity `v` (RANSAC's, turned round if range rates count the other way) and yaw rate `w` (turned round if
//! azimuths do) a point `p` comes to `R(-w t) (p - R(w t / 2) v t)`. The signs under which more of them lie
//! beside a detection are more likely. A mirrored scan shows a mirrored motion, so the sign of range rates does not
//! hang on that of azimuths, nor either of them on the mounting.

use super::tally::Tally;
use crate::intake;
use crate::statistics::frames::Frame;
use boresight_core::{Detection, DriveLog, Scan};

/// Time between the scans that are compared, s: the first scan after the lesser one, and not after the greater.
const APART_S: [f64; 2] = [0.25, 0.6];
/// Deviation of a point's range and azimuth from where it is expected, m and rad (1 deg), and how many of them are looked at.
const NEAR_M: f64 = 0.5;
const NEAR_RAD: f64 = 0.017_453_292_519_943_295;
const LOOKED_AT: f64 = 3.0;
/// Points beyond are too few and too coarse, m; nearer ones are of the car itself.
const RANGES_M: [f64; 2] = [1.0, 80.0];
/// Residual of range rate up to which a detection counts as standing, m/s.
const STANDING_MPS: f64 = 0.3;
/// Fewest standing detections of a scan.
const LEAST_POINTS: usize = 5;
/// Least way that tells the sign of range rates, m, and least turn that tells that of azimuths, rad (1 deg).
const TELLING_M: f64 = 1.0;
const TELLING_RAD: f64 = 0.017_453_292_519_943_295;

/// Deviations that speak for the usual sign, or, negative, against it.
pub(super) struct Passing {
    pub(super) azimuth: Option<f64>,
    pub(super) range_rate: Option<f64>,
    /// Whether detections have ranges at all.
    pub(super) has_ranges: bool,
}

/// What the scans of a radar say, of which `frames` are those with a motion.
pub(super) fn passing(
    log: &DriveLog,
    scans: &[&Scan],
    frames: &[Frame],
    max_gap_s: f64,
) -> Passing {
    let mut azimuth = Tally::default();
    let mut range_rate = Tally::default();
    let mut has_ranges = false;
    let mut next_s = f64::NEG_INFINITY;
    for frame in frames {
        let time_s = frame.scan.time_s;
        if time_s < next_s {
            continue;
        }
        let later = scans.partition_point(|scan| scan.time_s < time_s + APART_S[0]);
        let Some(later) = scans.get(later).filter(|scan| scan.time_s <= time_s + APART_S[1]) else {
            continue;
        };
        let points = standing(frame);
        has_ranges |= !points.is_empty();
        if points.len() < LEAST_POINTS {
            continue;
        }
        next_s = later.time_s;
        let apart_s = later.time_s - time_s;
        let way_m = frame.motion.velocity_mps.map(|v| v * apart_s);
        let turn_rad =
            log.yaw_rate_at(time_s + apart_s / 2.0, max_gap_s).map_or(0.0, |rate| rate * apart_s);
        let there = Later::new(&later.detections);
        let share = |sign: f64, side: f64| {
            there.share_met(&points, way_m.map(|way| sign * way), side * turn_rad)
        };
        let [[both, mirrored], [turned, neither]] =
            [1.0, -1.0].map(|sign| [1.0, -1.0].map(|side| share(sign, side)));
        if way_m[0].hypot(way_m[1]) > TELLING_M {
            range_rate.add(time_s, both.max(mirrored) - turned.max(neither));
        }
        if turn_rad.abs() > TELLING_RAD {
            azimuth.add(time_s, both.max(turned) - mirrored.max(neither));
        }
    }
    Passing { azimuth: azimuth.deviations(), range_rate: range_rate.deviations(), has_ranges }
}

fn within(detection: &Detection) -> bool {
    let [least, most] = RANGES_M;
    (least..=most).contains(&f64::from(detection.range_m)) && intake::is_valid(detection)
}

/// Places of the standing detections of a scan, m.
fn standing(frame: &Frame) -> Vec<[f64; 2]> {
    let [vx, vy] = frame.motion.velocity_mps;
    let detections = frame.scan.detections.iter().filter(|detection| within(detection));
    detections
        .filter_map(|detection| {
            let (sin, cos) = f64::from(detection.azimuth_rad).sin_cos();
            let rest = f64::from(detection.range_rate_mps) + vx * cos + vy * sin;
            let range = f64::from(detection.range_m);
            (rest.abs() < STANDING_MPS).then_some([range * cos, range * sin])
        })
        .collect()
}

/// The detections of the later scan, by range.
struct Later {
    /// Range, m, and azimuth, rad.
    places: Vec<[f64; 2]>,
}

impl Later {
    fn new(detections: &[Detection]) -> Self {
        let kept = detections.iter().filter(|detection| within(detection));
        let mut places: Vec<_> =
            kept.map(|d| [f64::from(d.range_m), f64::from(d.azimuth_rad)]).collect();
        boresight_math::order::sort_ascending(&mut places, |place: &[f64; 2]| place[0]);
        Self { places }
    }

    /// How well points are met on average, 0 to 1, once the radar has gone a way and turned.
    fn share_met(&self, points: &[[f64; 2]], way_m: [f64; 2], turn_rad: f64) -> f64 {
        let ((half_sin, half_cos), (sin, cos)) = ((turn_rad / 2.0).sin_cos(), turn_rad.sin_cos());
        let way =
            [half_cos * way_m[0] - half_sin * way_m[1], half_sin * way_m[0] + half_cos * way_m[1]];
        let met = points.iter().map(|point| {
            let [x, y] = [point[0] - way[0], point[1] - way[1]];
            self.nearness(cos * x + sin * y, cos * y - sin * x)
        });
        met.sum::<f64>() / points.len() as f64
    }

    /// 1 where a detection lies at a place, less the further the nearest one is.
    fn nearness(&self, x: f64, y: f64) -> f64 {
        let (range, azimuth) = (x.hypot(y), y.atan2(x));
        let from = self.places.partition_point(|place| place[0] < range - LOOKED_AT * NEAR_M);
        let near = self.places[from..]
            .iter()
            .take_while(|place| place[0] <= range + LOOKED_AT * NEAR_M)
            .map(|place| {
                ((place[0] - range) / NEAR_M).powi(2) + ((place[1] - azimuth) / NEAR_RAD).powi(2)
            });
        near.reduce(f64::min).map_or(0.0, |squared| (-0.5 * squared).exp())
    }
}
