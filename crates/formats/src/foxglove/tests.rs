use super::messages::{Base64, Time};
use super::typed::{encode, encode_own, own};
use super::{Clock, DriveTopics, Message, cloud, scene};
use crate::mcap::write::McapWriter;
use boresight_core::Remark;
use boresight_core::drive::{
    Detection, DriveLog, MotionSample, Mounting, Pose, STATIC_LABEL, Scan, Sensor,
};
use boresight_options::Described;
use serde::Serialize;
use serde_json::{Value, json};

fn detection(azimuth_rad: f32, range_m: f32) -> Detection {
    Detection { azimuth_rad, range_rate_mps: -3.0, range_m, rcs_dbsm: f32::NAN }
}

fn log() -> DriveLog {
    let scan = |time_s, sensor, detections: Vec<Detection>| {
        let labels = vec![STATIC_LABEL; detections.len()];
        Scan { time_s, sensor, detections, labels }
    };
    let sample = |time_s: f64, speed_mps, pose| MotionSample {
        time_s,
        yaw_rate_radps: 0.1,
        speed_mps,
        pose,
    };
    let pose = Pose { x_m: 1.0, y_m: -2.0, yaw_rad: std::f64::consts::PI };
    DriveLog {
        sensors: vec![
            Sensor { id: 3, mounting: Some(Mounting { x_m: 3.5, y_m: 0.5, yaw_rad: 0.0 }) },
            Sensor { id: 9, mounting: None },
        ],
        scans: vec![
            scan(-0.5, 3, vec![detection(0.5, 20.0), detection(-0.25, f32::NAN)]),
            scan(0.25, 9, vec![]),
        ],
        motion: vec![
            sample(-0.5, Some(10.0), Some(pose)),
            sample(0.0, None, None),
            sample(0.5, Some(f64::INFINITY), None),
        ],
    }
}

fn told(log: &DriveLog) -> (Vec<String>, Vec<Message>) {
    let mut topics = DriveTopics::new(log, |_| true).unwrap();
    let names = topics.channels().iter().map(|channel| channel.topic.clone()).collect();
    let mut out = vec![];
    topics.begin(&[Remark::new("a-code", "something to know")], &mut out);
    for scan in &log.scans {
        topics.scan(scan, None, &mut out);
    }
    topics.finish(&mut out);
    (names, out)
}

#[test]
fn a_drive_is_told_in_order_of_time_and_begins_at_zero() {
    let log = log();
    let (names, out) = told(&log);
    let seen: Vec<(&str, u64)> =
        out.iter().map(|message| (&*names[message.channel], message.time_ns)).collect();
    let expected = [
        ("/car/scene", 0),
        ("/radar/3/transform", 0),
        ("/log", 0),
        ("/car/transform", 0),
        ("/car/motion", 0),
        ("/radar/3/detections", 0),
        ("/car/motion", 500_000_000),
        ("/radar/9/detections", 750_000_000),
        ("/car/motion", 1_000_000_000),
    ];
    assert_eq!(seen, expected);
    let value = |at: usize| serde_json::from_slice::<Value>(&out[at].data).unwrap();
    assert_eq!(value(2)["message"], "something to know");
    let turn = &value(3)["rotation"];
    assert!(
        (turn["z"].as_f64().unwrap() - 1.0).abs() < 1e-15 && turn["w"].as_f64().unwrap() < 1e-15
    );
    // What is not known, or not finite, is left out: no field is null.
    let motion = json!({ "timestamp": { "sec": 0, "nsec": 500_000_000 }, "yawRateDegps": 0.1_f64.to_degrees() });
    assert_eq!(value(6), motion);
    assert!(value(8).get("speedMps").is_none());
    assert_eq!(value(4)["pose"], json!({ "xM": 1.0, "yM": -2.0, "yawDeg": 180.0 }));
}

#[test]
fn points_have_their_numbers_where_the_fields_say() {
    let scan = &log().scans[0];
    let cloud = cloud::point_cloud(scan, 7, Some(&[0.75]));
    assert_eq!((cloud.point_stride, cloud.frame_id.as_str()), (33, "radar_3"));
    assert_eq!(
        cloud.fields.iter().map(|field| field.offset).collect::<Vec<_>>(),
        [0, 4, 8, 12, 16, 20, 24, 28, 32]
    );
    let Base64(data) = &cloud.data;
    assert_eq!(data.len(), 66);
    let number = |point: usize, name: &str| {
        let field = cloud.fields.iter().find(|field| field.name == name).unwrap();
        let at = 33 * point + field.offset as usize;
        f32::from_le_bytes(data[at..at + 4].try_into().unwrap())
    };
    assert_eq!(number(0, "x"), (20.0 * 0.5_f64.cos()) as f32);
    assert_eq!(number(0, "y"), (20.0 * 0.5_f64.sin()) as f32);
    assert_eq!((number(0, "azimuth_rad"), number(1, "range_rate_mps")), (0.5, -3.0));
    assert!(number(1, "x").is_nan() && number(0, "rcs_dbsm").is_nan());
    // A weight that is not there counts as none.
    assert_eq!((number(0, "static_weight"), number(1, "static_weight")), (0.75, 0.0));
    assert_eq!((data[32], data[65]), (STATIC_LABEL, STATIC_LABEL));
    let written: Value = serde_json::from_slice(&encode(&cloud)).unwrap();
    assert_eq!(written["data"].as_str().unwrap().len(), 88);
    assert_eq!(written["timestamp"], json!({ "sec": 0, "nsec": 7 }));
}

#[test]
fn what_moves_is_drawn_as_far_as_it_moves_in_a_second() {
    let scan = Scan { detections: vec![detection(0.0, 20.0); 2], ..log().scans[0].clone() };
    let lines = |weights: &[f32], velocity| {
        scene::moving(&scan, 0, weights, velocity).entities[0].lines[0].points.clone()
    };
    // The radar drives at 10 m/s, and the range shrinks by 3 m/s: it drives ahead at 7 m/s.
    let points = lines(&[0.0, 1.0], Some([10.0, 0.0]));
    assert_eq!(points.iter().map(|point| point.x).collect::<Vec<_>>(), [20.0, 27.0]);
    assert!(lines(&[0.0, 0.0], None).is_empty());
    assert!(lines(&[], Some([10.0, 0.0])).is_empty());
}

#[test]
fn times_are_exact_to_the_nanosecond_and_checked() {
    let at = |time_s| {
        let scan = Scan { time_s, sensor: 1, detections: vec![], labels: vec![] };
        Clock::of(&DriveLog { scans: vec![scan], ..DriveLog::default() })
    };
    assert_eq!(at(5.0).unwrap().nanoseconds(0.123_456_789), 123_456_789);
    // The nearest double to a date's fraction.
    assert_eq!(at(1.7e9).unwrap().nanoseconds(1_700_000_000.25), 1_700_000_000_250_000_000);
    assert_eq!(at(-2.0).unwrap().nanoseconds(-1.5), 500_000_000);
    assert!(at(5e9).is_err() && at(-5e9).is_err());
    assert_eq!(Time::from(1_500_000_000), Time { sec: 1, nsec: 500_000_000 });
}

/// Of our own.
#[derive(Described, Serialize)]
struct Own {
    /// An angle.
    angle_rad: f64,
    /// Pairs.
    pairs: [[f64; 2]; 2],
    /// Perhaps.
    count: Option<u32>,
    /// Nothing for viewers.
    weights: Vec<f32>,
}

#[test]
fn our_own_messages_have_the_names_of_results_and_no_lists_in_lists() {
    let channel = own::<Own>("/own".into(), "boresight.Own", &["weights"]);
    let schema: Value = serde_json::from_str(&channel.schema).unwrap();
    assert_eq!(
        schema["properties"]["angleDeg"],
        json!({ "type": "number", "description": "An angle." })
    );
    let pairs = json!({ "type": "array", "items": { "type": "number" }, "description": "Pairs." });
    assert_eq!(schema["properties"]["pairs"], pairs);
    assert_eq!(
        (&schema["title"], &schema["required"]),
        (&json!("boresight.Own"), &json!(["pairs"]))
    );
    assert!(schema["properties"].get("weights").is_none());
    let value = Own {
        angle_rad: f64::INFINITY,
        pairs: [[1.0, 2.0], [3.0, 4.0]],
        count: None,
        weights: vec![1.0],
    };
    let written: Value = serde_json::from_slice(&encode_own(&value, &["weights"])).unwrap();
    assert_eq!(written, json!({ "pairs": [1.0, 2.0, 3.0, 4.0] }));
}

#[test]
fn a_file_holds_every_message_with_checksums_and_an_index() {
    let log = log();
    let (_, out) = told(&log);
    let topics = DriveTopics::new(&log, |_| true).unwrap();
    let mut file = vec![];
    let mut writer = McapWriter::new(&mut file, "", topics.channels()).unwrap();
    out.iter().for_each(|message| writer.write(message).unwrap());
    let stray = Message { channel: 99, ..out[0].clone() };
    assert!(writer.write(&stray).is_err());
    writer.finish().unwrap();

    let summary = mcap::Summary::read(&file).unwrap().unwrap();
    assert_eq!(summary.stats.unwrap().message_count, out.len() as u64);
    let read: Vec<_> = mcap::MessageStream::new(&file).unwrap().map(Result::unwrap).collect();
    assert_eq!(read.len(), out.len());
    for (read, told) in read.iter().zip(&out) {
        let channel = &topics.channels()[told.channel];
        assert_eq!((&read.channel.topic, read.log_time), (&channel.topic, told.time_ns));
        assert_eq!(read.data, told.data);
        assert_eq!(read.channel.schema.as_ref().unwrap().name, channel.schema_name);
    }
}

#[test]
fn an_output_that_is_full_is_an_error() {
    struct Full(usize);
    impl std::io::Write for Full {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            if self.0 == 0 {
                return Err(std::io::ErrorKind::StorageFull.into());
            }
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            Ok(taken)
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let log = log();
    let (_, out) = told(&log);
    let topics = DriveTopics::new(&log, |_| true).unwrap();
    for room in [0, 10, 100, 1000, 30_000] {
        let error = McapWriter::new(Full(room), "", topics.channels())
            .and_then(|mut writer| {
                for _ in 0..100 {
                    out.iter().try_for_each(|message| writer.write(message))?;
                }
                writer.finish()
            })
            .unwrap_err();
        assert!(error.to_string().starts_with("MCAP file cannot be written"), "{error}");
    }
}
