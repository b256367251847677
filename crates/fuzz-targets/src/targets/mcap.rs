//! Recordings in MCAP: in pieces as in one, and every detection and sample is kept or counted as left out.

use boresight_formats::{BoardLog, DriveRead, McapDriveReader, TopicOptions};

fn read(bytes: &[u8], piece: usize) -> Option<DriveRead> {
    let mut reader = McapDriveReader::new(TopicOptions::default());
    for piece in bytes.chunks(piece) {
        reader.push(piece).ok()?;
    }
    reader.finish().ok()
}

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let Some((&first, rest)) = bytes.split_last() else { return };
    let whole = read(rest, usize::MAX);
    let pieces = read(rest, 16 * usize::from(first) + 1);
    // NaN keeps them from being equal as they are.
    assert_eq!(format!("{whole:?}"), format!("{pieces:?}"));
    let _ = BoardLog::of_mcap(rest, None, None);
    let Some(DriveRead { log, report, .. }) = whole else { return };
    let kept: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
    let dropped: u64 = report.drops().map(|(_, count)| count).sum();
    assert_eq!((kept + log.motion.len()) as u64 + dropped, report.detections + report.motion);
    assert!(log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
    assert!(log.motion.is_sorted_by(|a, b| a.time_s < b.time_s));
    let finite = |time_s: f64| time_s.is_finite() && time_s >= 0.0;
    assert!(log.scans.iter().all(|scan| finite(scan.time_s)));
    assert!(log.motion.iter().all(|sample| finite(sample.time_s)));
}
