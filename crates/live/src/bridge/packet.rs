//! Packets of the DCA1000 in raw mode: a sequence number from 1 on, the bytes sent before this packet, and samples.
//! Source: DCA1000EVM Data Capture Card User's Guide (SPRUIJ4A), raw mode data format.

/// Bytes before the samples.
pub const HEADER_BYTES: usize = 10;

/// A packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a> {
    /// Number of the packet, from 1.
    pub sequence: u32,
    /// Bytes of samples in the packets before this one.
    pub offset: u64,
    /// Samples.
    pub samples: &'a [u8],
}

impl<'a> Packet<'a> {
    /// Reads a packet; `None` for one without samples.
    pub fn read(bytes: &'a [u8]) -> Option<Self> {
        let (header, samples) = bytes.split_at_checked(HEADER_BYTES)?;
        let sequence = u32::from_le_bytes([header[0], header[1], header[2], header[3]]);
        let offset = header[4..].iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte));
        (!samples.is_empty()).then_some(Self { sequence, offset, samples })
    }
}

/// The header of a packet, as the card writes it.
pub fn write_header(sequence: u32, offset: u64) -> [u8; HEADER_BYTES] {
    let (s, o) = (sequence.to_le_bytes(), offset.to_le_bytes());
    [s[0], s[1], s[2], s[3], o[0], o[1], o[2], o[3], o[4], o[5]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_read_as_they_are_written() {
        let mut bytes = write_header(0x0403_0201, 0x0c0b_0a09_0807).to_vec();
        assert_eq!(bytes, [1, 2, 3, 4, 7, 8, 9, 10, 11, 12]);
        assert_eq!(Packet::read(&bytes), None);
        assert_eq!(Packet::read(&bytes[..9]), None);
        bytes.extend([5, 6]);
        let packet = Packet::read(&bytes);
        let expected = Packet { sequence: 0x0403_0201, offset: 0x0c0b_0a09_0807, samples: &[5, 6] };
        assert_eq!(packet, Some(expected));
    }
}
