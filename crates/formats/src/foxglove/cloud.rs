//! Scans as point clouds.

use super::frame_id;
use super::messages::{Base64, NumericType, PackedElementField, PointCloud, Pose, Time};
use boresight_core::drive::{Detection, Scan};

/// The numbers of each point that are in single precision, in order.
const FLOATS: [&str; 7] = ["x", "y", "z", "range_m", "azimuth_rad", "range_rate_mps", "rcs_dbsm"];
const WEIGHT: &str = "static_weight";
const LABEL: &str = "label";

/// Place of a detection in the frame of its radar, m: ahead and to the left. NaN without a range.
#[must_use]
pub fn place(detection: &Detection) -> [f64; 2] {
    let (sin, cos) = f64::from(detection.azimuth_rad).sin_cos();
    let range_m = f64::from(detection.range_m);
    [range_m * cos, range_m * sin]
}

/// The point cloud of a scan in the frame of its radar. `weights` says how far each detection was taken as standing;
/// where it is given and no motion was found, it is empty.
#[must_use]
pub fn point_cloud(scan: &Scan, time_ns: u64, weights: Option<&[f32]>) -> PointCloud {
    let count = scan.detections.len();
    let labels = (!scan.labels.is_empty() && scan.labels.len() == count).then_some(&scan.labels);
    let floats = FLOATS.iter().chain(weights.is_some().then_some(&WEIGHT));
    let mut fields: Vec<PackedElementField> = (0..)
        .zip(floats)
        .map(|(at, name)| PackedElementField { name, offset: 4 * at, of: NumericType::Float32 })
        .collect();
    let mut point_stride = 4 * fields.len() as u32;
    if labels.is_some() {
        let label =
            PackedElementField { name: LABEL, offset: point_stride, of: NumericType::Uint8 };
        fields.push(label);
        point_stride += 1;
    }
    let mut data = Vec::with_capacity(count * point_stride as usize);
    for (k, detection) in scan.detections.iter().enumerate() {
        let [x, y] = place(detection).map(|number| number as f32);
        let Detection { range_m, azimuth_rad, range_rate_mps, rcs_dbsm } = *detection;
        let weight = weights.map(|weights| weights.get(k).copied().unwrap_or(0.0));
        let numbers = [x, y, 0.0, range_m, azimuth_rad, range_rate_mps, rcs_dbsm];
        for number in numbers.into_iter().chain(weight) {
            data.extend_from_slice(&number.to_le_bytes());
        }
        data.extend(labels.map(|labels| labels[k]));
    }
    PointCloud {
        timestamp: Time::from(time_ns),
        frame_id: frame_id(scan.sensor),
        pose: Pose::OWN,
        point_stride,
        fields,
        data: Base64(data),
    }
}
