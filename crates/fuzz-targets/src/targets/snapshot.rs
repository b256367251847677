//! Snapshots of calibrations: what is restored takes frames, and comes back when it is kept again.

use boresight_core::Detection;
use boresight_mounting::{CalibrationOptions, Calibrator, FrameInput};
use std::sync::LazyLock;

/// What a calibration keeps after some frames, without its checksum.
static KEPT: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let options = CalibrationOptions { x_m: 3.6, ..CalibrationOptions::default() };
    let mut calibrator = Calibrator::new(options).expect("options as they are");
    drive(&mut calibrator, 0.0, 200);
    let mut kept = calibrator.snapshot().expect("of the recursive method");
    kept.truncate(kept.len() - 4);
    kept
});

fn drive(calibrator: &mut Calibrator, start_s: f64, frames: u16) {
    for frame in 0..frames {
        let detections: Vec<Detection> = (0..20_u8)
            .map(|i| {
                let azimuth_rad = f32::from(i) * 0.1 - 1.0;
                Detection {
                    azimuth_rad,
                    range_rate_mps: -10.0 * azimuth_rad.cos(),
                    range_m: 20.0,
                    rcs_dbsm: f32::NAN,
                }
            })
            .collect();
        let time_s = start_s + 0.074 * f64::from(frame);
        let input = FrameInput {
            time_s,
            detections: &detections,
            yaw_rate_radps: Some(0.1 * (0.3 * time_s).sin()),
            speed_mps: Some(10.0),
        };
        if calibrator.add(input).is_ok() {
            let estimate = calibrator.estimate();
            assert!(!(estimate.converged && estimate.sigma_rad.is_nan()));
        }
    }
}

/// Checks one input.
pub fn check(bytes: &[u8]) {
    // Bytes in some places of a true one: place, and what stands there. A checksum would refuse them, so it is made anew.
    let mut snapshot = KEPT.clone();
    let length = snapshot.len() - 5;
    for &[low, high, value] in bytes.as_chunks::<3>().0 {
        snapshot[5 + usize::from(u16::from_le_bytes([low, high])) % length] = value;
    }
    snapshot.extend(crc32fast::hash(&snapshot).to_le_bytes());
    let Ok(mut calibrator) = Calibrator::restore(&snapshot, None) else { return };
    let Ok(kept) = calibrator.snapshot() else { panic!("what was kept can be kept") };
    assert!(Calibrator::restore(&kept, None).is_ok());
    drive(&mut calibrator, 1e9, 80);
}
