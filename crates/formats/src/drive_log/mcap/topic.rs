//! One topic while its messages come.

use super::cloud::{Cloud, CloudPaths, JsonCloud};
use super::frames::{Frames, TransformPaths};
use super::list::ListPaths;
use super::motion::{MotionPaths, MotionRow};
use super::quantity::Layout;
use crate::mcap::{Channel, Message, Schema};
use crate::ros::{Definitions, Encoding, Value, decode};
use boresight_core::drive::Detection;
use std::f32::consts::TAU;

/// A time by both clocks, ns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Times {
    pub log_ns: i64,
    /// The stamp in the header; none where it is zero or missing.
    pub stamp_ns: Option<i64>,
}

/// A topic, what is known of its messages, and what came of them.
pub(super) struct Topic {
    pub name: String,
    pub message_type: String,
    reader: Reader,
    decoder: Option<Decoder>,
    /// Why it is not read, where it is not.
    pub refused: Option<String>,
    pub messages: u64,
    pub unreadable: u64,
    pub why_unreadable: &'static str,
    pub scans: Vec<(Times, Vec<Detection>)>,
    pub rows: Vec<(Times, MotionRow)>,
    /// The frame that its latest message is in.
    pub frame: Option<String>,
    /// Of the message that came first.
    pub first: Option<Times>,
    pub detections: u64,
    pub not_finite: u64,
    pub incomplete: u64,
    largest_azimuth: f32,
    last_point: f64,
}

/// How messages become values, and where their time and frame are.
struct Decoder {
    definitions: Definitions,
    encoding: Encoding,
    stamp: Option<[Vec<usize>; 2]>,
    frame: Option<Vec<usize>>,
}

/// What is read of messages.
enum Reader {
    None,
    List { paths: ListPaths, tracks: bool },
    Cloud(CloudPaths),
    JsonCloud,
    Motion(MotionPaths),
    Transforms(TransformPaths),
}

impl Topic {
    /// By the type of its messages.
    pub fn new(channel: &Channel, schema: Option<&Schema>) -> Self {
        let (decoder, read) = reader(channel, schema);
        let (reader, refused) = match read {
            Ok(reader) => (reader, None),
            Err(why) => (Reader::None, Some(why)),
        };
        Self {
            name: channel.topic.clone(),
            message_type: schema.map(|schema| schema.name.clone()).unwrap_or_default(),
            reader,
            decoder,
            refused,
            messages: 0,
            unreadable: 0,
            why_unreadable: "",
            scans: vec![],
            rows: vec![],
            frame: None,
            first: None,
            detections: 0,
            not_finite: 0,
            incomplete: 0,
            largest_azimuth: 0.0,
            last_point: f64::NEG_INFINITY,
        }
    }

    /// Whether it has detections, or tracks.
    pub fn is_radar(&self) -> bool {
        matches!(self.reader, Reader::List { .. } | Reader::Cloud(_) | Reader::JsonCloud)
    }

    /// Whether its detections are tracks.
    pub fn is_tracks(&self) -> bool {
        matches!(self.reader, Reader::List { tracks: true, .. })
    }

    /// What its motion has.
    pub fn motion(&self) -> Option<&MotionPaths> {
        match &self.reader {
            Reader::Motion(paths) => Some(paths),
            _ => None,
        }
    }

    /// Whether it has poses.
    pub fn has_pose(&self) -> bool {
        self.motion().is_some_and(MotionPaths::has_pose)
    }

    /// Whether it says where radars sit.
    pub fn is_transforms(&self) -> bool {
        matches!(self.reader, Reader::Transforms(_))
    }

    /// Does without it.
    pub fn refuse(&mut self, why: impl Into<String>) {
        self.reader = Reader::None;
        self.refused = Some(why.into());
        self.scans = vec![];
        self.rows = vec![];
    }

    /// Whether azimuths go beyond one turn in radians, so that they are degrees.
    pub fn is_in_degrees(&self) -> bool {
        self.largest_azimuth > TAU && matches!(self.reader, Reader::List { .. })
    }

    /// Whether azimuths are positive to the right by the text of its messages.
    pub fn is_mirrored(&self) -> bool {
        matches!(&self.reader, Reader::List { paths, .. } if paths.is_mirrored())
    }

    /// Takes a message; whether more are wanted.
    pub fn take(&mut self, message: Message<'_>, frames: &mut Frames) -> bool {
        match self.read(message, frames) {
            Ok(()) => {}
            Err(Unread::Message(why)) => {
                self.unreadable += 1;
                self.why_unreadable = why;
            }
            Err(Unread::Topic(why)) => self.refuse(why),
        }
        self.refused.is_none()
    }

    fn read(&mut self, message: Message<'_>, frames: &mut Frames) -> Result<(), Unread> {
        let log_ns = i64::try_from(message.log_time_ns).unwrap_or(i64::MAX);
        if matches!(self.reader, Reader::JsonCloud) {
            let cloud = JsonCloud::read(message.data).ok_or("it is no foxglove.PointCloud")?;
            let data = cloud.data().ok_or("its data are no base64")?;
            self.saw(Times { log_ns, stamp_ns: cloud.time_ns() }, Some(&cloud.frame_id));
            let points = cloud.cloud(&data).ok_or("its points are not in its data")?;
            return self.take_cloud(Times { log_ns, stamp_ns: cloud.time_ns() }, &points);
        }
        let Some(decoder) = &self.decoder else { return Ok(()) };
        let value = decode(&decoder.definitions, message.data, decoder.encoding)?;
        let times = Times { log_ns, stamp_ns: decoder.stamp_ns(&value) };
        let frame = decoder.frame.as_ref().and_then(|path| value.text(path)).map(str::to_owned);
        self.saw(times, frame.as_deref());
        match &self.reader {
            Reader::None | Reader::JsonCloud => Ok(()),
            Reader::Transforms(paths) => {
                frames.take(paths, &value);
                Ok(())
            }
            Reader::Motion(paths) => {
                self.rows.push((times, paths.read(&value)));
                Ok(())
            }
            Reader::Cloud(paths) => {
                let points = paths.read(&value).ok_or("its points are not in its data")?;
                self.take_cloud(times, &points)
            }
            Reader::List { paths, .. } => {
                // Of messages with one detection each, those of one scan are together.
                let point = paths.point(&value);
                let goes_on = paths.is_single()
                    && match point {
                        Some(point) => point > self.last_point,
                        None => self
                            .scans
                            .last()
                            .is_some_and(|(last, _)| last.stamp_ns == times.stamp_ns),
                    };
                self.last_point = point.unwrap_or(0.0);
                let mut taken = Taken::default();
                let found = paths.detections(&value).filter_map(|detection| {
                    taken.note(detection, |detection| paths.is_incomplete(detection))
                });
                match self.scans.last_mut().filter(|_| goes_on) {
                    Some((_, scan)) => scan.extend(found),
                    None => {
                        let found = found.collect();
                        self.scans.push((times, found));
                    }
                }
                self.count(taken);
                Ok(())
            }
        }
    }

    fn saw(&mut self, times: Times, frame: Option<&str>) {
        self.first.get_or_insert(times);
        if let Some(frame) = frame
            && self.frame.as_deref() != Some(frame)
        {
            self.frame = Some(frame.to_owned());
        }
    }

    fn take_cloud(&mut self, times: Times, cloud: &Cloud<'_>) -> Result<(), Unread> {
        let layout: &Layout = &cloud.layout;
        if let Some(lack) = layout.lacks() {
            return Err(Unread::Topic(format!("its points have {lack}")));
        }
        let mut taken = Taken::default();
        let found = cloud.points().filter_map(|number| {
            taken.note(layout.detection(number, false), |d| layout.is_incomplete(d))
        });
        let found = found.collect();
        self.scans.push((times, found));
        self.count(taken);
        Ok(())
    }

    fn count(&mut self, taken: Taken) {
        self.detections += taken.detections;
        self.not_finite += taken.not_finite;
        self.incomplete += taken.incomplete;
        self.largest_azimuth = self.largest_azimuth.max(taken.largest_azimuth);
    }
}

/// Why a message, or all of a topic, is not read.
enum Unread {
    Message(&'static str),
    Topic(String),
}

impl From<&'static str> for Unread {
    fn from(why: &'static str) -> Self {
        Self::Message(why)
    }
}

/// What was met in the detections of a message.
#[derive(Default)]
struct Taken {
    detections: u64,
    not_finite: u64,
    incomplete: u64,
    largest_azimuth: f32,
}

impl Taken {
    fn note(
        &mut self,
        detection: Option<Detection>,
        is_incomplete: impl Fn(&Detection) -> bool,
    ) -> Option<Detection> {
        self.detections += 1;
        match &detection {
            None => self.not_finite += 1,
            Some(detection) => {
                self.incomplete += u64::from(is_incomplete(detection));
                self.largest_azimuth = self.largest_azimuth.max(detection.azimuth_rad.abs());
            }
        }
        detection
    }
}

impl Decoder {
    fn new(definitions: Definitions, encoding: Encoding) -> Self {
        let path = |name: &str| definitions.path(0, name);
        let stamp = ["header.stamp", "stamp"].into_iter().find_map(|stamp| {
            Some([path(&format!("{stamp}.sec"))?, path(&format!("{stamp}.nanosec"))?])
        });
        Self { stamp, frame: path("header.frame_id"), definitions, encoding }
    }

    fn stamp_ns(&self, message: &Value<'_>) -> Option<i64> {
        let [seconds, nanoseconds] = self.stamp.as_ref()?;
        let seconds = message.number(seconds)? as i64;
        let stamp = seconds.checked_mul(1_000_000_000)? + message.number(nanoseconds)? as i64;
        Some(stamp).filter(|stamp| *stamp != 0)
    }
}

/// How messages of a channel are decoded and what is read of them, or why nothing is.
fn reader(channel: &Channel, schema: Option<&Schema>) -> (Option<Decoder>, Result<Reader, String>) {
    let Some(schema) = schema else {
        return (None, Err("its messages have no schema".into()));
    };
    if schema.name == "foxglove.PointCloud" && channel.encoding == "json" {
        return (None, Ok(Reader::JsonCloud));
    }
    let Some(encoding) = Encoding::of_names(&channel.encoding, &schema.encoding) else {
        let Channel { encoding, .. } = channel;
        let why = format!(
            "its messages are encoded as {encoding:?} with a schema in {:?}; read are cdr with ros2msg and ros1 with \
             ros1msg",
            schema.encoding
        );
        return (None, Err(why));
    };
    let Some(definitions) = Definitions::parse(&schema.data) else {
        return (None, Err("the definition of its type cannot be read".into()));
    };
    let read = if let Some(paths) = TransformPaths::of(&definitions) {
        let is_static = channel.topic.ends_with("tf_static");
        let why = "transforms that change; the places of radars are in tf_static";
        if is_static { Ok(Reader::Transforms(paths)) } else { Err(why.into()) }
    } else if let Some(paths) = CloudPaths::of(&definitions) {
        Ok(Reader::Cloud(paths))
    } else if let Some(paths) = MotionPaths::of(&definitions) {
        Ok(Reader::Motion(paths))
    } else {
        let tracks = ["Track", "Object"].iter().any(|part| schema.name.contains(part));
        ListPaths::of(&definitions, &schema.data)
            .map(|paths| Reader::List { paths, tracks })
            .map_err(Into::into)
    };
    (Some(Decoder::new(definitions, encoding)), read)
}
