//! A chunk while it comes.

use super::names::Names;
use super::record::{MessageHead, opcode};
use super::sink::McapSink;
use super::split::{Splitter, Step};
use super::unpack::Compression;
use std::collections::BTreeMap;

/// Most that is held of the wanted messages of a chunk, bytes.
const MAX_HELD_BYTES: usize = 512 << 20;

/// A chunk on the way.
pub(super) struct Chunk {
    pub compression: Option<Compression>,
    pub unpacked: u64,
    pub crc: u32,
    pub packed: u64,
    /// What came of it, if it is packed.
    pub pending: Vec<u8>,
    pub left: u64,
    pub inside: Inside,
}

/// The records of a chunk, of which nothing counts before the whole is known to be right.
pub(super) struct Inside {
    pub records: Splitter,
    pub crc: crc32fast::Hasher,
    pub unpacked: u64,
    pub held: Vec<u8>,
    pub messages: Vec<(MessageHead, usize)>,
    pub counts: BTreeMap<u16, u64>,
    pub long_messages: u64,
    pub channels: Vec<u16>,
    pub schemas: Vec<u16>,
    pub is_damaged: bool,
}

impl Inside {
    pub fn new() -> Self {
        Self {
            records: Splitter::of_chunk(),
            crc: crc32fast::Hasher::new(),
            unpacked: 0,
            held: vec![],
            messages: vec![],
            counts: BTreeMap::new(),
            long_messages: 0,
            channels: vec![],
            schemas: vec![],
            is_damaged: false,
        }
    }

    /// Takes unpacked bytes; whether more are wanted.
    pub fn push(
        &mut self,
        mut bytes: &[u8],
        most: u64,
        names: &mut Names,
        sink: &mut dyn McapSink,
    ) -> bool {
        self.unpacked += bytes.len() as u64;
        if self.unpacked > most {
            self.is_damaged = true;
            return false;
        }
        self.crc.update(bytes);
        while let Some(step) = self.records.next(&mut bytes, |channel| names.wants(channel)) {
            match step {
                Step::Record(opcode, content) => match names.take(opcode, content, sink) {
                    Some(Some(id)) if opcode == opcode::SCHEMA => self.schemas.push(id),
                    Some(Some(id)) => self.channels.push(id),
                    Some(None) => {}
                    None => self.is_damaged = true,
                },
                Step::Message(head, data) => {
                    if self.held.len().saturating_add(data.len()) > MAX_HELD_BYTES {
                        self.long_messages += 1;
                    } else {
                        self.held.extend_from_slice(data);
                        self.messages.push((head, self.held.len()));
                    }
                    *self.counts.entry(head.channel).or_default() += 1;
                }
                Step::Passed(head, was_wanted) => {
                    self.long_messages += u64::from(was_wanted);
                    *self.counts.entry(head.channel).or_default() += 1;
                }
                Step::Under | Step::TooLong => {}
                Step::Chunk(..) | Step::InChunk | Step::Damage(_) => self.is_damaged = true,
            }
            if self.is_damaged {
                return false;
            }
        }
        true
    }
}
