//! The messages of a drive, in order of time.

use super::messages::{FrameTransform, Log, LogLevel, PointCloud, SceneUpdate, Time};
use super::typed::{encode, encode_own, known, own};
use super::{Channel, Clock, Message, cloud, scene, transform};
use boresight_core::drive::{DriveLog, MotionSample, Mounting, Pose, Scan, Sensor};
use boresight_core::{InputError, Remark};
use boresight_options::Described;
use serde::Serialize;

/// The topic of a radar.
#[must_use]
pub fn topic(sensor: u8, what: &str) -> String {
    format!("/radar/{sensor}/{what}")
}

/// The car's motion, as its sensors report it.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct CarMotion {
    /// When it was measured.
    pub timestamp: Time,
    /// Yaw rate, positive to the left, with whatever bias and scale error the sensor has.
    pub yaw_rate_radps: f64,
    /// Forward speed of the rear axle, negative in reverse; absent where there is none.
    pub speed_mps: Option<f64>,
    /// Where the rear axle is in the log's global frame; absent where that is not known.
    pub pose: Option<Pose>,
}

/// Channels of a radar, by their places.
#[derive(Debug, Clone, Copy)]
struct Places {
    sensor: u8,
    detections: usize,
    transform: usize,
}

/// Makes messages of a drive. Scans are handed in one after the other; what the car did until then comes before them.
#[derive(Debug, Clone)]
pub struct DriveTopics<'a> {
    log: &'a DriveLog,
    clock: Clock,
    channels: Vec<Channel>,
    radars: Vec<Places>,
    car: [usize; 3],
    log_lines: usize,
    /// Motion samples told.
    told: usize,
}

impl<'a> DriveTopics<'a> {
    /// Of a log and its radars that `wanted` picks by number.
    ///
    /// # Errors
    /// Those of [`Clock::of`].
    pub fn new(log: &'a DriveLog, wanted: impl Fn(u8) -> bool) -> Result<Self, InputError> {
        let clock = Clock::of(log)?;
        let mut channels: Vec<Channel> = vec![];
        let mut add = |channel| {
            channels.push(channel);
            channels.len() - 1
        };
        let radars = log
            .sensors
            .iter()
            .filter(|sensor| wanted(sensor.id))
            .map(|&Sensor { id, .. }| Places {
                sensor: id,
                detections: add(known::<PointCloud>(
                    topic(id, "detections"),
                    "foxglove.PointCloud",
                )),
                transform: add(transform_channel(topic(id, "transform"))),
            })
            .collect();
        let car = [
            add(transform_channel("/car/transform".into())),
            add(own::<CarMotion>("/car/motion".into(), "boresight.CarMotion", &[])),
            add(known::<SceneUpdate>("/car/scene".into(), "foxglove.SceneUpdate").lasting()),
        ];
        let log_lines = add(known::<Log>("/log".into(), "foxglove.Log"));
        Ok(Self { log, clock, channels, radars, car, log_lines, told: 0 })
    }

    /// The channels so far.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Adds a channel; its place.
    pub fn add_channel(&mut self, channel: Channel) -> usize {
        self.channels.push(channel);
        self.channels.len() - 1
    }

    /// The log's times as those of messages.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// First and last time of the drive, ns; zero for none.
    #[must_use]
    pub fn span_ns(&self) -> [u64; 2] {
        let ends = |first: Option<f64>, last: Option<f64>| first.into_iter().chain(last);
        let scans = ends(
            self.log.scans.first().map(|scan| scan.time_s),
            self.log.scans.last().map(|scan| scan.time_s),
        );
        let motion = ends(
            self.log.motion.first().map(|sample| sample.time_s),
            self.log.motion.last().map(|sample| sample.time_s),
        );
        let times = scans.chain(motion).map(|time_s| self.clock.nanoseconds(time_s));
        let span = times.fold(None, |span: Option<[u64; 2]>, t| {
            Some(span.map_or([t, t], |[a, b]| [a.min(t), b.max(t)]))
        });
        span.unwrap_or_default()
    }

    /// Begins anew: what is true from the start of the drive, with a line for each remark on it.
    pub fn begin(&mut self, remarks: &[Remark], out: &mut Vec<Message>) {
        self.told = 0;
        let [time_ns, _] = self.span_ns();
        let scene = scene::car(self.log, time_ns);
        self.push(self.car[2], time_ns, encode(&scene), out);
        for &Sensor { id, mounting } in &self.log.sensors {
            if let Some(mounting) = mounting {
                self.mounting(id, &mounting, time_ns, out);
            }
        }
        for remark in remarks {
            self.line(time_ns, LogLevel::Warning, "drive".into(), remark.message.clone(), out);
        }
    }

    /// A radar's place on the car.
    pub fn mounting(&self, sensor: u8, on: &Mounting, time_ns: u64, out: &mut Vec<Message>) {
        let radar = self.radars.iter().find(|radar| radar.sensor == sensor);
        if let (Some(radar), Some(told)) = (radar, transform::of_radar(sensor, on, time_ns)) {
            self.push(radar.transform, time_ns, encode(&told), out);
        }
    }

    /// A line of the log.
    pub fn line(
        &self,
        time_ns: u64,
        level: LogLevel,
        name: String,
        message: String,
        out: &mut Vec<Message>,
    ) {
        let timestamp = Time::from(time_ns);
        let line = Log { timestamp, level, message, name, file: String::new(), line: 0 };
        self.push(self.log_lines, time_ns, encode(&line), out);
    }

    /// What the car did until a scan, and the scan; `weights` as [`cloud::point_cloud`] has them. A scan of a radar that is not
    /// wanted is not told.
    pub fn scan(&mut self, scan: &Scan, weights: Option<&[f32]>, out: &mut Vec<Message>) {
        self.motion_until(scan.time_s, out);
        if let Some(radar) = self.radars.iter().find(|radar| radar.sensor == scan.sensor) {
            let time_ns = self.clock.nanoseconds(scan.time_s);
            let cloud = cloud::point_cloud(scan, time_ns, weights);
            self.push(radar.detections, time_ns, encode(&cloud), out);
        }
    }

    /// What the car did after the last scan.
    pub fn finish(&mut self, out: &mut Vec<Message>) {
        self.motion_until(f64::INFINITY, out);
    }

    fn motion_until(&mut self, time_s: f64, out: &mut Vec<Message>) {
        let log = self.log;
        while let Some(sample) = log.motion.get(self.told).filter(|s| s.time_s <= time_s) {
            self.told += 1;
            self.motion(sample, out);
        }
    }

    fn motion(&self, sample: &MotionSample, out: &mut Vec<Message>) {
        let MotionSample { time_s, yaw_rate_radps, speed_mps, pose } = *sample;
        let time_ns = self.clock.nanoseconds(time_s);
        let [place, motion, _] = self.car;
        if let Some(told) = pose.and_then(|pose| transform::of_car(&pose, time_ns)) {
            self.push(place, time_ns, encode(&told), out);
        }
        let timestamp = Time::from(time_ns);
        let told = CarMotion { timestamp, yaw_rate_radps, speed_mps, pose };
        self.push(motion, time_ns, encode_own(&told, &[]), out);
    }

    fn push(&self, channel: usize, time_ns: u64, data: Vec<u8>, out: &mut Vec<Message>) {
        out.push(Message { channel, time_ns, data });
    }
}

fn transform_channel(topic: String) -> Channel {
    known::<FrameTransform>(topic, "foxglove.FrameTransform").lasting()
}
