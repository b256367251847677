//! Makes a drive of what came of its topics.

use super::clock::Clock;
use super::frames::{Frames, Transform};
use super::motion::MotionTopic;
use super::topic::{Times, Topic};
use super::{DriveTopic, TopicUse};
use crate::drive_log::report::{DropReason, MountingSource, ReadReport};
use crate::drive_log::scans::sort_scans;
use crate::drive_log::{DriveFormat, DriveRead, motion};
use boresight_core::Remark;
use boresight_core::drive::{DriveLog, Scan, Sensor};
use std::collections::BTreeMap;

/// A drive that comes together.
pub(super) struct Drive {
    pub all: Vec<Topic>,
    pub frames: Frames,
    pub report: ReadReport,
    pub base: String,
}

impl Drive {
    pub fn read(mut self, radars: &[usize], motions: Option<(usize, Option<usize>)>) -> DriveRead {
        let of_motion = motions.into_iter().flat_map(|(one, other)| [Some(one), other]).flatten();
        let used: Vec<usize> = radars.iter().copied().chain(of_motion).collect();
        let firsts = used.iter().filter_map(|place| self.all.get(*place)?.first);
        let (clock, remark) = Clock::of_firsts(firsts);
        self.report.remarks.extend(remark);
        let start_ns = used
            .iter()
            .filter_map(|place| self.all.get(*place))
            .flat_map(|topic| {
                let scans = topic.scans.iter().map(|(times, _)| times);
                scans
                    .chain(topic.rows.iter().map(|(times, _)| times))
                    .map(move |times| (topic, times))
            })
            .map(|(topic, times)| clock.time_ns(topic, *times))
            .min()
            .unwrap_or(0);
        self.report.start_s = Some(start_ns as f64 / 1e9);
        let seconds = |topic: &Topic, times: Times| {
            clock.time_ns(topic, times).saturating_sub(start_ns) as f64 / 1e9
        };
        let mut log = DriveLog::default();
        let mut by_place = BTreeMap::new();
        for (&place, id) in radars.iter().zip(1..=u8::MAX) {
            by_place.insert(place, id);
            let Some(topic) = self.all.get_mut(place) else { continue };
            let scans = std::mem::take(&mut topic.scans);
            let turn = if topic.is_in_degrees() { 1.0_f32.to_radians() } else { 1.0 };
            let frame = topic.frame.clone().unwrap_or_default();
            let mounting = self.frames.between(&frame, &self.base).map(|t| t.mounting());
            let is_down = mounting.is_some_and(|(_, down)| down);
            let sign = if is_down { -turn } else { turn };
            log.sensors.push(Sensor { id, mounting: mounting.map(|(mounting, _)| mounting) });
            self.report.detections += topic.detections;
            self.report.incomplete += topic.incomplete;
            self.report.drop_many(DropReason::NotFinite, topic.not_finite);
            for (times, mut detections) in scans {
                for detection in &mut detections {
                    detection.azimuth_rad *= sign;
                }
                let time_s = seconds(topic, times);
                log.scans.push(Scan { time_s, sensor: id, detections, labels: vec![] });
            }
            if let Some((_, true)) = mounting {
                self.remark("upside-down", place, "hangs upside down; its azimuths are mirrored");
            }
            if frame.trim_start_matches('/') == self.base {
                let text = format!(
                    "has its detections in the car's frame {}, in which no mounting angle can be told",
                    self.base
                );
                self.remark("car-frame", place, &text);
            }
        }
        sort_scans(&mut log.scans);
        log.scans.dedup_by(|next, scan| {
            let is_same = next.time_s == scan.time_s && next.sensor == scan.sensor;
            if is_same {
                scan.detections.append(&mut next.detections);
            }
            is_same
        });
        if log.sensors.iter().any(|sensor| sensor.mounting.is_some()) {
            self.report.mountings = Some(MountingSource::TfStatic);
        }
        if let Some((one, other)) = motions {
            let topic =
                |place: usize| self.all.get(place).map(|topic| self.motion_topic(topic, seconds));
            let speeds = topic(one);
            let samples = match (other.and_then(topic), &speeds) {
                (Some(rates), speeds) => rates.joined(speeds.as_ref()),
                (None, Some(only)) => only.joined(None),
                (None, None) => vec![],
            };
            let has_speed = speeds.is_some_and(|speeds| speeds.has_speed);
            for sample in samples {
                // They are in order.
                let _ = motion::push(&mut log.motion, &mut self.report, sample, String::new);
            }
            let lacks = log.motion.iter().filter(|s| has_speed && s.speed_mps.is_none()).count();
            self.report.motion_incomplete += lacks as u64;
        }
        self.same_frames(radars);
        let told = self.all.iter().enumerate();
        self.report.topics = told
            .map(|(place, topic)| self.tell(topic, by_place.get(&place).copied(), &clock))
            .collect();
        let lost: u64 = self.all.iter().map(|topic| topic.unreadable).sum();
        if lost > 0 {
            let text = format!("messages that could not be decoded: {lost}");
            self.report.remarks.push(Remark::new("unreadable-messages", text));
        }
        DriveRead { log, report: self.report, format: DriveFormat::Mcap }
    }

    fn remark(&mut self, code: &'static str, place: usize, text: &str) {
        let name = self.all.get(place).map_or("", |topic| &topic.name);
        self.report.remarks.push(Remark::new(code, format!("{name} {text}")));
    }

    fn motion_topic<'a>(
        &'a self,
        topic: &'a Topic,
        seconds: impl Fn(&Topic, Times) -> f64,
    ) -> MotionTopic<'a> {
        let has_speed = topic.motion().is_some_and(|motion| motion.has_speed());
        let mut rows: Vec<_> =
            topic.rows.iter().map(|(times, row)| (seconds(topic, *times), row)).collect();
        boresight_math::order::sort_ascending(&mut rows, |row| row.0);
        // An odometer tells its rates in the car's frame.
        let frame = topic.frame.as_deref().filter(|_| !has_speed);
        let turned = frame.and_then(|frame| self.frames.between(frame, &self.base));
        let upwards = turned.map_or([0.0, 0.0, 1.0], |Transform { rotation, .. }| rotation[2]);
        MotionTopic { rows, upwards, has_speed }
    }

    /// Says which topics may be of one radar.
    fn same_frames(&mut self, radars: &[usize]) {
        let mut by_frame: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for topic in radars.iter().filter_map(|place| self.all.get(*place)) {
            if let Some(frame) = topic.frame.as_deref().filter(|frame| !frame.is_empty()) {
                by_frame.entry(frame).or_default().push(&topic.name);
            }
        }
        for (frame, names) in by_frame.into_iter().filter(|(_, names)| names.len() > 1) {
            let text = format!(
                "{} are in one frame, {frame}: they may be of one radar, and count as several unless one is named",
                names.join(" and ")
            );
            self.report.remarks.push(Remark::new("same-frame", text));
        }
    }

    fn tell(&self, topic: &Topic, sensor: Option<u8>, clock: &Clock) -> DriveTopic {
        let (used_as, note) = match (&topic.refused, topic.motion()) {
            (Some(why), _) => (TopicUse::Unused, why.clone()),
            (None, Some(motion)) => (TopicUse::Motion, motion.words().into()),
            (None, None) if topic.is_transforms() => {
                (TopicUse::Mountings, "fixed transforms".into())
            }
            (None, None) => {
                let used = if topic.is_tracks() { TopicUse::Tracks } else { TopicUse::Radar };
                (used, self.note(topic))
            }
        };
        let mut note = note;
        if topic.unreadable > 0 {
            note += &format!("; of a message that could not be decoded: {}", topic.why_unreadable);
        }
        let is_timed = sensor.is_some() || used_as == TopicUse::Motion;
        DriveTopic {
            name: topic.name.clone(),
            message_type: topic.message_type.clone(),
            messages: topic.messages,
            unreadable: topic.unreadable,
            used_as,
            sensor,
            clock: is_timed.then(|| clock.of(topic)),
            note,
        }
    }

    /// What is read of a radar's topic.
    fn note(&self, topic: &Topic) -> String {
        let mut note = match &topic.frame {
            Some(frame) if self.frames.between(frame, &self.base).is_some() => {
                format!("in the frame {frame}")
            }
            Some(frame) => format!("in the frame {frame}, which has no transform to {}", self.base),
            None => "in no named frame".into(),
        };
        if topic.is_tracks() {
            note +=
                "; tracks are filtered, and their velocities are taken as relative to the radar";
        }
        if topic.is_in_degrees() {
            note += "; azimuths are in degrees";
        }
        if topic.is_mirrored() {
            note += "; azimuths are positive to the right by the text of the messages";
        }
        note
    }
}
