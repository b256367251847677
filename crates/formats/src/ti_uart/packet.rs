//! Header and extent of a packet.

use super::MAX_PACKET_BYTES;

/// Bytes of the shortest header: magic word and seven numbers.
pub(super) const SHORT_HEADER: usize = 36;
/// Bytes of the header with a sub-frame number, which all but SDK 1 and the xWR14xx have.
pub(super) const HEADER: usize = 40;
/// Most parts of a packet; the demos send fewer than ten kinds, each once.
const MAX_PARTS: usize = 64;
/// Packets are padded to a multiple of this.
const SEGMENT: usize = 32;
/// Bytes of type and length.
const PART_HEADER: usize = 8;

/// The fixed part of a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub version: u32,
    pub length: usize,
    pub platform: u32,
    pub frame_number: u32,
    pub cpu_cycles: u32,
    pub objects: usize,
    pub parts: usize,
}

/// One type-length-value part of a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Part<'a> {
    pub kind: u32,
    pub payload: &'a [u8],
}

/// Little-endian number at `offset`, if it is there.
pub(super) fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    let word = bytes.get(offset..offset.checked_add(4)?)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}

/// Little-endian number at `offset`, if it is there.
pub(super) fn u16_at(bytes: &[u8], offset: usize) -> Option<u16> {
    let word = bytes.get(offset..offset.checked_add(2)?)?;
    Some(u16::from_le_bytes([word[0], word[1]]))
}

impl Header {
    /// Reads the header at the start of `bytes` (magic word included); `None` if the bytes are too
    /// few or what they say cannot be.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let at = |index: usize| u32_at(bytes, 8 + 4 * index);
        let header = Self {
            version: at(0)?,
            length: at(1)? as usize,
            platform: at(2)?,
            frame_number: at(3)?,
            cpu_cycles: at(4)?,
            objects: at(5)? as usize,
            parts: at(6)? as usize,
        };
        let possible =
            (SHORT_HEADER..=MAX_PACKET_BYTES).contains(&header.length) && header.parts <= MAX_PARTS;
        possible.then_some(header)
    }

    /// SDK version: major, minor, bug fix, build.
    pub fn version(&self) -> [u8; 4] {
        self.version.to_be_bytes()
    }

    /// `xWR16xx` for 0xa1642 and the like.
    pub fn platform_name(&self) -> String {
        match self.platform >> 4 {
            0xa144 | 0xa164 | 0xa184 | 0xa684 => {
                format!("xWR{:x}xx", self.platform >> 8 & 0xff)
            }
            _ => format!("{:#x}", self.platform),
        }
    }
}

/// The parts of a whole packet, whichever of the two headers it has; `None` if they do not fill it
/// up to the padding.
pub(super) fn parts<'a>(header: &Header, packet: &'a [u8]) -> Option<(usize, Vec<Part<'a>>)> {
    let older = header.version()[0] < 2 || header.platform >> 4 == 0xa144;
    let starts = if older { &[HEADER, SHORT_HEADER][..] } else { &[HEADER] };
    starts.iter().find_map(|&start| {
        let (found, end) = leading_parts(header, packet, start);
        // A packet of a short header and no parts ends before the longer header does.
        let padding = packet.len().checked_sub(end);
        let whole = found.len() == header.parts && padding.is_some_and(|bytes| bytes < SEGMENT);
        whole.then_some((start, found))
    })
}

/// The whole parts at the beginning of a packet, and where they end.
pub(super) fn leading_parts<'a>(
    header: &Header,
    packet: &'a [u8],
    start: usize,
) -> (Vec<Part<'a>>, usize) {
    let mut found = vec![];
    let mut offset = start;
    while found.len() < header.parts {
        let (Some(kind), Some(length)) = (u32_at(packet, offset), u32_at(packet, offset + 4))
        else {
            break;
        };
        let begin = offset + PART_HEADER;
        let end = begin.saturating_add(length as usize);
        let Some(payload) = packet.get(begin..end) else { break };
        found.push(Part { kind, payload });
        offset = end;
    }
    (found, offset)
}
