//! Files made for tests, by the text of the specification, apart from what reads them.

use std::io::Write;

/// A record.
pub fn record(opcode: u8, content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u64).to_le_bytes();
    [&[opcode], &length[..], content].concat()
}

/// A text, or bytes, with the length before it.
pub fn text(bytes: impl AsRef<[u8]>) -> Vec<u8> {
    let bytes = bytes.as_ref();
    [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
}

pub fn header() -> Vec<u8> {
    record(1, &[text("ros2"), text("made")].concat())
}

pub fn schema(id: u16, name: &str, encoding: &str, definition: &str) -> Vec<u8> {
    let id = id.to_le_bytes().to_vec();
    record(3, &[id, text(name), text(encoding), text(definition)].concat())
}

pub fn channel(id: u16, schema: u16, topic: &str, encoding: &str) -> Vec<u8> {
    let (id, schema) = (id.to_le_bytes().to_vec(), schema.to_le_bytes().to_vec());
    record(4, &[id, schema, text(topic), text(encoding), text("")].concat())
}

pub fn message(channel: u16, time_ns: u64, data: &[u8]) -> Vec<u8> {
    let time = time_ns.to_le_bytes();
    record(5, &[&channel.to_le_bytes(), &[7, 0, 0, 0][..], &time, &time, data].concat())
}

pub fn packed(compression: &str, records: &[u8]) -> Vec<u8> {
    match compression {
        "lz4" => {
            let mut packer = lz4_flex::frame::FrameEncoder::new(vec![]);
            packer.write_all(records).unwrap();
            packer.finish().unwrap()
        }
        "zstd" => {
            let level = ruzstd::encoding::CompressionLevel::Fastest;
            ruzstd::encoding::compress_to_vec(records, level)
        }
        _ => records.to_vec(),
    }
}

/// The content of a chunk.
pub fn chunk_of(compression: &str, unpacked: u64, crc: u32, packed: &[u8]) -> Vec<u8> {
    let stored = (packed.len() as u64).to_le_bytes();
    let head = [&[0; 16], &unpacked.to_le_bytes()[..], &crc.to_le_bytes()].concat();
    [&head, &*text(compression), &stored, packed].concat()
}

pub fn chunk(compression: &str, records: &[u8]) -> Vec<u8> {
    let crc = crc32fast::hash(records);
    record(6, &chunk_of(compression, records.len() as u64, crc, &packed(compression, records)))
}

/// Messages in all channels, as the statistics of a file count them.
pub fn statistics(messages: u64) -> Vec<u8> {
    record(11, &[&messages.to_le_bytes()[..], &[0; 38]].concat())
}

/// A whole file around the records of its data and of its summary.
pub fn file(data: &[Vec<u8>], summary: &[Vec<u8>]) -> Vec<u8> {
    let data = [super::MAGIC.to_vec(), header(), data.concat()].concat();
    let end = record(15, &crc32fast::hash(&data).to_le_bytes());
    [data, end, summary.concat(), record(2, &[0; 20]), super::MAGIC.to_vec()].concat()
}
