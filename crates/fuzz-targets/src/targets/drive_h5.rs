//! Recordings in the layout of `RadarScenes`, whole or as changes of bundled ones: every record is kept or counted as left out.

use crate::hdf5_files::{RECORDINGS, file_of};
use boresight_formats::ReadReport;
use boresight_formats::radarscenes::{Companions, read};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let mut report = ReadReport::default();
    if let Ok(log) = read(file_of(bytes, &RECORDINGS), Companions::default(), &mut report) {
        let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
        let kept = (kept + log.motion.len()) as u64;
        let dropped: u64 = report.drops().map(|(_, count)| count).sum();
        assert_eq!(kept + dropped, report.detections + report.motion);
    }
}
