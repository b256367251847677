//! Point clouds: every column has a number for each point, and what comes of a cloud is kept or counted.

use boresight_formats::PointCloud;
use boresight_formats::drive_log::open;

/// Checks one input.
pub fn check(bytes: &[u8]) {
    if let Ok(cloud) = PointCloud::parse(bytes) {
        for field in cloud.fields() {
            // Of several fields of a name the first is read.
            if let Some(column) = cloud.column(&field.name) {
                assert_eq!(column.len(), cloud.len());
            }
        }
    }
    if let Ok(read) = open(&[("r_1532402927664178.pcd", bytes)], None) {
        let kept: usize = read.log.scans.iter().map(|scan| scan.detections.len()).sum();
        let dropped: u64 = read.report.drops().map(|(_, count)| count).sum();
        assert_eq!(kept as u64 + dropped, read.report.detections);
    }
}
