//! Whatever the bytes, readers return: no panic, nothing allocated on a header's word.

#![allow(clippy::unwrap_used)]

use boresight_formats::drive_log::open;
use boresight_formats::hdf5;
use boresight_formats::tables::{read_detections, read_snapshots};
use boresight_formats::ti_uart::MAGIC;
use boresight_formats::{BoardLog, Capture, NpyArray, PointCloud, RadarConfig, UartStream, npy};
use proptest::prelude::*;

const CFG: &[u8] = include_bytes!("../../../recordings/awr1642/profile.cfg");
const DAT: &[u8] =
    include_bytes!("../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat");

const ASCII_CLOUD: &[u8] = include_bytes!("../../../fuzz/seeds/pcd/ascii.pcd");
const BINARY_CLOUD: &[u8] = include_bytes!("../../../fuzz/seeds/pcd/nuscenes.pcd");
const PACKED_CLOUD: &[u8] = include_bytes!("../../../fuzz/seeds/pcd/packed.pcd");

fn every_reader(bytes: &[u8]) {
    let recorded = RadarConfig::parse(CFG).unwrap();
    let _ = NpyArray::parse(bytes);
    let _ = PointCloud::parse(bytes);
    let _ = hdf5::list(bytes.to_vec());
    let _ = open(&[("00549.bin", bytes)], None);
    let _ = read_detections(bytes);
    let _ = read_snapshots(bytes);
    let _ = BoardLog::parse(bytes, Some(&recorded));
    if let Ok(config) = RadarConfig::parse(bytes) {
        assert!(config.waveform.check().is_ok());
        let _ = Capture::new(bytes, &config).map(|capture| capture.frame(0));
    }
    if let Ok(capture) = Capture::new(bytes, &recorded) {
        assert_eq!(capture.frames() * 131_072 + capture.trailing_bytes(), bytes.len());
    }
}

/// Some bytes of a file, replaced, removed or inserted.
fn mutated(file: &'static [u8]) -> impl Strategy<Value = Vec<u8>> {
    let edit = (any::<prop::sample::Index>(), any::<u8>(), 0..3_u8);
    (proptest::collection::vec(edit, 1..12), any::<prop::sample::Index>()).prop_map(
        move |(edits, end)| {
            let mut bytes = file.to_vec();
            for (place, value, kind) in edits {
                if bytes.is_empty() {
                    break;
                }
                let at = place.index(bytes.len());
                match kind {
                    0 => bytes[at] = value,
                    1 => drop(bytes.remove(at)),
                    _ => bytes.insert(at, value),
                }
            }
            bytes.truncate(bytes.len() - end.index(bytes.len() + 1) / 4);
            bytes
        },
    )
}

fn npy_file() -> &'static [u8] {
    use std::sync::OnceLock;
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    FILE.get_or_init(|| npy::write(&[2, 3], &[1.0_f64, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200, failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn readers_survive_garbage(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        every_reader(&bytes);
    }

    #[test]
    fn readers_survive_edited_configurations(bytes in mutated(CFG)) {
        every_reader(&bytes);
    }

    #[test]
    fn readers_survive_edited_arrays(bytes in mutated(npy_file())) {
        every_reader(&bytes);
    }

    #[test]
    fn readers_survive_edited_tables(
        bytes in mutated(b"snapshot,element,re,im\n0,0,1,2\n0,1,3,4\nrange_m,azimuth_deg\n1,2\n")
    ) {
        every_reader(&bytes);
    }

    #[test]
    fn every_row_of_a_drive_is_kept_or_counted(
        radar in mutated(b"frame,t_s,track_id,status,azimuth_rad,range_rate_mps\n1,0,1,3,0.1,-5\n\
                           1,0.1,2,6,0.2,99\n2,0.2,1,3,nan,4\n2,0.2,2,3,0.1,4\n"),
        detections in mutated(b"time_s,sensor,azimuth_deg,range_rate_mps\n0,1,9,-5\n0,1,-9,5\n1,2,nan,4\n"),
        motion in mutated(b"time_s,yaw_rate_degps,speed_mps\n0,1,5\n1,2,inf\n1,2,5\n2,2,5\n"),
    ) {
        for table in [radar, detections] {
            if let Ok(read) = open(&[("a.csv", &table), ("b.csv", &motion)], None) {
                let kept: usize = read.log.scans.iter().map(|scan| scan.detections.len()).sum();
                let kept = (kept + read.log.motion.len()) as u64;
                let dropped: u64 = read.report.drops().map(|(_, count)| count).sum();
                prop_assert_eq!(kept + dropped, read.report.detections + read.report.motion);
                prop_assert!(read.log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
                prop_assert!(read.log.motion.is_sorted_by(|a, b| a.time_s < b.time_s));
            }
        }
    }

    #[test]
    fn every_point_of_a_cloud_is_kept_or_counted(
        text in mutated(ASCII_CLOUD), rows in mutated(BINARY_CLOUD), packed in mutated(PACKED_CLOUD),
        table in mutated(b"[{\"token\":\"a\",\"timestamp\":1532402927664178,\"translation\":[1,2,3],\
                           \"rotation\":[1,0,0,0.5]}]"),
    ) {
        for cloud in [text, rows, packed] {
            every_reader(&cloud);
            let files = [("R_1532402927664178.pcd", &cloud[..]), ("ego_pose.json", &table)];
            for files in [&files[..], &files[..1]] {
                let Ok(read) = open(files, None) else { continue };
                let kept: usize = read.log.scans.iter().map(|scan| scan.detections.len()).sum();
                let kept = (kept + read.log.motion.len()) as u64;
                let dropped: u64 = read.report.drops().map(|(_, count)| count).sum();
                prop_assert_eq!(kept + dropped, read.report.detections + read.report.motion);
            }
        }
    }

    #[test]
    fn every_byte_of_a_stream_is_accounted_for(bytes in mutated(&DAT[..6000]), size in 1..900_usize) {
        let mut stream = UartStream::new(None);
        let mut frames: Vec<_> = bytes.chunks(size).flat_map(|piece| stream.push(piece)).collect();
        frames.extend(stream.finish());
        let log = BoardLog::parse(&bytes, None);
        prop_assert_eq!(&frames, &log.frames);
        prop_assert_eq!(stream.counts().skipped_bytes, log.counts.skipped_bytes);
        // What is not skipped is in packets, and a whole one has at least a header.
        let kept = bytes.len() as u64 - log.counts.skipped_bytes;
        prop_assert!(kept >= 36 * frames.len() as u64);
        let words = bytes.windows(8).filter(|window| **window == MAGIC).count();
        prop_assert!(frames.iter().filter(|f| f.complete).count() <= words);
    }

    #[test]
    fn arrays_come_back(shape in proptest::collection::vec(0..5_usize, 0..4), seed in any::<f64>()) {
        let data: Vec<f64> = (0..shape.iter().product()).map(|k| seed * k as f64).collect();
        let array = NpyArray::parse(&npy::write(&shape, &data).unwrap()).unwrap();
        prop_assert_eq!(&array.shape, &shape);
        let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&array.to_f64().unwrap()), bits(&data));
    }
}
