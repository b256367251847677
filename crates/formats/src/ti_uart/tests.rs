use super::*;

const DAT: &[u8] =
    include_bytes!("../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat");
const CFG: &[u8] = include_bytes!("../../../../recordings/awr1642/profile.cfg");
/// First byte of the first packet, and bytes of a packet.
const FIRST: usize = 248;
const PACKET: usize = 704;

fn config() -> RadarConfig {
    RadarConfig::parse(CFG).unwrap()
}

#[test]
fn every_recorded_frame_has_the_two_objects() {
    let log = BoardLog::parse(DAT, Some(&config()));
    assert_eq!(log.frames.len(), 250);
    assert!(log.frames.iter().take(249).all(|frame| frame.complete));
    assert!(!log.frames[249].complete);
    assert_eq!(log.counts.damaged_packets, 1);
    // Before the first packet, and the part of the last one that is not whole.
    assert_eq!(log.counts.skipped_bytes, 248 + 132);
    for (frame, number) in log.frames.iter().zip(0x1ce_u32..) {
        assert_eq!((frame.frame_number, frame.platform.as_str()), (number, "xWR16xx"));
        assert_eq!(frame.sdk_version, [2, 0, 0, 4]);
        let near = |range_m: f64| {
            frame.objects.iter().find(|o| (o.range_m - range_m).abs() < 0.02).unwrap()
        };
        let first = near(2.953);
        assert!((first.azimuth_rad.to_degrees() + 10.79).abs() < 0.1, "{first:?}");
        assert_eq!(
            (first.range_bin, first.doppler_bin, first.rate_mps),
            (Some(58), Some(0), Some(0.0))
        );
        assert!((first.x_m - 1485.0 / 512.0).abs() < 1e-12);
        assert!((first.y_m + 283.0 / 512.0).abs() < 1e-12);
        let second = near(4.938);
        assert!(second.y_m > 0.0 && second.azimuth_rad.to_degrees() < 5.0, "{second:?}");
    }
    let last = log.frames[249]
        .objects
        .iter()
        .find(|o| (o.range_bin, o.doppler_bin) == (Some(97), Some(0)))
        .unwrap();
    assert!((last.azimuth_rad.to_degrees() - 1.79).abs() < 0.3, "{last:?}");
}

#[test]
fn profile_and_timing_are_read() {
    let log = BoardLog::parse(DAT, None);
    let frame = &log.frames[0];
    let profile = frame.range_profile_db.as_ref().unwrap();
    assert_eq!(profile.len(), 256);
    let peak = (20..256).max_by(|&a, &b| profile[a].total_cmp(&profile[b])).unwrap();
    assert_eq!(peak, 58);
    assert!((frame.stats.unwrap().processing_s - 0x0eba as f64 * 1e-6).abs() < 1e-12);
    assert_eq!(frame.objects[0].rate_mps, None);
    assert_eq!(log.frames[249].range_profile_db, None);
}

#[test]
fn any_cut_of_the_stream_gives_the_same_frames() {
    let whole = BoardLog::parse(DAT, None);
    for size in [1, 7, 703, 705, 4096] {
        let mut stream = UartStream::new(None);
        let mut frames: Vec<_> = DAT.chunks(size).flat_map(|piece| stream.push(piece)).collect();
        frames.extend(stream.finish());
        assert_eq!(frames, whole.frames, "{size}");
        assert_eq!(stream.counts().skipped_bytes, whole.counts.skipped_bytes);
        assert_eq!(stream.counts().damaged_packets, whole.counts.damaged_packets);
    }
}

#[test]
fn lost_bytes_cost_one_packet() {
    let three = &DAT[FIRST..FIRST + 3 * PACKET];
    for lost in [20..24, 50..60, 300..301] {
        let cut: Vec<u8> = three
            .iter()
            .enumerate()
            .filter(|(k, _)| !lost.contains(&k.wrapping_sub(PACKET)))
            .map(|(_, &byte)| byte)
            .collect();
        let log = BoardLog::parse(&cut, None);
        let numbers: Vec<u32> = log.frames.iter().map(|f| f.frame_number).collect();
        assert_eq!(numbers, [0x1ce, 0x1d0], "{lost:?}");
        assert_eq!(log.counts.damaged_packets, 1);
        assert_eq!(log.counts.skipped_bytes, (PACKET - lost.len()) as u64);
    }
}

#[test]
fn garbage_between_packets_is_skipped() {
    let packet = &DAT[FIRST..FIRST + PACKET];
    let mut bytes = packet.to_vec();
    bytes.extend([7; 1000]);
    bytes.extend(MAGIC);
    bytes.extend([0xff; 50]);
    bytes.extend(packet);
    let log = BoardLog::parse(&bytes, None);
    assert_eq!(
        (log.frames.len(), log.counts.skipped_bytes, log.counts.damaged_packets),
        (2, 1058, 1)
    );
}

#[test]
fn an_endless_stream_of_nothing_keeps_no_memory() {
    let mut stream = UartStream::new(None);
    for _ in 0..1000 {
        assert!(stream.push(&[2; 1000]).is_empty());
    }
    assert_eq!(stream.counts().skipped_bytes, 999_993);
}

fn packet(version: u32, parts: &[(u32, Vec<u8>)], objects: u32, with_sub_frame: bool) -> Vec<u8> {
    let mut body = vec![];
    for (kind, payload) in parts {
        body.extend(kind.to_le_bytes());
        body.extend((payload.len() as u32).to_le_bytes());
        body.extend(payload);
    }
    let header = if with_sub_frame { 40 } else { 36 };
    let length = (header + body.len()).next_multiple_of(32);
    let mut bytes = MAGIC.to_vec();
    for word in [version, length as u32, 0xa_1843, 9, 0, objects, parts.len() as u32] {
        bytes.extend(word.to_le_bytes());
    }
    if with_sub_frame {
        bytes.extend(0_u32.to_le_bytes());
    }
    bytes.extend(body);
    // Padding is whatever was in memory: here a magic word.
    bytes.extend(MAGIC);
    bytes.resize(length.max(bytes.len()), 0x0f);
    bytes.truncate(length);
    bytes
}

#[test]
fn points_of_sdk_3_come_with_their_side_information() {
    let floats: Vec<u8> =
        [1.0_f32, 2.0, 0.5, -3.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    let side = vec![0xdc, 0x00, 0x10, 0x00];
    let bytes = packet(0x0306_0000, &[(1, floats.clone()), (7, side)], 1, true);
    let log = BoardLog::parse(&bytes, None);
    let object = log.frames[0].objects[0];
    assert_eq!((object.x_m, object.y_m, object.z_m), (2.0, -1.0, 0.5));
    assert_eq!((object.rate_mps, object.snr_db), (Some(-3.0), Some(22.0)));
    assert!((object.azimuth_rad + 0.5_f64.atan()).abs() < 1e-12);
    assert_eq!(log.frames[0].platform, "xWR18xx");
    assert_eq!(log.counts.damaged_packets, 0);

    let lying = packet(0x0306_0000, &[(1, floats)], 1000, true);
    assert_eq!(BoardLog::parse(&lying, None).counts.damaged_packets, 1);
}

#[test]
fn headers_without_sub_frame_number_and_empty_frames_are_read() {
    let empty = packet(0x0101_0000, &[(1, vec![0, 0, 9, 0])], 0, false);
    let log = BoardLog::parse(&empty, None);
    assert_eq!((log.frames.len(), log.counts.damaged_packets), (1, 0));
    assert_eq!(log.frames[0].objects, []);
    let none = packet(0x0306_0000, &[], 0, true);
    assert_eq!(BoardLog::parse(&none, None).frames.len(), 1);
}

#[test]
fn maps_come_in_the_units_of_the_profile() {
    // One range bin on four antennas, Q before I; two range bins of four Doppler bins.
    let heat: Vec<u8> = [2_i16, 1, -4, 3, 0, 0, i16::MIN, i16::MAX]
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    let words: Vec<u8> = (0..8_u16).flat_map(|word| (256 * 12 * word).to_le_bytes()).collect();
    let profile = words[..2 * 2].to_vec();
    let parts = [(2, profile), (4, heat), (5, words)];
    let frame = &BoardLog::parse(&packet(0x0201_0000, &parts, 0, true), None).frames[0];
    let expected = [1.0, 2.0, 3.0, -4.0, 0.0, 0.0, f32::from(i16::MAX), f32::from(i16::MIN)];
    assert_eq!(frame.azimuth_heat_map.as_deref(), Some(&expected[..]));
    let map = frame.range_doppler_db.as_ref().unwrap();
    // The sum of log2 |x| over twelve antennas, in Q8: a factor of two is 6.02 dB.
    for (count, db) in map.iter().enumerate() {
        assert!((db - 20.0 * (count as f64) * 2_f64.log10()).abs() < 1e-9, "{count}: {db}");
    }
    assert_eq!(frame.range_profile_db.as_deref(), Some(&map[..2]));
    let odd = packet(0x0201_0000, &[(5, vec![0; 7])], 0, true);
    let log = BoardLog::parse(&odd, None);
    assert!(log.frames.is_empty() && log.counts.damaged_packets > 0, "{:?}", log.counts);
}

#[test]
fn a_packet_of_a_short_header_alone_is_read() {
    // Of SDK 1, whose headers have 36 bytes, with no part.
    let words = [0x0100_0005, 36, 0xa_1642, 7, 0, 0, 0];
    let mut packet = MAGIC.to_vec();
    packet.extend(words.iter().flat_map(|word: &u32| word.to_le_bytes()));
    let log = BoardLog::parse(&packet, None);
    assert_eq!((log.frames.len(), log.counts.skipped_bytes), (1, 0), "{log:?}");
}
