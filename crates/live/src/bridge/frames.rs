//! Frames out of packets that are lost, come twice or in another order.

use super::packet::Packet;
use crate::error::LiveError;
use boresight_options::Described;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// How long a packet that is missing is waited for, in packets behind the newest.
const REORDER_PACKETS: u32 = 64;
/// A number this far behind the newest is that of a card that was started again.
const RESTART_PACKETS: u32 = 1024;
/// So is one this far ahead: a gigabyte and more was not lost on a cable.
const JUMP_PACKETS: u32 = 1 << 20;
/// Most samples that UDP carries in a packet.
const MOST_SAMPLES: u64 = 65_507;
/// Most bytes of a frame.
const MOST_FRAME_BYTES: u64 = 64 << 20;

/// What came and what did not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Counts {
    /// Packets of the card, each once.
    pub packets: u64,
    /// Bytes of their samples.
    pub bytes: u64,
    /// Packets that did not come.
    pub lost_packets: u64,
    /// Bytes of samples that did not come.
    pub lost_bytes: u64,
    /// Packets that came after a later one.
    pub reordered: u64,
    /// Packets that had come before.
    pub duplicates: u64,
    /// Packets that no card sends: too short, or with numbers that contradict each other.
    pub malformed: u64,
    /// Packets from other senders than the card, dropped.
    pub foreign: u64,
    /// How often the card began anew.
    pub restarts: u64,
    /// Whole frames.
    pub frames: u64,
    /// Frames that lack bytes and were dropped.
    pub damaged_frames: u64,
}

/// A whole frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// Counted from 0 since the card was started.
    pub number: u64,
    /// Samples as a recording has them.
    pub samples: Vec<u8>,
}

/// A frame of which some is there.
struct Part {
    samples: Vec<u8>,
    filled: usize,
}

/// Puts packets together to frames, by the place of their bytes since the card was started: a loss costs the frames
/// that it is in, and no other is shifted.
pub struct FrameAssembler {
    frame_bytes: u64,
    counts: Counts,
    parts: BTreeMap<u64, Part>,
    run: Option<Run>,
}

/// Since the card was started, or since its first packet that came.
struct Run {
    newest: u32,
    /// Numbers below the newest that have not come, as far back as a restart is told from them.
    missing: BTreeSet<u32>,
    /// Where the first packet began and the newest ends.
    begin: u64,
    end: u64,
    /// Bytes that came.
    bytes: u64,
    /// Packets and bytes lost in runs before this one.
    lost_before: (u64, u64),
    packets: u64,
    first: u32,
    /// The first frame that is not given out or given up yet.
    next: u64,
    /// Bytes before the newest that are still waited for.
    window: u64,
}

impl FrameAssembler {
    /// For frames of a size.
    ///
    /// # Errors
    /// [`LiveError::FrameSize`] for none and for more than 64 MiB.
    pub fn new(frame_bytes: u64) -> Result<Self, LiveError> {
        if frame_bytes == 0 || frame_bytes > MOST_FRAME_BYTES {
            let expected = format!("1 to {MOST_FRAME_BYTES}");
            return Err(LiveError::FrameSize { expected, given: frame_bytes });
        }
        Ok(Self { frame_bytes, counts: Counts::default(), parts: BTreeMap::new(), run: None })
    }

    /// What came so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Takes what came as a packet and gives the frames that it completes, in order.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Frame> {
        let Some(packet) = Packet::read(bytes) else {
            self.counts.malformed += 1;
            return vec![];
        };
        if !self.admit(&packet) {
            return vec![];
        }
        self.counts.packets += 1;
        self.counts.bytes += packet.samples.len() as u64;
        self.put(&packet);
        self.settle()
    }

    /// Counts a packet from another sender than the card.
    pub(super) fn count_foreign(&mut self) {
        self.counts.foreign += 1;
    }

    /// Ends the run: what is not whole is given up.
    pub fn finish(&mut self) {
        self.counts.damaged_frames += self.parts.len() as u64;
        self.parts.clear();
        self.run = None;
    }

    /// Whether a packet is new, with all that its number says.
    fn admit(&mut self, packet: &Packet<'_>) -> bool {
        let end = packet.offset.saturating_add(packet.samples.len() as u64);
        if let Some(run) = &mut self.run {
            let behind = run.newest.saturating_sub(packet.sequence);
            let ahead = packet.sequence.saturating_sub(run.newest);
            let first = packet.sequence <= 1 && behind > REORDER_PACKETS;
            let again = behind > RESTART_PACKETS || ahead > JUMP_PACKETS || first;
            if again {
                self.counts.restarts += 1;
                self.finish();
            } else if packet.sequence > run.newest {
                let between = u64::from(packet.sequence - run.newest - 1);
                let passed = packet.offset.checked_sub(run.end);
                let possible =
                    passed.is_some_and(|bytes| bytes >= between && bytes <= between * MOST_SAMPLES);
                if !possible {
                    self.counts.malformed += 1;
                    return false;
                }
                let oldest = packet.sequence.saturating_sub(RESTART_PACKETS);
                run.missing = run.missing.split_off(&oldest);
                run.missing.extend((run.newest + 1).max(oldest)..packet.sequence);
                (run.newest, run.end) = (packet.sequence, end);
            } else if !run.missing.remove(&packet.sequence) {
                self.counts.duplicates += 1;
                return false;
            } else if packet.offset < run.begin || end > run.end {
                self.counts.malformed += 1;
                return false;
            } else {
                self.counts.reordered += 1;
            }
        }
        let frame_bytes = self.frame_bytes;
        let counts = self.counts;
        let run = self.run.get_or_insert_with(|| Run {
            newest: packet.sequence,
            missing: BTreeSet::new(),
            begin: packet.offset,
            end,
            bytes: 0,
            lost_before: (counts.lost_packets, counts.lost_bytes),
            packets: 0,
            first: packet.sequence,
            // A frame whose beginning was sent before is not waited for.
            next: packet.offset.div_ceil(frame_bytes),
            window: 0,
        });
        run.packets += 1;
        run.bytes += packet.samples.len() as u64;
        run.window = run.window.max(packet.samples.len() as u64 * u64::from(REORDER_PACKETS));
        let sent = u64::from(run.newest - run.first) + 1;
        self.counts.lost_packets = run.lost_before.0 + sent.saturating_sub(run.packets);
        self.counts.lost_bytes =
            run.lost_before.1 + (run.end - run.begin).saturating_sub(run.bytes);
        true
    }

    /// Lays samples where they belong, over as many frames as they span.
    fn put(&mut self, packet: &Packet<'_>) {
        let Some(run) = &self.run else { return };
        let size = self.frame_bytes;
        let (mut at, mut samples) = (packet.offset, packet.samples);
        while !samples.is_empty() {
            let (number, within) = (at / size, (at % size) as usize);
            let length = samples.len().min(size as usize - within);
            let (now, rest) = samples.split_at(length);
            if number >= run.next {
                let part = self
                    .parts
                    .entry(number)
                    .or_insert_with(|| Part { samples: vec![0; size as usize], filled: 0 });
                part.samples[within..within + length].copy_from_slice(now);
                part.filled += length;
            }
            (at, samples) = (at + length as u64, rest);
        }
    }

    /// Gives out what is whole and gives up what no packet will complete any more, in order.
    fn settle(&mut self) -> Vec<Frame> {
        let size = self.frame_bytes;
        let Some(run) = &mut self.run else { return vec![] };
        let mut whole = vec![];
        loop {
            let number = run.next;
            let is_whole = self.parts.get(&number).is_some_and(|part| part.filled as u64 == size);
            let is_past = (number + 1).saturating_mul(size).saturating_add(run.window) <= run.end;
            if !is_whole && !is_past {
                return whole;
            }
            match self.parts.remove(&number) {
                Some(part) if is_whole => {
                    self.counts.frames += 1;
                    whole.push(Frame { number, samples: part.samples });
                    run.next += 1;
                }
                Some(_) => {
                    self.counts.damaged_frames += 1;
                    run.next += 1;
                }
                // Frames of which nothing came, all at once.
                None => {
                    let known = self.parts.keys().next().copied().unwrap_or(u64::MAX);
                    let past = run.end.saturating_sub(run.window) / size;
                    let next = known.min(past).max(number + 1);
                    self.counts.damaged_frames += next - number;
                    run.next = next;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
