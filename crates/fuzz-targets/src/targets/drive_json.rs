//! The JSON files beside a recording: rows stay as they are, whatever the files say.

use boresight_formats::ReadReport;
use boresight_formats::radarscenes::{Companions, read, sequence_names};

const RADAR_DATA: &[u8] = include_bytes!("../../../../tests/golden/radarscenes/contiguous.h5");

/// Checks one input.
pub fn check(bytes: &[u8]) {
    for beside in [
        Companions { scenes: Some(bytes), sensors: None },
        Companions { scenes: None, sensors: Some(bytes) },
    ] {
        let mut report = ReadReport::default();
        if let Ok(log) = read(RADAR_DATA.to_vec(), beside, &mut report) {
            let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
            assert_eq!(kept, 3);
            assert!(log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
            assert!(log.sensors.is_sorted_by(|a, b| a.id < b.id));
        }
    }
    let _ = sequence_names(bytes);
}
