//! Finds packets in a stream of bytes that may start anywhere and lose some.

use super::packet::{HEADER, Header, SHORT_HEADER, leading_parts, parts};
use super::parts::{Scale, decode};
use super::{BoardFrame, BoardLogCounts, MAGIC};
use crate::mmwave_cfg::RadarConfig;
use boresight_core::Remark;

/// Takes the bytes of a board's data port as they come and gives packets as they are complete.
/// Holds at most one packet, so never more than [`super::MAX_PACKET_BYTES`] beyond what one call
/// pushes.
#[derive(Debug, Clone)]
pub struct UartStream {
    pending: Vec<u8>,
    scale: Option<Scale>,
    skipped_bytes: u64,
    damaged_packets: u64,
    cut_at_end: bool,
}

impl UartStream {
    /// A stream; with the configuration the board runs, Doppler bins become range rates.
    pub fn new(config: Option<&RadarConfig>) -> Self {
        Self {
            pending: vec![],
            scale: config.map(Scale::of),
            skipped_bytes: 0,
            damaged_packets: 0,
            cut_at_end: false,
        }
    }

    /// Takes the next bytes and returns the packets they complete.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<BoardFrame> {
        self.pending.extend_from_slice(bytes);
        let mut frames = vec![];
        let mut offset = 0;
        loop {
            let rest = &self.pending[offset..];
            let Some(start) = find_magic(rest) else {
                // The end may be the beginning of a magic word.
                let skip = rest.len().saturating_sub(MAGIC.len() - 1);
                self.skipped_bytes += skip as u64;
                offset += skip;
                break;
            };
            self.skipped_bytes += start as u64;
            offset += start;
            let rest = &self.pending[offset..];
            if rest.len() < SHORT_HEADER {
                break;
            }
            let taken = match Header::read(rest) {
                Some(header) if rest.len() < header.length => break,
                Some(header) => whole_packet(&header, &rest[..header.length], self.scale)
                    .map(|frame| (frame, header.length)),
                None => None,
            };
            if let Some((frame, length)) = taken {
                frames.push(frame);
                offset += length;
            } else {
                self.damaged_packets += 1;
                self.skipped_bytes += MAGIC.len() as u64;
                offset += MAGIC.len();
            }
        }
        self.pending.drain(..offset);
        frames
    }

    /// Ends the input: gives the packet it cut, if its leading parts are whole, and what follows a
    /// header that claimed more than was there.
    pub fn finish(&mut self) -> Vec<BoardFrame> {
        let mut frames = vec![];
        while self.pending.starts_with(&MAGIC) {
            self.damaged_packets += 1;
            let next = find_magic(&self.pending[MAGIC.len()..]).map(|at| at + MAGIC.len());
            if next.is_none() {
                let (frame, used) = cut_packet(&self.pending, self.scale);
                self.cut_at_end = frame.is_some();
                self.skipped_bytes += (self.pending.len() - used) as u64;
                frames.extend(frame);
                self.pending.clear();
                return frames;
            }
            let skip = next.unwrap_or(self.pending.len());
            self.skipped_bytes += skip as u64;
            self.pending.drain(..skip);
            frames.extend(self.push(&[]));
        }
        self.skipped_bytes += self.pending.len() as u64;
        self.pending.clear();
        frames
    }

    /// What was skipped or damaged so far.
    pub fn counts(&self) -> BoardLogCounts {
        let Self { skipped_bytes, damaged_packets, .. } = *self;
        BoardLogCounts { skipped_bytes, damaged_packets, remarks: self.remarks() }
    }

    fn remarks(&self) -> Vec<Remark> {
        let mut remarks = vec![];
        if self.skipped_bytes > 0 {
            let text = format!("bytes that belong to no packet: {}", self.skipped_bytes);
            remarks.push(Remark::new("skipped-bytes", text));
        }
        if self.damaged_packets > 0 {
            let cut = if self.cut_at_end { ", the last one by the end of the input" } else { "" };
            let text = format!("packets cut or damaged: {}{cut}", self.damaged_packets);
            remarks.push(Remark::new("damaged-packets", text));
        }
        remarks
    }
}

/// Decodes a packet all of whose bytes are there; `None` if it is damaged.
fn whole_packet(header: &Header, packet: &[u8], scale: Option<Scale>) -> Option<BoardFrame> {
    let (start, parts) = parts(header, packet)?;
    let used: usize = start + parts.iter().map(|part| 8 + part.payload.len()).sum::<usize>();
    // Bytes lost on the line let the next packet begin inside this one. The padding is left out of
    // this check: boards pad with whatever their memory holds.
    if find_magic(&packet[MAGIC.len()..used]).is_some() {
        return None;
    }
    decode(header, start, packet, &parts, scale)
}

/// What there is of a packet that the end of the input cut, and the bytes it takes.
fn cut_packet(packet: &[u8], scale: Option<Scale>) -> (Option<BoardFrame>, usize) {
    let Some(header) = Header::read(packet) else { return (None, 0) };
    let (parts, used) = leading_parts(&header, packet, HEADER);
    if parts.is_empty() || packet.len() >= header.length {
        return (None, 0);
    }
    match decode(&header, HEADER, packet, &parts, scale) {
        Some(frame) => (Some(BoardFrame { complete: false, ..frame }), used),
        None => (None, 0),
    }
}

fn find_magic(bytes: &[u8]) -> Option<usize> {
    bytes.windows(MAGIC.len()).position(|window| window == MAGIC)
}
