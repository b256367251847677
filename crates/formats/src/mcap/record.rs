//! The records of an MCAP file, as <https://mcap.dev/spec> lays them out: an opcode, the length of the
//! content as 64 bits, the content; numbers little-endian, texts with their length as 32 bits before them.

/// What a file begins and ends with.
pub const MAGIC: [u8; 8] = [0x89, b'M', b'C', b'A', b'P', b'0', b'\r', b'\n'];

/// Opcodes of the records that are read.
pub(super) mod opcode {
    pub const HEADER: u8 = 0x01;
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const MESSAGE: u8 = 0x05;
    pub const CHUNK: u8 = 0x06;
    pub const STATISTICS: u8 = 0x0b;
    pub const DATA_END: u8 = 0x0f;
}

/// Bytes of a record before its content.
pub(super) const RECORD_HEAD: usize = 9;
/// Bytes of a message before its data.
pub(super) const MESSAGE_HEAD: usize = 22;
/// Bytes of a chunk before the name of its compression.
pub(super) const CHUNK_HEAD: usize = 32;

/// What the data of messages is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Schema {
    /// Its number in the file.
    pub id: u16,
    /// Name of the type, such as `sensor_msgs/msg/PointCloud2`.
    pub name: String,
    /// What language it is written in, such as `ros2msg`.
    pub encoding: String,
    /// The definition.
    pub data: Vec<u8>,
}

/// A stream of messages on one topic.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Channel {
    /// Its number in the file.
    pub id: u16,
    /// Number of the schema; 0 for none.
    pub schema: u16,
    /// The topic.
    pub topic: String,
    /// How messages are encoded, such as `cdr`.
    pub encoding: String,
}

/// A message of a wanted channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Message<'a> {
    /// Number of the channel.
    pub channel: u16,
    /// When it was recorded, ns.
    pub log_time_ns: u64,
    /// The encoded message.
    pub data: &'a [u8],
}

/// What stands before the data of a message.
#[derive(Debug, Clone, Copy)]
pub(super) struct MessageHead {
    pub channel: u16,
    pub log_time_ns: u64,
}

/// What stands before the name of a chunk's compression.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChunkHead {
    /// Bytes of its records once they are unpacked.
    pub unpacked: u64,
    /// CRC-32 of those; 0 for none.
    pub crc: u32,
    /// Length of the name.
    pub name_bytes: usize,
}

/// Reads what is at the front of bytes; `None` where they end early.
pub(super) struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub fn bytes(&mut self) -> Option<&'a [u8]> {
        let length = self.u32()? as usize;
        let (bytes, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(bytes)
    }

    pub fn text(&mut self) -> Option<String> {
        self.bytes().map(|bytes| String::from_utf8_lossy(bytes).into_owned())
    }
}

impl Schema {
    pub(super) fn read(content: &[u8]) -> Option<Self> {
        let mut fields = Fields(content);
        Some(Self {
            id: fields.u16()?,
            name: fields.text()?,
            encoding: fields.text()?,
            data: fields.bytes()?.to_vec(),
        })
    }
}

impl Channel {
    pub(super) fn read(content: &[u8]) -> Option<Self> {
        let mut fields = Fields(content);
        Some(Self {
            id: fields.u16()?,
            schema: fields.u16()?,
            topic: fields.text()?,
            encoding: fields.text()?,
        })
    }
}

impl MessageHead {
    pub(super) fn read(content: &[u8]) -> Option<Self> {
        let mut fields = Fields(content);
        let channel = fields.u16()?;
        fields.u32()?;
        Some(Self { channel, log_time_ns: fields.u64()? })
    }
}

impl ChunkHead {
    pub(super) fn read(content: &[u8]) -> Option<Self> {
        let mut fields = Fields(content.get(16..)?);
        Some(Self {
            unpacked: fields.u64()?,
            crc: fields.u32()?,
            name_bytes: fields.u32()? as usize,
        })
    }
}
