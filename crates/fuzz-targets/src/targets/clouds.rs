//! Tables and frames beside clouds, parted by zero bytes: motion and scans are in order whatever they say.

use boresight_formats::drive_log::open;

const CLOUD: &[u8] = include_bytes!("../../../../fuzz/seeds/pcd/nuscenes.pcd");
const NAMES: [&str; 5] = [
    "sample_data.json",
    "ego_pose.json",
    "calibrated_sensor.json",
    "sensor.json",
    "ego_motion_chassis.json",
];

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let mut files: Vec<(&str, &[u8])> = vec![("n0__R__1532402927664178.pcd", CLOUD)];
    files.extend(NAMES.into_iter().zip(bytes.split(|byte| *byte == 0)));
    let delft = [("00549.bin", bytes), ("00550.bin", &[]), ("00549.json", bytes)];
    for files in [&files[..], &delft] {
        if let Ok(read) = open(files, None) {
            let kept: usize = read.log.scans.iter().map(|scan| scan.detections.len()).sum();
            let kept = (kept + read.log.motion.len()) as u64;
            let dropped: u64 = read.report.drops().map(|(_, count)| count).sum();
            assert_eq!(kept + dropped, read.report.detections + read.report.motion);
            assert!(read.log.scans.is_sorted_by(|a, b| a.time_s <= b.time_s));
            assert!(read.log.motion.is_sorted_by(|a, b| a.time_s < b.time_s));
        }
    }
}
