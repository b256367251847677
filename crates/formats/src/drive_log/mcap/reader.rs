//! Takes the bytes of recordings, and gives the drive in them.

use super::choice::{choose_motions, choose_radars};
use super::drive::Drive;
use super::frames::Frames;
use super::topic::Topic;
use super::{BASE_FRAME, TopicOptions};
use crate::drive_log::{DriveRead, ReadReport};
use crate::error::FormatError;
use crate::mcap::{Channel, McapSink, McapStream, Message, Schema};
use boresight_core::Remark;
use std::collections::BTreeMap;
use std::io::Read;

/// Bytes read from a file at a time.
const PIECE: usize = 1 << 20;

/// Reads a drive from the bytes of an MCAP file as they come, or from several files that are parts of one
/// recording. Beside the drive itself it holds one chunk of a file at most.
#[derive(Default)]
pub struct McapDriveReader {
    stream: McapStream,
    topics: Topics,
    remarks: Vec<Remark>,
    any: bool,
}

#[derive(Default)]
struct Topics {
    options: TopicOptions,
    all: Vec<Topic>,
    by_channel: BTreeMap<u16, usize>,
    frames: Frames,
}

impl McapSink for Topics {
    fn channel(&mut self, channel: &Channel, schema: Option<&Schema>) -> bool {
        let kind = schema.map_or("", |schema| &schema.name);
        let known = self
            .all
            .iter()
            .position(|topic| topic.name == channel.topic && topic.message_type == kind);
        let place = known.unwrap_or_else(|| {
            let mut topic = Topic::new(channel, schema);
            self.options.keep_named(&mut topic);
            self.all.push(topic);
            self.all.len() - 1
        });
        self.by_channel.insert(channel.id, place);
        self.all.get(place).is_some_and(|topic| topic.refused.is_none())
    }

    fn message(&mut self, message: Message<'_>) -> bool {
        let place = self.by_channel.get(&message.channel);
        let topic = place.and_then(|place| self.all.get_mut(*place));
        topic.is_some_and(|topic| topic.take(message, &mut self.frames))
    }
}

impl TopicOptions {
    /// Does without a topic where others are named.
    fn keep_named(&self, topic: &mut Topic) {
        let named = if topic.is_radar() {
            &self.radar_topics
        } else if topic.motion().is_some() {
            &self.motion_topics
        } else {
            return;
        };
        if !named.is_empty() && !named.contains(&topic.name) {
            topic.refuse("others are named");
        }
    }
}

impl McapDriveReader {
    /// A reader of some topics.
    pub fn new(options: TopicOptions) -> Self {
        Self { topics: Topics { options, ..Topics::default() }, ..Self::default() }
    }

    /// Takes the next bytes.
    ///
    /// # Errors
    /// [`FormatError::Binary`] where the file does not begin as MCAP does.
    pub fn push(&mut self, bytes: &[u8]) -> Result<(), FormatError> {
        self.any |= !bytes.is_empty();
        self.stream.push(bytes, &mut self.topics)
    }

    /// Takes a whole file.
    ///
    /// # Errors
    /// As [`Self::push`], or those of the file.
    pub fn push_all(
        &mut self,
        mut file: impl Read,
    ) -> Result<Result<(), FormatError>, std::io::Error> {
        let mut piece = vec![0; PIECE];
        loop {
            let count = file.read(&mut piece)?;
            if count == 0 {
                return Ok(Ok(()));
            }
            if let Err(error) = self.push(piece.get(..count).unwrap_or_default()) {
                return Ok(Err(error));
            }
        }
    }

    /// Ends a file; what comes next is the next part of the recording.
    pub fn end_file(&mut self) {
        if !std::mem::take(&mut self.any) {
            return;
        }
        let mut stream = std::mem::take(&mut self.stream);
        self.remarks.extend(stream.finish(&mut self.topics).remarks());
        for (channel, _, messages) in stream.channels() {
            let place = self.topics.by_channel.get(&channel.id).copied();
            if let Some(topic) = place.and_then(|place| self.topics.all.get_mut(place)) {
                topic.messages += messages;
            }
        }
        self.topics.by_channel.clear();
    }

    /// What was taken so far; what comes next is of another drive, of the same topics.
    pub fn take(&mut self) -> Self {
        std::mem::replace(self, Self::new(self.topics.options.clone()))
    }

    /// The drive.
    ///
    /// # Errors
    /// [`FormatError::NoDriveLog`] where no topic has detections, [`FormatError::Topic`] where one that is
    /// named is not there or has none.
    pub fn finish(mut self) -> Result<DriveRead, FormatError> {
        self.end_file();
        let Self { topics: Topics { options, mut all, frames, .. }, remarks, .. } = self;
        boresight_math::order::sort_by(&mut all, |a, b| {
            (&a.name, &a.message_type).cmp(&(&b.name, &b.message_type))
        });
        let lost = remarks.iter().map(|remark| &*remark.message);
        let lost = lost.collect::<Vec<_>>().join("; ");
        let radars = choose_radars(&options, &mut all, &lost)?;
        let motions = choose_motions(&options, &mut all)?;
        let mut drive = Drive { all, frames, report: ReadReport::default(), base: String::new() };
        drive.base = options.base_frame.unwrap_or_else(|| BASE_FRAME.into());
        drive.report.remarks = remarks;
        Ok(drive.read(&radars, motions))
    }
}

/// Reads a drive from a whole MCAP file in memory.
///
/// # Errors
/// Those of [`McapDriveReader`].
pub fn read(bytes: &[u8], options: TopicOptions) -> Result<DriveRead, FormatError> {
    let mut reader = McapDriveReader::new(options);
    reader.push(bytes)?;
    reader.finish()
}
