#[path = "../../../../tests/support/size.rs"]
mod size;

use super::made::{channel, chunk, chunk_of, file, message, packed, record, schema, statistics};
use super::{Channel, MAGIC, McapCounts, McapSink, McapStream, Message, Schema};
use crate::error::FormatError;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// What came of a file.
#[derive(Debug, Default, PartialEq, Clone)]
struct Seen {
    channels: Vec<(u16, String, Option<String>)>,
    messages: Vec<(u16, u64, Vec<u8>)>,
    /// Messages of each wanted topic that are taken.
    most: Option<usize>,
}

impl McapSink for Seen {
    fn channel(&mut self, channel: &Channel, schema: Option<&Schema>) -> bool {
        let schema = schema.map(|schema| schema.name.clone());
        self.channels.push((channel.id, channel.topic.clone(), schema));
        !channel.topic.contains("image")
    }

    fn message(&mut self, message: Message<'_>) -> bool {
        let Message { channel, log_time_ns, data } = message;
        self.messages.push((channel, log_time_ns, data.to_vec()));
        self.most.is_none_or(|most| self.messages.len() < most)
    }
}

fn read_in(bytes: &[u8], piece: usize) -> Result<(Seen, McapCounts), FormatError> {
    let (mut seen, mut stream) = (Seen::default(), McapStream::default());
    for piece in bytes.chunks(piece.max(1)) {
        stream.push(piece, &mut seen)?;
    }
    let counts = stream.finish(&mut seen).clone();
    Ok((seen, counts))
}

fn read(bytes: &[u8]) -> (Seen, McapCounts) {
    read_in(bytes, usize::MAX).unwrap()
}

fn codes(counts: &McapCounts) -> Vec<&'static str> {
    counts.remarks().iter().map(|remark| remark.code).collect()
}

fn names() -> [Vec<u8>; 4] {
    [
        schema(1, "a/A", "ros2msg", "int8 a"),
        channel(1, 1, "/radar", "cdr"),
        channel(2, 0, "/image", "jpeg"),
        channel(3, 9, "/other", "cdr"),
    ]
}

/// Radar messages between images of 3000 bytes, ten chunks of three each.
/// The messages of [`recording`]: channel, time, data.
fn written() -> Vec<(u16, u64, Vec<u8>)> {
    let of = |k: u8| {
        let time = u64::from(k);
        [(1, time, vec![k; 40]), (2, 5, vec![k; 3000]), (1, time + 100, vec![])]
    };
    (0..10).flat_map(of).collect()
}

/// Where the opcodes of a file's own records are, those of chunks left out.
fn opcodes(bytes: &[u8]) -> Vec<usize> {
    let mut found = vec![];
    let mut at = MAGIC.len();
    while let Some(length) = bytes.get(at + 1..at + 9).and_then(|bytes| bytes.try_into().ok()) {
        if bytes[at] != 6 {
            found.push(at);
        }
        at += 9 + u64::from_le_bytes(length) as usize;
    }
    found
}

fn recording(compression: &str) -> Vec<u8> {
    let mut data = names().to_vec();
    for three in written().chunks(3) {
        let records: Vec<_> =
            three.iter().map(|(channel, time, data)| message(*channel, *time, data)).collect();
        data.push(match compression {
            "outside" => records.concat(),
            _ => chunk(compression, &records.concat()),
        });
        // An index, an attachment and an opcode of the future.
        data.extend([record(7, &[1; 30]), record(9, &[2; 500]), record(0x77, &[3; 9])]);
    }
    file(&data, &[names().to_vec(), vec![statistics(30)]].concat())
}

const COMPRESSIONS: [&str; 4] = ["outside", "", "lz4", "zstd"];

#[test]
fn wanted_messages_come_in_order_however_they_are_packed_and_cut() {
    let mut first = None;
    for compression in COMPRESSIONS {
        let bytes = recording(compression);
        let (seen, counts) = read(&bytes);
        assert_eq!(seen.messages.len(), 20);
        assert_eq!(seen.messages[2], (1, 1, vec![1; 40]));
        assert_eq!(seen.messages[3], (1, 101, vec![]));
        assert_eq!(seen.channels[0], (1, "/radar".into(), Some("a/A".into())));
        assert_eq!(seen.channels.len(), 3);
        assert_eq!(counts.messages, 30);
        assert_eq!(counts.chunks, if compression == "outside" { 0 } else { 10 });
        assert!(counts.complete && counts.bytes == bytes.len() as u64);
        assert_eq!(codes(&counts), [""; 0], "{compression}");
        for piece in [1, 7, 100, 4096] {
            assert_eq!(read_in(&bytes, piece).unwrap(), (seen.clone(), counts.clone()), "{piece}");
        }
        assert_eq!(first.get_or_insert(seen.clone()), &seen);
    }
}

#[test]
fn what_the_crate_of_the_format_writes_is_read() {
    use std::io::Cursor;
    let mut writer = mcap::WriteOptions::new().compression(None).chunk_size(Some(500));
    writer = writer.profile("x");
    let mut writer = writer.create(Cursor::new(vec![])).unwrap();
    let kind = writer.add_schema("a/A", "ros2msg", b"int8 a").unwrap();
    let radar = writer.add_channel(kind, "/radar", "cdr", &[].into()).unwrap();
    let image = writer.add_channel(0, "/image", "jpeg", &[].into()).unwrap();
    for k in 0..100 {
        for id in [radar, image] {
            let head = mcap::records::MessageHeader {
                channel_id: id,
                sequence: k,
                log_time: u64::from(k),
                publish_time: 3,
            };
            writer.write_to_known_channel(&head, &[k as u8; 33]).unwrap();
        }
    }
    writer.finish().unwrap();
    let bytes = writer.into_inner().into_inner();
    let (seen, counts) = read(&bytes);
    let expected: Vec<_> = (0..100).map(|k| (radar, k, vec![k as u8; 33])).collect();
    assert_eq!(seen.messages, expected);
    assert!(counts.complete && counts.messages == 200 && counts.chunks > 3);
    assert_eq!((counts.stated_messages, codes(&counts)), (Some(200), vec![]));
}

#[test]
fn what_is_wanted_no_more_is_passed_over_and_counted() {
    for compression in COMPRESSIONS {
        let mut seen = Seen { most: Some(3), ..Seen::default() };
        let mut stream = McapStream::default();
        stream.push(&recording(compression), &mut seen).unwrap();
        assert_eq!(seen.messages.len(), 3);
        assert_eq!(stream.finish(&mut seen).messages, 30);
        let counts: Vec<_> = stream.channels().map(|(c, _, n)| (c.topic.clone(), n)).collect();
        assert_eq!(counts, [("/radar".into(), 20), ("/image".into(), 10), ("/other".into(), 0)]);
    }
}

#[test]
fn a_cut_file_is_read_as_far_as_it_goes() {
    for compression in COMPRESSIONS {
        let bytes = recording(compression);
        let whole = read(&bytes).0;
        let mut before = 0;
        // Records are not multiples of seven long.
        for end in (MAGIC.len()..bytes.len()).step_by(size::sized(1, 7)) {
            let (seen, counts) = read_in(&bytes[..end], 333).unwrap();
            assert_eq!(seen.messages, whole.messages[..seen.messages.len()]);
            assert!(seen.messages.len() >= before, "{compression} {end}");
            before = seen.messages.len();
            assert!(!counts.complete && codes(&counts).contains(&"cut-file"), "{end}");
            assert!(counts.lost_bytes < 10_000 && counts.damaged_chunks == 0, "{end}");
        }
        assert_eq!(before, 20);
    }
    // Half of an unpacked chunk: what stands before the cut is there.
    let chunk = chunk("", &(0..9).flat_map(|k| message(1, k, &[5; 50])).collect::<Vec<_>>());
    let start = [MAGIC.to_vec(), names().concat()].concat();
    let (seen, counts) = read(&[start, chunk[..chunk.len() / 2].to_vec()].concat());
    assert_eq!((seen.messages.len(), counts.messages), (4, 4));
}

#[test]
fn damaged_chunks_are_left_out_and_counted() {
    for compression in ["", "lz4", "zstd"] {
        let records = message(1, 8, &[9; 400]);
        let good = chunk(compression, &records);
        let mut bad = good.clone();
        let last = bad.len() - 4;
        bad[last] ^= 1;
        let bytes = file(&[names().concat(), good.clone(), bad, good], &[statistics(3)]);
        let (seen, counts) = read(&bytes);
        assert_eq!((seen.messages.len(), counts.messages, counts.damaged_chunks), (2, 2, 1));
        assert_eq!(codes(&counts), ["damaged-chunks", "missing-messages"], "{compression}");
    }
    // A channel that a damaged chunk names may be another one.
    let records = [channel(5, 1, "/radbr", "cdr"), message(5, 1, &[1])].concat();
    let wrong = record(6, &chunk_of("", records.len() as u64, 99, &records));
    let right = chunk("", &[channel(5, 1, "/radar", "cdr"), message(5, 2, &[2])].concat());
    let (seen, counts) = read(&file(&[wrong, right], &[]));
    assert_eq!(seen.messages, [(5, 2, vec![2])]);
    assert_eq!((counts.damaged_chunks, counts.messages), (1, 1));
}

#[test]
fn a_wrong_sum_of_the_data_is_told() {
    let mut bytes = recording("outside");
    let place = bytes.windows(4).position(|window| window == [3; 4]).unwrap();
    bytes[place] ^= 1;
    assert_eq!(codes(&read(&bytes).1), ["wrong-sum"]);
}

#[test]
fn what_is_no_file_is_refused_and_damage_ends_the_reading() {
    let error = read_in(b"PK\x03\x04 and so on", 3).unwrap_err();
    assert!(matches!(error, FormatError::Binary { format: "MCAP", .. }), "{error}");
    assert!(read_in(b"\x89MC", 2).is_ok());
    let start = [MAGIC.to_vec(), names().concat(), message(1, 1, &[1])].concat();
    for (bad, what) in [
        (record(5, &[0; 21]), "the length of a message"),
        (record(6, &[0; 31]), "the length of a chunk"),
        (record(0, &[0; 31]), "the opcode of a record"),
        (record(3, &[1, 0, 255, 255, 0, 0]), "a schema or a channel"),
        (record(6, &[&[0; 28], &[255; 4][..], &[0; 300]].concat()), "the head of a chunk"),
        (record(6, &[&chunk_of("", 4, 0, &[1; 4])[..], &[0]].concat()), "the length of a chunk"),
        ([record(2, &[0; 20]), b"no magic".to_vec()].concat(), "the magic bytes at the end"),
    ] {
        let (seen, counts) = read(&[start.clone(), bad, vec![1; 77]].concat());
        assert_eq!(seen.messages.len(), 1, "{what}");
        assert_eq!(counts.damage.map(|damage| damage.1), Some(what));
        assert!(counts.lost_bytes >= 77 && codes(&counts)[0] == "damaged-file", "{counts:?}");
    }
}

#[test]
fn bombs_cost_little() {
    let names = names().concat();
    // Lengths that no file has.
    for opcode in [3, 4, 5, 6, 9, 0x80] {
        let head = [&[opcode], &u64::MAX.to_le_bytes()[..], &[0; 4000]].concat();
        let (seen, counts) = read(&[MAGIC.to_vec(), names.clone(), head].concat());
        assert!(seen.messages.is_empty() && !counts.complete);
    }
    // A chunk that is more than it says, and ones that say to be more than is read.
    let zeros = vec![0; 1 << 20];
    let bomb = packed("zstd", &zeros);
    assert!(bomb.len() < 2000);
    for (unpacked, damaged, unread) in [(1000, 1, 0), (1 << 40, 0, 1), (u64::MAX, 0, 1)] {
        let chunk = record(6, &chunk_of("zstd", unpacked, 0, &bomb));
        let (_, counts) = read(&file(&[chunk], &[]));
        assert_eq!((counts.damaged_chunks, counts.unread_chunks), (damaged, unread));
    }
    let unknown = record(6, &chunk_of("brotli", 10, 0, &[1; 10]));
    let (_, counts) = read(&file(&[unknown], &[]));
    assert_eq!(codes(&counts), ["unread-chunks"]);
    // A chunk in a chunk.
    let nested = chunk("lz4", &chunk("lz4", &message(1, 1, &[1])));
    assert_eq!(read(&file(&[names.clone(), nested], &[])).1.damaged_chunks, 1);
    // Many chunks that each unpack to what one may.
    let whole = record(6, &chunk_of("zstd", 1 << 20, 0, &bomb));
    let (_, counts) = read(&file(&vec![whole; 300], &[]));
    assert_eq!(counts.damaged_chunks + counts.unread_chunks, 300, "zeros are no records");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(19), failure_persistence: None, ..ProptestConfig::default() })]

    /// Bits that flip anywhere: each message as it was written unless nothing checks it, and the same in pieces as in one.
    /// Which channels are wanted goes by names outside of chunks, which nothing checks. (A length there that flips makes a
    /// message of what is none in one of 170,000 cases, so the cases are always the same.)
    #[test]
    fn flipped_bits_are_met_alike_in_pieces_and_in_one(
        kind in 0..4_usize,
        flips in proptest::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 1..4),
        piece in 1..500_usize,
    ) {
        let mut bytes = recording(COMPRESSIONS[kind]);
        // Outside of chunks a flipped opcode makes a message of another record, which nothing checks either.
        let opcodes = opcodes(&bytes);
        for (place, bit) in flips {
            let at = MAGIC.len() + place.index(bytes.len() - MAGIC.len());
            if kind == 0 || !opcodes.contains(&at) {
                bytes[at] ^= 1 << bit;
            }
        }
        let one = read_in(&bytes, usize::MAX);
        let many = read_in(&bytes, piece);
        prop_assert_eq!(&one, &many);
        if let Ok((seen, counts)) = one {
            prop_assert!(counts.lost_bytes <= counts.bytes);
            if kind > 0 && counts.damage.is_none() {
                // Within chunks all is checked.
                let changed = |message: &&(u16, u64, Vec<u8>)| !written().contains(message);
                prop_assert_eq!(seen.messages.iter().filter(changed).count(), 0);
            }
        }
    }

    #[test]
    fn any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..2000), piece in 1..99_usize) {
        let bytes = [&MAGIC[..], &bytes].concat();
        prop_assert_eq!(read_in(&bytes, piece), read_in(&bytes, usize::MAX));
    }
}
