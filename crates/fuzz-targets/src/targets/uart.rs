//! Packets: the stream gives the same in pieces as in one, and accounts for every byte.

use boresight_formats::{BoardLog, UartStream};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let (size, bytes) = match bytes.split_first() {
        Some((&first, rest)) => (usize::from(first) + 1, rest),
        None => return,
    };
    let log = BoardLog::parse(bytes, None);
    let mut stream = UartStream::new(None);
    let mut frames: Vec<_> = bytes.chunks(size).flat_map(|piece| stream.push(piece)).collect();
    frames.extend(stream.finish());
    assert_eq!(frames.len(), log.frames.len());
    assert_eq!(stream.counts().skipped_bytes, log.counts.skipped_bytes);
    assert_eq!(stream.counts().damaged_packets, log.counts.damaged_packets);
    assert!(log.counts.skipped_bytes <= bytes.len() as u64);
    assert!(log.counts.skipped_bytes + 36 * frames.len() as u64 <= bytes.len() as u64);
}
