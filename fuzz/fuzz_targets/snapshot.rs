//! Snapshots of calibrations: what is restored takes frames, and comes back when it is kept again.

#![no_main]

use boresight_calibrate::{Calibrator, FrameInput};
use boresight_core::Detection;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // Those bytes are fuzzed that a checksum would refuse.
    let mut snapshot = [&b"BSCA\x01"[..], bytes].concat();
    snapshot.extend(crc32fast::hash(&snapshot).to_le_bytes());
    let Ok(mut calibrator) = Calibrator::restore(&snapshot, None) else { return };
    let Ok(kept) = calibrator.snapshot() else { panic!("what was kept can be kept") };
    assert!(Calibrator::restore(&kept, None).is_ok());
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
    for frame in 0..80_u8 {
        let time_s = 1e9 + 0.074 * f64::from(frame);
        let input = FrameInput {
            time_s,
            detections: &detections,
            yaw_rate_radps: Some(0.0),
            speed_mps: Some(10.0),
        };
        if calibrator.add(input).is_err() {
            return;
        }
    }
    let _ = calibrator.estimate();
});
