//! Drives as tables, one or two parted by a zero byte: every row is kept or counted as left out.

use boresight_formats::drive_log::open;

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let parts: Vec<&[u8]> = bytes.splitn(2, |byte| *byte == 0).collect();
    let files: Vec<(&str, &[u8])> = ["a.csv", "b.csv"].into_iter().zip(parts).collect();
    if let Ok(read) = open(&files, None) {
        let kept: usize = read.log.scans.iter().map(|scan| scan.detections.len()).sum();
        let kept = (kept + read.log.motion.len()) as u64;
        let dropped: u64 = read.report.drops().map(|(_, count)| count).sum();
        assert_eq!(kept + dropped, read.report.detections + read.report.motion);
        assert!(read.log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
        assert!(read.log.motion.is_sorted_by(|a, b| a.time_s < b.time_s));
    }
    // Packed, should the bytes be that.
    let _ = open(&[("a.csv.gz", bytes)], None);
}
