//! Tables: what is accepted comes back when written.

use boresight_formats::tables::{
    read_detections, read_snapshots, write_detections, write_snapshots,
};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    if let Ok(rows) = read_detections(bytes) {
        let again = read_detections(write_detections(&rows).as_bytes());
        assert_eq!(again.map(|again| again.len()), Ok(rows.len()));
    }
    if let Ok(matrix) = read_snapshots(bytes) {
        assert_eq!(read_snapshots(write_snapshots(matrix.view()).as_bytes()), Ok(matrix));
    }
}
