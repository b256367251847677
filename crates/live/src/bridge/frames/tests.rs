use super::*;
use crate::bridge::packet::write_header;

const FRAME: usize = 10_000;
const PAYLOAD: usize = 1456;

/// Samples of `frames` frames, no two alike.
fn stream(frames: usize) -> Vec<u8> {
    (0..frames * FRAME).map(|k| (k % 251) as u8 ^ (k / FRAME) as u8).collect()
}

/// Packets of a card from its start.
fn packets(samples: &[u8]) -> Vec<Vec<u8>> {
    samples
        .chunks(PAYLOAD)
        .zip(1_u32..)
        .map(|(chunk, sequence)| {
            let offset = u64::from(sequence - 1) * PAYLOAD as u64;
            [&write_header(sequence, offset)[..], chunk].concat()
        })
        .collect()
}

fn assembled<'a>(packets: impl IntoIterator<Item = &'a Vec<u8>>) -> (Vec<Frame>, Counts) {
    let mut assembler = FrameAssembler::new(FRAME as u64).unwrap();
    let frames = packets.into_iter().flat_map(|packet| assembler.push(packet)).collect();
    (frames, assembler.counts())
}

fn expected(samples: &[u8], numbers: impl IntoIterator<Item = usize>) -> Vec<Frame> {
    numbers
        .into_iter()
        .map(|k| Frame { number: k as u64, samples: samples[k * FRAME..(k + 1) * FRAME].to_vec() })
        .collect()
}

#[test]
fn what_comes_whole_is_given_whole() {
    let samples = stream(50);
    let all = packets(&samples);
    let (frames, counts) = assembled(&all);
    assert_eq!(frames, expected(&samples, 0..50));
    let bytes = samples.len() as u64;
    assert_eq!(
        counts,
        Counts { packets: all.len() as u64, bytes, frames: 50, ..Counts::default() }
    );
}

#[test]
fn a_lost_packet_costs_its_frames_and_no_other() {
    let samples = stream(50);
    let all = packets(&samples);
    // Packet 68 is on the border of frames 9 and 10; packet 100 within frame 14.
    let lost = [68, 100];
    assert!(lost[0] * PAYLOAD < 10 * FRAME && (lost[0] + 1) * PAYLOAD > 10 * FRAME);
    let kept = all.iter().enumerate().filter(|(k, _)| !lost.contains(k)).map(|(_, packet)| packet);
    let (frames, counts) = assembled(kept);
    assert_eq!(frames, expected(&samples, (0..50).filter(|k| ![9, 10, 14].contains(k))));
    assert_eq!((counts.lost_packets, counts.lost_bytes), (2, 2 * PAYLOAD as u64));
    assert_eq!((counts.damaged_frames, counts.frames), (3, 47));
}

#[test]
fn a_long_loss_is_counted_as_long_as_it_is() {
    let samples = stream(2000);
    let all = packets(&samples);
    let kept = all[..1000].iter().chain(&all[9000..]);
    let (frames, counts) = assembled(kept);
    assert_eq!((counts.lost_packets, counts.lost_bytes), (8000, 8000 * PAYLOAD as u64));
    assert_eq!(counts.frames + counts.damaged_frames, 2000);
    let (before, after) = (1000 * PAYLOAD / FRAME, (9000 * PAYLOAD).div_ceil(FRAME));
    assert_eq!(frames, expected(&samples, (0..before).chain(after..2000)));
}

#[test]
fn another_order_and_copies_change_nothing() {
    let samples = stream(50);
    let mut all = packets(&samples);
    // Each seventh packet comes forty later, each fifth twice.
    let mut order: Vec<(usize, usize)> =
        (0..all.len()).map(|k| (if k % 7 == 3 { 2 * k + 81 } else { 2 * k }, k)).collect();
    order.extend((0..all.len()).filter(|k| k % 5 == 0).map(|k| (2 * k + 91, k)));
    order.sort_unstable();
    let (frames, counts) = assembled(order.iter().map(|&(_, k)| &all[k]));
    assert_eq!(frames, expected(&samples, 0..50));
    assert_eq!((counts.lost_packets, counts.lost_bytes, counts.damaged_frames), (0, 0, 0));
    let copies = (0..all.len()).filter(|k| k % 5 == 0).count() as u64;
    assert_eq!(counts.duplicates, copies);
    let late = (0..all.len() - 40).filter(|k| k % 7 == 3).count() as u64;
    assert!(counts.reordered >= late, "{} of {late}", counts.reordered);
    // Beyond the window a packet is lost to its frame, though it came.
    let one = all.remove(20);
    all.insert(120, one);
    let (frames, counts) = assembled(&all);
    assert_eq!(frames, expected(&samples, (0..50).filter(|k| ![2, 3].contains(k))));
    assert_eq!((counts.lost_packets, counts.reordered, counts.damaged_frames), (0, 1, 2));
}

#[test]
fn a_card_that_is_started_again_begins_at_frame_0() {
    let samples = stream(50);
    let all = packets(&samples);
    let (frames, counts) = assembled(all[..200].iter().chain(&all));
    assert_eq!(frames[200 * PAYLOAD / FRAME..], expected(&samples, 0..50));
    assert_eq!((counts.restarts, counts.damaged_frames, counts.lost_packets), (1, 1, 0));
    // Without its first packets, too.
    let long = stream(500);
    let first = packets(&long);
    let (frames, counts) = assembled(first[..2000].iter().chain(&all[5..]));
    assert_eq!(counts.restarts, 1);
    assert_eq!(frames[2000 * PAYLOAD / FRAME..], expected(&samples, 1..50));
}

#[test]
fn a_card_that_ran_before_gives_its_next_whole_frame() {
    let samples = stream(50);
    let all = packets(&samples);
    let (frames, counts) = assembled(&all[100..]);
    assert_eq!(frames, expected(&samples, (100 * PAYLOAD).div_ceil(FRAME)..50));
    assert_eq!((counts.lost_packets, counts.lost_bytes, counts.damaged_frames), (0, 0, 0));
}

#[test]
fn what_no_card_sends_is_counted_and_costs_no_memory() {
    let samples = stream(50);
    let all = packets(&samples);
    let mut assembler = FrameAssembler::new(FRAME as u64).unwrap();
    for packet in &all[..20] {
        assembler.push(packet);
    }
    let mut wrong = vec![vec![], vec![1, 2, 3], write_header(21, 20 * PAYLOAD as u64).to_vec()];
    // Places that do not go with the numbers: ahead, behind, at the end of what there is.
    for offset in [0, 19 * PAYLOAD as u64, 21 * PAYLOAD as u64 + 70_000, (1 << 48) - 1] {
        wrong.push([&write_header(21, offset)[..], &[0; PAYLOAD]].concat());
    }
    for packet in &wrong {
        assert_eq!(assembler.push(packet), []);
    }
    assert_eq!(assembler.counts().malformed, wrong.len() as u64);
    let rest: Vec<Frame> = all[20..].iter().flat_map(|packet| assembler.push(packet)).collect();
    assert_eq!(rest, expected(&samples, 20 * PAYLOAD / FRAME..50));
    // A number far ahead begins a run that the card's own next packet ends.
    assembler.push(&[&write_header(u32::MAX, 1 << 40)[..], &[0; PAYLOAD]].concat());
    let again: Vec<Frame> = all[50..].iter().flat_map(|packet| assembler.push(packet)).collect();
    assert_eq!(again, expected(&samples, (50 * PAYLOAD).div_ceil(FRAME)..50));
    let counts = assembler.counts();
    assert_eq!((counts.restarts, counts.lost_packets), (2, 0));
}

#[test]
fn frames_that_cannot_be_are_refused() {
    for given in [0, MOST_FRAME_BYTES + 1, u64::MAX] {
        assert!(matches!(FrameAssembler::new(given), Err(LiveError::FrameSize { .. })));
    }
}

#[test]
fn any_packets_at_all_are_taken_without_harm() {
    // A linear congruential generator (Knuth): numbers near each other, so that all branches are met.
    let mut state = 7_u64;
    let mut draw = |below: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    let mut assembler = FrameAssembler::new(1000).unwrap();
    for _ in 0..40_000 {
        let below = if draw(50) == 0 { 1 << 32 } else { 5000 };
        let sequence = draw(below) as u32;
        let offset = if draw(20) == 0 { draw(1 << 48) } else { u64::from(sequence) * 100 };
        let length = draw(300) as usize;
        let packet = [&write_header(sequence, offset)[..], &vec![0; length]].concat();
        assembler.push(&packet);
        assert!(assembler.parts.len() < 100_000);
    }
    let counts = assembler.counts();
    assert_eq!(counts.packets + counts.duplicates + counts.malformed, 40_000);
}
