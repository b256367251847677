//! Detections of a radar's point cloud.
//!
//! The range rate is the part of a point's velocity that lies along the ray to it. nuScenes gives `vx` and `vy`, relative to the radar
//! and not compensated for its motion, but not always along the ray: its radars state how fast a thing would move if it moved
//! straight ahead, and what they measured is that velocity's part along the ray (nuscenes-devkit, issues 764 and 924). `vx_comp` and
//! `vy_comp` have the car's motion taken out and are of no use for calibration. TruckScenes gives `vrel_x`, `vrel_y`, `vrel_z`. Other clouds
//! may have the range rate itself, under one of [`RADIAL`].
//!
//! As nuScenes' own reader does by default, points are kept whose `invalid_state` is 0, whose `ambig_state` is 3 (unambiguous) and
//! whose `dyn_prop` is not 7 (stopped); the others are counted.

use crate::drive_log::motion;
use crate::drive_log::report::{DropReason, ReadReport};
use crate::error::FormatError;
use crate::pcd::PointCloud;
use boresight_core::drive::Detection;

/// Names of a field that holds range rates.
pub(super) const RADIAL: [&str; 7] =
    ["range_rate", "radial_velocity", "v_r", "vr", "doppler", "Doppler", "velocity"];

/// A field that marks points, what keeps them, and why others are left out.
type Mark = (&'static str, fn(f64) -> bool, DropReason);

/// What is required of fields that mark points, and why others are left out.
const MARKS: [Mark; 3] = [
    ("invalid_state", |state| state == 0.0, DropReason::InvalidState),
    ("ambig_state", |state| state == 3.0, DropReason::AmbiguousDoppler),
    ("dyn_prop", |property| (0.0..=6.0).contains(&property), DropReason::DynamicProperty),
];

/// How a cloud gives range rates.
enum Rates {
    Radial(Vec<f64>),
    Vector([Option<Vec<f64>>; 3]),
}

pub(super) fn detections(
    cloud: &PointCloud,
    report: &mut ReadReport,
) -> Result<Vec<Detection>, FormatError> {
    let [x, y] = [cloud.need("x")?, cloud.need("y")?];
    let z = cloud.column("z");
    let vector = [["vx", "vy", "vz"], ["vrel_x", "vrel_y", "vrel_z"]]
        .map(|names| names.map(|name| cloud.column(name)));
    let vector = vector.into_iter().find(|[x, y, _]| x.is_some() && y.is_some());
    let rates = match (vector, RADIAL.iter().find_map(|name| cloud.column(name))) {
        (Some(vector), _) => Rates::Vector(vector),
        (None, Some(radial)) => Rates::Radial(radial),
        (None, None) => {
            let expected = format!("vx and vy, vrel_x and vrel_y, or one of {}", RADIAL.join(", "));
            return Err(cloud.lacks(&expected));
        }
    };
    let rcs = cloud.column("rcs").or_else(|| cloud.column("RCS"));
    let marks: Vec<_> = MARKS
        .into_iter()
        .filter_map(|(name, kept, reason)| Some((cloud.column(name)?, kept, reason)))
        .collect();
    let mut detections = Vec::with_capacity(cloud.len());
    for i in 0..cloud.len() {
        report.detections += 1;
        let at = |column: &Option<Vec<f64>>| column.as_ref().map_or(0.0, |column| column[i]);
        let place = [x[i], y[i], at(&z)];
        if let Some((.., reason)) = marks.iter().find(|(column, kept, _)| !kept(column[i])) {
            report.drop(*reason);
            continue;
        }
        let rate = match &rates {
            Rates::Radial(radial) => radial[i],
            Rates::Vector(vector) => along(place, [0, 1, 2].map(|axis| at(&vector[axis]))),
        };
        let rcs = rcs.as_ref().map_or(f64::NAN, |rcs| rcs[i]);
        match detection(place, rate, rcs) {
            Some(detection) => {
                report.incomplete += u64::from(detection.rcs_dbsm.is_nan());
                detections.push(detection);
            }
            None => report.drop(DropReason::NotFinite),
        }
    }
    Ok(detections)
}

/// A detection at a place, m, in the radar's frame; `None` at the radar itself, where there is no azimuth.
pub(super) fn detection(place: [f64; 3], range_rate_mps: f64, rcs_dbsm: f64) -> Option<Detection> {
    let [x, y, _] = place;
    let azimuth_rad = if x == 0.0 && y == 0.0 { f64::NAN } else { y.atan2(x) };
    motion::detection(azimuth_rad, range_rate_mps, norm(place), rcs_dbsm)
}

/// The part of a velocity along the ray to a place.
fn along(place: [f64; 3], velocity: [f64; 3]) -> f64 {
    let product: f64 = place.iter().zip(velocity).map(|(p, v)| p * v).sum();
    product / norm(place)
}

fn norm(place: [f64; 3]) -> f64 {
    place.iter().map(|p| p * p).sum::<f64>().sqrt()
}
