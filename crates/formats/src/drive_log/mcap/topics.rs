//! Which topics a recording has, and what each is used for.

use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Which topics of a recording are read.
#[derive(Debug, Clone, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct TopicOptions {
    /// Topics of radars in an MCAP file; by default all with detections, and those with tracks where there are no others.
    pub radar_topics: Vec<String>,
    /// Topics of the car's motion in an MCAP file; by default one with the speed, and one with the yaw rate alone if there is one.
    pub motion_topics: Vec<String>,
    /// Frame of the car, centred on the rear axle, in which an MCAP file states where radars sit; base_link by default.
    pub base_frame: Option<String>,
}

/// What a topic of a recording is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TopicUse {
    /// The detections of a radar.
    Radar,
    /// The tracks of a radar: filtered, and fewer.
    Tracks,
    /// The car's motion.
    Motion,
    /// Where radars sit.
    Mountings,
    /// Nothing.
    Unused,
}

/// Which clock tells the times of a topic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TopicClock {
    /// The stamp in the header of each message.
    Stamp,
    /// When each message was recorded.
    LogTime,
}

/// A topic of a recording.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct DriveTopic {
    /// Its name.
    pub name: String,
    /// The type of its messages.
    pub message_type: String,
    /// Messages on it.
    pub messages: u64,
    /// Messages of it that could not be decoded.
    pub unreadable: u64,
    /// What it is used for.
    pub used_as: TopicUse,
    /// Number of the radar, of a topic with one.
    pub sensor: Option<u8>,
    /// The clock of its times, of a topic that is used.
    pub clock: Option<TopicClock>,
    /// What is read of it, or why it is not used.
    pub note: String,
}
