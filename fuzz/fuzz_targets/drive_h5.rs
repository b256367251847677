//! Recordings in the layout of RadarScenes: every record is kept or counted as left out.

#![no_main]

use boresight_formats::ReadReport;
use boresight_formats::radarscenes::{Companions, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut report = ReadReport::default();
    if let Ok(log) = read(bytes.to_vec(), Companions::default(), &mut report) {
        let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
        let kept = (kept + log.motion.len()) as u64;
        let dropped: u64 = report.drops().map(|(_, count)| count).sum();
        assert_eq!(kept + dropped, report.detections + report.motion);
    }
});
