//! Splits bytes that come in pieces into records, holding none of those nobody wants.

use super::record::{CHUNK_HEAD, ChunkHead, MAGIC, MESSAGE_HEAD, MessageHead, RECORD_HEAD, opcode};

/// Longest record that is held whole beside messages and chunks, bytes; what is longer is passed over.
pub(super) const MAX_RECORD_BYTES: u64 = 16 << 20;
/// Longest message that is held, bytes.
pub(super) const MAX_MESSAGE_BYTES: u64 = 128 << 20;
/// Longest name of a compression.
const MAX_NAME_BYTES: usize = 64;

/// A step through the bytes.
pub(super) enum Step<'a> {
    /// On the way to something.
    Under,
    /// A record held whole.
    Record(u8, &'a [u8]),
    /// A message of a wanted channel.
    Message(MessageHead, &'a [u8]),
    /// A message that is passed over, too long to be held or not wanted.
    Passed(MessageHead, bool),
    /// The records of a chunk follow, packed in the way of this name into so many bytes.
    Chunk(ChunkHead, &'a [u8], u64),
    /// What was taken are some of the records of a chunk.
    InChunk,
    /// A record too long to be held is passed over.
    TooLong,
    /// What no file has.
    Damage(&'static str),
}

#[derive(Debug, Clone, Copy)]
enum State {
    Magic,
    Head,
    Record {
        opcode: u8,
        length: u64,
    },
    MessageHead {
        length: u64,
    },
    Message {
        head: MessageHead,
        length: u64,
    },
    ChunkHead {
        length: u64,
    },
    ChunkName {
        head: ChunkHead,
        left: u64,
    },
    InChunk {
        left: u64,
    },
    Pass {
        left: u64,
    },
    EndMagic,
    /// After the end, or after damage.
    Over,
}

/// The way through a file, or through the records of a chunk.
#[derive(Debug, Clone)]
pub(super) struct Splitter {
    state: State,
    /// The beginning of what is held until it is whole.
    pending: Vec<u8>,
    /// Whether `pending` was given out.
    given: bool,
    /// Over all before the end of data; none within chunks, which have their own.
    crc: Option<crc32fast::Hasher>,
    /// The CRC-32 of the data, once its end was met.
    pub data_crc: Option<u32>,
}

impl Splitter {
    /// Of a file.
    pub fn of_file() -> Self {
        Self { state: State::Magic, crc: Some(crc32fast::Hasher::new()), ..Self::of_chunk() }
    }

    /// Of the records in a chunk.
    pub fn of_chunk() -> Self {
        Self { state: State::Head, pending: vec![], given: false, crc: None, data_crc: None }
    }

    /// Whether a record is whole, and none is begun.
    pub fn is_between(&self) -> bool {
        matches!(self.state, State::Head | State::Over) && (self.given || self.pending.is_empty())
    }

    /// Whether the end of the file was met, with its magic bytes.
    pub fn is_over(&self) -> bool {
        matches!(self.state, State::Over)
    }

    /// Takes bytes of a chunk into the check sum of the data.
    pub fn hash(&mut self, bytes: &[u8]) {
        if let Some(crc) = &mut self.crc {
            crc.update(bytes);
        }
    }

    /// Takes all bytes of a chunk into the check sum of the data, by their own; without one there is no
    /// sum of the data any more.
    pub fn hash_all(&mut self, sum: Option<&crc32fast::Hasher>) {
        match (&mut self.crc, sum) {
            (Some(crc), Some(sum)) => crc.combine(sum),
            (crc, _) => *crc = None,
        }
    }

    /// Takes nothing more.
    pub fn stop(&mut self) {
        self.state = State::Over;
    }

    /// Takes from the input up to the next thing to say; `None` where it is used up.
    pub fn next<'s, 'a: 's>(
        &'s mut self,
        input: &mut &'a [u8],
        wants: impl Fn(u16) -> bool,
    ) -> Option<Step<'s>> {
        if std::mem::take(&mut self.given) {
            self.pending.clear();
        }
        let mut taken = Taken { pending: &mut self.pending, crc: self.crc.as_mut() };
        match self.state {
            State::Over => None,
            State::Magic | State::EndMagic => {
                let is_end = matches!(self.state, State::EndMagic);
                let magic = taken.whole(input, MAGIC.len())?;
                let is_right = magic == MAGIC;
                self.given = true;
                self.state = if is_right && !is_end { State::Head } else { State::Over };
                let what = if is_end { "the magic bytes at the end" } else { "the magic bytes" };
                Some(if is_right { Step::Under } else { Step::Damage(what) })
            }
            State::Head => {
                // Not of the data, if the data ends here.
                taken.crc = None;
                let head = taken.whole(input, RECORD_HEAD)?;
                let (&opcode, length) = head.split_first()?;
                let length = u64::from_le_bytes(length.try_into().ok()?);
                if opcode == opcode::DATA_END {
                    self.data_crc = self.crc.take().map(crc32fast::Hasher::finalize);
                } else if let Some(crc) = &mut self.crc {
                    crc.update(head);
                }
                self.given = true;
                let (state, step) = begun(opcode, length);
                self.state = state;
                Some(step)
            }
            State::Record { opcode, length } => {
                let content = taken.whole(input, length as usize)?;
                self.state = match opcode {
                    opcode::FOOTER => State::EndMagic,
                    _ => State::Head,
                };
                self.given = true;
                Some(Step::Record(opcode, content))
            }
            State::MessageHead { length } => {
                let head = MessageHead::read(taken.whole(input, MESSAGE_HEAD)?)?;
                let left = length - MESSAGE_HEAD as u64;
                let is_wanted = wants(head.channel);
                let is_held = is_wanted && left <= MAX_MESSAGE_BYTES;
                self.given = true;
                self.state =
                    if is_held { State::Message { head, length: left } } else { pass(left) };
                Some(if is_held { Step::Under } else { Step::Passed(head, is_wanted) })
            }
            State::Message { head, length } => {
                let data = taken.whole(input, length as usize)?;
                self.state = State::Head;
                self.given = true;
                Some(Step::Message(head, data))
            }
            State::ChunkHead { length } => {
                let head = ChunkHead::read(taken.whole(input, CHUNK_HEAD)?)?;
                self.given = true;
                let left = length - CHUNK_HEAD as u64;
                let is_right =
                    head.name_bytes <= MAX_NAME_BYTES && left >= head.name_bytes as u64 + 8;
                if !is_right {
                    self.state = State::Over;
                    return Some(Step::Damage("the head of a chunk"));
                }
                self.state = State::ChunkName { head, left };
                Some(Step::Under)
            }
            State::ChunkName { head, left } => {
                let count = head.name_bytes + 8;
                let (name, packed) = taken.whole(input, count)?.split_last_chunk()?;
                self.given = true;
                let packed = u64::from_le_bytes(*packed);
                if packed != left - count as u64 {
                    self.state = State::Over;
                    return Some(Step::Damage("the length of a chunk"));
                }
                self.state = State::InChunk { left: packed };
                Some(Step::Chunk(head, name, packed))
            }
            State::InChunk { left } => {
                if left == 0 {
                    self.state = State::Head;
                    return Some(Step::Under);
                }
                // Whoever reads the chunk takes its check sum.
                taken.crc = None;
                let bytes = taken.some(input, left)?;
                self.state = State::InChunk { left: left - bytes.len() as u64 };
                Some(Step::InChunk)
            }
            State::Pass { left } => {
                let bytes = taken.some(input, left)?;
                self.state = pass(left - bytes.len() as u64);
                Some(Step::Under)
            }
        }
    }
}

/// What the head of a record leads to.
fn begun(opcode: u8, length: u64) -> (State, Step<'static>) {
    let is_held = matches!(
        opcode,
        opcode::HEADER
            | opcode::FOOTER
            | opcode::SCHEMA
            | opcode::CHANNEL
            | opcode::STATISTICS
            | opcode::DATA_END
    );
    let damage = |what| (State::Over, Step::Damage(what));
    match opcode {
        0 => damage("the opcode of a record"),
        opcode::MESSAGE if length < MESSAGE_HEAD as u64 => damage("the length of a message"),
        opcode::MESSAGE => (State::MessageHead { length }, Step::Under),
        opcode::CHUNK if length < CHUNK_HEAD as u64 => damage("the length of a chunk"),
        opcode::CHUNK => (State::ChunkHead { length }, Step::Under),
        _ if is_held && length <= MAX_RECORD_BYTES => {
            (State::Record { opcode, length }, Step::Under)
        }
        _ => (pass(length), if is_held { Step::TooLong } else { Step::Under }),
    }
}

fn pass(left: u64) -> State {
    if left == 0 { State::Head } else { State::Pass { left } }
}

/// What is taken from an input, by way of what is pending if it comes in pieces.
struct Taken<'s, 'c> {
    pending: &'s mut Vec<u8>,
    crc: Option<&'c mut crc32fast::Hasher>,
}

impl<'s> Taken<'s, '_> {
    fn some<'a>(&mut self, input: &mut &'a [u8], most: u64) -> Option<&'a [u8]> {
        let count = input.len().min(usize::try_from(most).unwrap_or(usize::MAX));
        let (bytes, rest) = input.split_at(count);
        *input = rest;
        if let Some(crc) = &mut self.crc {
            crc.update(bytes);
        }
        (count > 0).then_some(bytes)
    }

    fn whole<'a: 's>(mut self, input: &mut &'a [u8], count: usize) -> Option<&'s [u8]> {
        let missing = count - self.pending.len().min(count);
        let bytes = self.some(input, missing as u64).unwrap_or_default();
        if bytes.len() == count {
            return Some(bytes);
        }
        self.pending.extend_from_slice(bytes);
        (bytes.len() == missing).then_some(&*self.pending)
    }
}
