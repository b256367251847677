//! Recordings that tests write.

use crate::drive_log::DriveRead;
use crate::drive_log::mcap::{TopicOptions, read};
use crate::mcap::made::{channel, chunk, file, message, schema};
use crate::ros::made::{Cdr, HEADER, QUATERNION, TIME, VECTOR, definition};
use boresight_core::drive::Detection;

pub(super) const RETURN: (&str, &str) = (
    "radar_msgs/RadarReturn",
    "float32 range\nfloat32 azimuth # Positive angles are anticlockwise\nfloat32 elevation\n\
     float32 doppler_velocity\nfloat32 amplitude",
);
pub(super) const FIELD: (&str, &str) = (
    "sensor_msgs/PointField",
    "uint8 INT8=1\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
);
pub(super) const CLOUD: &str = "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n\
    uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense";
/// 2026, ns.
pub(super) const T: u64 = 1_790_000_000_000_000_000;
pub(super) const MS: u64 = 1_000_000;

/// A recording that is written.
#[derive(Default)]
pub(super) struct Bag {
    records: Vec<Vec<u8>>,
    pub(super) next: u16,
}

impl Bag {
    pub(super) fn topic(
        &mut self,
        topic: &str,
        kind: &str,
        own: &str,
        others: &[(&str, &str)],
    ) -> u16 {
        self.next += 1;
        let id = self.next;
        self.records.push(schema(id, kind, "ros2msg", &definition(own, others)));
        self.records.push(channel(id, id, topic, "cdr"));
        id
    }

    pub(super) fn scans(&mut self, topic: &str) -> u16 {
        let own = "std_msgs/Header header\nradar_msgs/RadarReturn[] returns";
        self.topic(topic, "radar_msgs/msg/RadarScan", own, &[HEADER, TIME, RETURN])
    }

    pub(super) fn clouds(&mut self, topic: &str) -> u16 {
        self.topic(topic, "sensor_msgs/msg/PointCloud2", CLOUD, &[HEADER, TIME, FIELD])
    }

    pub(super) fn add(&mut self, id: u16, log_ns: u64, cdr: Cdr) {
        self.records.push(message(id, log_ns, &cdr.done()));
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        file(&[chunk("lz4", &self.records.concat())], &[])
    }

    pub(super) fn read(&self) -> DriveRead {
        read(&self.bytes(), TopicOptions::default()).unwrap()
    }
}

/// A RadarScan of returns (range, azimuth, range rate).
pub(super) fn scan(time_ns: u64, frame: &str, returns: &[[f32; 3]]) -> Cdr {
    let cdr = Cdr::new().header(time_ns, frame).u32(returns.len() as u32);
    returns.iter().fold(cdr, |cdr, [range, azimuth, rate]| {
        cdr.f32(*range).f32(*azimuth).f32(0.0).f32(*rate).f32(30.0)
    })
}

pub(super) fn numbers(detection: &Detection) -> [f32; 3] {
    [detection.range_m, detection.azimuth_rad, detection.range_rate_mps]
}

pub(super) fn odometry(bag: &mut Bag, topic: &str) -> u16 {
    let own = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
        geometry_msgs/TwistWithCovariance twist";
    let others = [
        HEADER,
        TIME,
        VECTOR,
        QUATERNION,
        ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"),
        ("geometry_msgs/Pose", "Point position\nQuaternion orientation"),
        ("geometry_msgs/Twist", "Vector3  linear\nVector3  angular"),
        ("geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"),
        ("geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"),
    ];
    bag.topic(topic, "nav_msgs/msg/Odometry", own, &others)
}

pub(super) fn odometer(time_ns: u64, x: f64, yaw: f64, speed: f64, rate: f64) -> Cdr {
    let (sine, cosine) = (yaw / 2.0).sin_cos();
    let cdr = Cdr::new().header(time_ns, "odom").text("base_link");
    let cdr = cdr.f64s(&[x, -x, 0.0, 0.0, 0.0, sine, cosine]).f64s(&[0.0; 36]);
    cdr.f64s(&[speed, 0.1, 0.0, 0.0, 0.0, rate]).f64s(&[0.0; 36])
}

pub(super) fn twist(bag: &mut Bag, topic: &str) -> u16 {
    let own = "std_msgs/Header header\ngeometry_msgs/Twist twist";
    let others = [HEADER, TIME, VECTOR, ("geometry_msgs/Twist", "Vector3 linear\nVector3 angular")];
    bag.topic(topic, "geometry_msgs/msg/TwistStamped", own, &others)
}

pub(super) fn inertial(bag: &mut Bag) -> u16 {
    let own = "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
        geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance";
    bag.topic("/imu", "sensor_msgs/msg/Imu", own, &[HEADER, TIME, VECTOR, QUATERNION])
}

pub(super) fn turn_rates(time_ns: u64, rates: [f64; 3]) -> Cdr {
    let cdr = Cdr::new().header(time_ns, "imu").f64s(&[0.0, 0.0, 0.0, 1.0]).f64s(&[0.0; 9]);
    cdr.f64s(&rates).f64s(&[0.0; 9])
}

pub(super) fn transforms(bag: &mut Bag, all: &[(&str, &str, [f64; 3], [f64; 4])]) {
    let others = [
        HEADER,
        TIME,
        VECTOR,
        QUATERNION,
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\nTransform transform",
        ),
        ("geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"),
    ];
    let own = "geometry_msgs/TransformStamped[] transforms";
    let id = bag.topic("/tf_static", "tf2_msgs/msg/TFMessage", own, &others);
    let cdr =
        all.iter().fold(Cdr::new().u32(all.len() as u32), |cdr, (parent, child, shift, turn)| {
            cdr.header(0, parent).text(child).f64s(shift).f64s(turn)
        });
    bag.add(id, T, cdr);
}

/// Points of `names` of 32-bit floats, each point and row padded.
pub(super) fn cloud(
    time_ns: u64,
    frame: &str,
    names: &[&str],
    points: &[&[f32]],
    rows: u32,
) -> Cdr {
    let (step, columns) = (4 * names.len() + 3, points.len() / rows as usize);
    let row_step = columns * step + 5;
    let mut data = vec![0xee; row_step * rows as usize];
    for (k, point) in points.iter().enumerate() {
        let start = k / columns * row_step + k % columns * step;
        for (place, number) in data[start..].chunks_exact_mut(4).zip(*point) {
            place.copy_from_slice(&number.to_le_bytes());
        }
    }
    let cdr = Cdr::new().header(time_ns, frame).u32(rows).u32(columns as u32);
    let cdr = names.iter().enumerate().fold(cdr.u32(names.len() as u32), |cdr, (k, name)| {
        cdr.text(name).u32(4 * k as u32).u8(7).u32(1)
    });
    cdr.u8(0).u32(step as u32).u32(row_step as u32).bytes(&data).u8(1)
}
