//! Reads a file from bytes as they come.

use super::chunk::{Chunk, Inside};
use super::counts::McapCounts;
use super::names::Names;
use super::record::{Channel, ChunkHead, Fields, MAGIC, Message, MessageHead, Schema, opcode};
use super::sink::McapSink;
use super::split::{Splitter, Step};
use super::unpack::Compression;
use crate::error::FormatError;
use std::collections::BTreeMap;

/// Chunks may unpack to this, bytes, and [`GROWTH`] times the file so far beside.
const ALLOWANCE: u64 = 64 << 20;
const GROWTH: u64 = 1024;
/// Most that is held of a packed chunk, bytes.
const MAX_PACKED_BYTES: u64 = 512 << 20;

/// Reads a file of which the bytes come in pieces. Holds one chunk at most as it is stored, and of
/// its messages the wanted ones.
pub struct McapStream {
    records: Splitter,
    contents: Contents,
    /// Where the last whole record ended.
    whole_until: u64,
}

/// What was met so far.
#[derive(Default)]
struct Contents {
    names: Names,
    chunk: Option<Chunk>,
    counts: McapCounts,
    by_channel: BTreeMap<u16, u64>,
    /// Bytes that chunks unpack to.
    unpacked: u64,
}

/// Which check sum has the bytes of a piece of a chunk.
enum Hashed {
    /// None yet.
    No,
    /// That of the chunk, which is not yet whole.
    Soon,
    /// That of the chunk, with all of its bytes; none where it is damaged.
    All(Option<crc32fast::Hasher>),
}

impl Default for McapStream {
    fn default() -> Self {
        Self { records: Splitter::of_file(), contents: Contents::default(), whole_until: 0 }
    }
}

impl McapStream {
    /// Takes the next bytes of the file.
    ///
    /// # Errors
    /// [`FormatError::Binary`] where the file does not begin as MCAP does. Damage behind that ends the
    /// reading, and is counted.
    pub fn push(&mut self, bytes: &[u8], sink: &mut dyn McapSink) -> Result<(), FormatError> {
        let Self { records, contents, whole_until } = self;
        let start = contents.counts.bytes;
        contents.counts.bytes += bytes.len() as u64;
        let mut input = bytes;
        loop {
            let names = &contents.names;
            let before = input;
            let Some(step) = records.next(&mut input, |channel| names.wants(channel)) else {
                return Ok(());
            };
            let offset = start + (bytes.len() - input.len()) as u64;
            let damage = match step {
                Step::Under => None,
                Step::Record(opcode::DATA_END, content) => {
                    let stated = Fields(content).u32().unwrap_or(0);
                    let sum = records.data_crc;
                    contents.counts.wrong_sum = stated != 0 && sum.is_some_and(|sum| sum != stated);
                    None
                }
                Step::Damage(what) if offset <= MAGIC.len() as u64 => {
                    return Err(FormatError::Binary {
                        format: "MCAP",
                        offset: 0,
                        what: what.into(),
                        expected: "89 4D 43 41 50 30 0D 0A".into(),
                        given: "something else".into(),
                    });
                }
                Step::InChunk => {
                    let piece = before.get(..before.len() - input.len()).unwrap_or_default();
                    match contents.take_piece(piece, sink) {
                        Hashed::No => records.hash(piece),
                        Hashed::Soon => {}
                        Hashed::All(sum) => records.hash_all(sum.as_ref()),
                    }
                    None
                }
                step => contents.take(step, sink),
            };
            if let Some(what) = damage {
                contents.counts.damage.get_or_insert((offset, what));
                records.stop();
                return Ok(());
            }
            if records.is_between() {
                *whole_until = offset;
            }
        }
    }

    /// Ends the file: what it cuts is taken as far as it is whole.
    pub fn finish(&mut self, sink: &mut dyn McapSink) -> &McapCounts {
        self.contents.end_chunk(&[], true, sink);
        let is_over = self.records.is_over();
        self.records.stop();
        let counts = &mut self.contents.counts;
        counts.complete = counts.damage.is_none() && is_over;
        counts.lost_bytes = counts.bytes - self.whole_until;
        counts
    }

    /// What was met so far.
    pub fn counts(&self) -> &McapCounts {
        &self.contents.counts
    }

    /// Channels by their numbers, each with its schema and its messages so far.
    pub fn channels(&self) -> impl Iterator<Item = (&Channel, Option<&Schema>, u64)> {
        let Contents { names, by_channel, .. } = &self.contents;
        names.channels.values().map(|(channel, _)| {
            let messages = by_channel.get(&channel.id).copied().unwrap_or(0);
            (channel, names.schemas.get(&channel.schema), messages)
        })
    }
}

impl Contents {
    /// Takes a step of a file; what is damaged, if anything is.
    fn take(&mut self, step: Step<'_>, sink: &mut dyn McapSink) -> Option<&'static str> {
        match step {
            Step::Under => {}
            Step::TooLong => self.counts.long_records += 1,
            Step::Damage(what) => return Some(what),
            Step::Record(opcode::STATISTICS, content) => {
                self.counts.stated_messages = Fields(content).u64();
            }
            Step::Record(opcode, content) => {
                if self.names.take(opcode, content, sink).is_none() {
                    return Some("a schema or a channel");
                }
            }
            Step::Message(MessageHead { channel, log_time_ns }, data) => {
                self.count(channel, 1);
                let is_wanted = sink.message(Message { channel, log_time_ns, data });
                self.names.set(channel, is_wanted);
            }
            Step::Passed(head, was_wanted) => {
                self.counts.long_messages += u64::from(was_wanted);
                self.count(head.channel, 1);
            }
            Step::Chunk(head, name, packed) => {
                self.begin_chunk(head, Compression::of(name), packed);
                if packed == 0 {
                    self.end_chunk(&[], false, sink);
                }
            }
            Step::InChunk => {}
        }
        None
    }

    /// Takes a piece of a chunk.
    fn take_piece(&mut self, piece: &[u8], sink: &mut dyn McapSink) -> Hashed {
        let Some(chunk) = &mut self.chunk else { return Hashed::No };
        chunk.left -= piece.len() as u64;
        let is_plain = chunk.compression == Some(Compression::None);
        let is_whole = piece.len() as u64 == chunk.packed;
        if is_plain {
            if !chunk.inside.is_damaged {
                chunk.inside.push(piece, chunk.unpacked, &mut self.names, sink);
            }
        } else if chunk.compression.is_some() && !is_whole {
            chunk.pending.extend_from_slice(piece);
        }
        if chunk.left > 0 {
            return if is_plain { Hashed::Soon } else { Hashed::No };
        }
        let sum = (!chunk.inside.is_damaged).then(|| chunk.inside.crc.clone());
        self.end_chunk(if is_whole { piece } else { &[] }, false, sink);
        if is_plain { Hashed::All(sum) } else { Hashed::No }
    }

    fn count(&mut self, channel: u16, messages: u64) {
        self.counts.messages += messages;
        if self.names.channels.contains_key(&channel) {
            *self.by_channel.entry(channel).or_default() += messages;
        } else {
            self.counts.nameless_messages += messages;
        }
    }

    fn begin_chunk(&mut self, head: ChunkHead, compression: Option<Compression>, packed: u64) {
        let allowed = GROWTH.saturating_mul(self.counts.bytes).saturating_add(ALLOWANCE);
        let unpacked = self.unpacked.saturating_add(head.unpacked);
        let is_held = packed <= MAX_PACKED_BYTES && unpacked <= allowed;
        let compression = compression.filter(|kind| is_held || *kind == Compression::None);
        match compression {
            Some(Compression::None) => {}
            Some(_) => self.unpacked = unpacked,
            None => self.counts.unread_chunks += 1,
        }
        self.counts.chunks += 1;
        let mut inside = Inside::new();
        // Its records are read as they come. Without this check, which of them are read would depend on the pieces.
        inside.is_damaged = compression == Some(Compression::None) && head.unpacked != packed;
        self.chunk = Some(Chunk {
            compression,
            unpacked: head.unpacked,
            crc: head.crc,
            packed,
            pending: vec![],
            left: packed,
            inside,
        });
    }

    /// Ends a chunk, of which the packed bytes are `whole` if they came in one piece, and hands its
    /// messages on unless it is damaged. What stands before a cut cannot be checked as a whole.
    fn end_chunk(&mut self, whole: &[u8], is_cut: bool, sink: &mut dyn McapSink) {
        let Some(Chunk { compression: Some(kind), unpacked, crc, pending, mut inside, .. }) =
            self.chunk.take()
        else {
            return;
        };
        if kind != Compression::None {
            let packed = if pending.is_empty() { whole } else { &pending };
            let names = &mut self.names;
            let is_whole = kind.unpack(packed, |piece| inside.push(piece, unpacked, names, sink));
            inside.is_damaged |= !is_whole && !is_cut;
        }
        let is_right = inside.unpacked == unpacked
            && inside.records.is_between()
            && (crc == 0 || inside.crc.finalize() == crc);
        if inside.is_damaged || !(is_right || is_cut) {
            self.counts.damaged_chunks += 1;
            for id in inside.channels {
                self.names.channels.remove(&id);
            }
            for id in inside.schemas {
                self.names.schemas.remove(&id);
            }
            return;
        }
        self.counts.long_messages += inside.long_messages;
        for (channel, messages) in inside.counts {
            self.count(channel, messages);
        }
        let mut begin = 0;
        for (MessageHead { channel, log_time_ns }, end) in inside.messages {
            let data = inside.held.get(begin..end).unwrap_or_default();
            begin = end;
            if self.names.wants(channel) {
                let is_wanted = sink.message(Message { channel, log_time_ns, data });
                self.names.set(channel, is_wanted);
            }
        }
    }
}
