//! What stands around the detections: the car, the sectors its radars see, and what moves.

use super::cloud::place;
use super::messages::{
    Color, CubePrimitive, LinePrimitive, LineType, Pose, SceneEntity, SceneUpdate, Time, Vector3,
};
use super::{CAR, frame_id};
use boresight_core::DriveLog;
use boresight_core::drive::{Detection, Scan};

/// A car's length ahead of and behind its rear axle, width and height, m: of one, as logs do not tell.
const CAR_M: [f64; 4] = [3.8, 0.9, 1.8, 1.4];
/// Points of the arc of a sector.
const ARC: u32 = 33;
/// Detections with a smaller weight count as moving.
const MOVING_WEIGHT: f32 = 0.5;
/// What moves is shown for as long as a scan may take, s and ns.
const LIFETIME: Time = Time { sec: 0, nsec: 150_000_000 };
const ALWAYS: Time = Time { sec: 0, nsec: 0 };

const BODY: Color = Color { r: 0.45, g: 0.5, b: 0.6, a: 0.6 };
const SECTOR: Color = Color { r: 0.3, g: 0.6, b: 1.0, a: 0.6 };
const MOVING: Color = Color { r: 1.0, g: 0.45, b: 0.1, a: 1.0 };

/// The car and, for each radar of the log, the sector that its detections lie in.
#[must_use]
pub fn car(log: &DriveLog, time_ns: u64) -> SceneUpdate {
    let timestamp = Time::from(time_ns);
    let [ahead, behind, width, height] = CAR_M;
    let body = CubePrimitive {
        pose: Pose::at(0.5 * (ahead - behind), 0.0, 0.5 * height),
        size: Vector3 { x: ahead + behind, y: width, z: height },
        color: BODY,
    };
    let entity = |frame_id: String, id: String| SceneEntity {
        timestamp,
        frame_id,
        id,
        lifetime: ALWAYS,
        frame_locked: true,
        cubes: vec![],
        lines: vec![],
    };
    let car = SceneEntity { cubes: vec![body], ..entity(CAR.into(), CAR.into()) };
    let sectors = log.sensors.iter().filter_map(|sensor| {
        let own = log.scans.iter().filter(|scan| scan.sensor == sensor.id);
        let lines = vec![sector(own.flat_map(|scan| &scan.detections))?];
        let name = frame_id(sensor.id);
        Some(SceneEntity { lines, ..entity(name.clone(), name) })
    });
    SceneUpdate { entities: std::iter::once(car).chain(sectors).collect() }
}

/// Around all detections that have a range; none without any.
fn sector<'a>(detections: impl Iterator<Item = &'a Detection>) -> Option<LinePrimitive> {
    let (mut low, mut high, mut far) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    for detection in detections.filter(|detection| detection.range_m.is_finite()) {
        let azimuth_rad = f64::from(detection.azimuth_rad);
        (low, high) = (low.min(azimuth_rad), high.max(azimuth_rad));
        far = far.max(detection.range_m.into());
    }
    (low <= high).then(|| {
        let arc = (0..ARC).map(|k| {
            let azimuth_rad = low + (high - low) * f64::from(k) / f64::from(ARC - 1);
            let (sin, cos) = azimuth_rad.sin_cos();
            Vector3 { x: far * cos, y: far * sin, z: 0.0 }
        });
        lines(LineType::Loop, std::iter::once(Vector3::default()).chain(arc).collect(), SECTOR)
    })
}

/// A line for each detection of a scan that was taken as moving, as far as it moves along its ray in a second
/// (m for m/s). `velocity_mps` is the radar's own, ahead and to the left in its frame.
#[must_use]
pub fn moving(
    scan: &Scan,
    time_ns: u64,
    weights: &[f32],
    velocity_mps: Option<[f64; 2]>,
) -> SceneUpdate {
    let mut points = vec![];
    if let Some([vx, vy]) = velocity_mps {
        let moves = scan.detections.iter().zip(weights).filter(|(_, w)| **w < MOVING_WEIGHT);
        for (detection, _) in moves {
            let (sin, cos) = f64::from(detection.azimuth_rad).sin_cos();
            let along_mps = f64::from(detection.range_rate_mps) + vx * cos + vy * sin;
            let [x, y] = place(detection);
            if (x + y + along_mps).is_finite() {
                points.push(Vector3 { x, y, z: 0.0 });
                points.push(Vector3 { x: x + along_mps * cos, y: y + along_mps * sin, z: 0.0 });
            }
        }
    }
    let entity = SceneEntity {
        timestamp: Time::from(time_ns),
        frame_id: frame_id(scan.sensor),
        id: frame_id(scan.sensor),
        lifetime: LIFETIME,
        frame_locked: false,
        cubes: vec![],
        lines: vec![lines(LineType::List, points, MOVING)],
    };
    SceneUpdate { entities: vec![entity] }
}

fn lines(of: LineType, points: Vec<Vector3>, color: Color) -> LinePrimitive {
    LinePrimitive {
        of,
        pose: Pose::OWN,
        thickness: 2.0,
        scale_invariant: true,
        points,
        color,
        colors: vec![],
        indices: vec![],
    }
}
