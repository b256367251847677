//! Weights of networks of motion: what is read gives finite motions, or says that there is none.

use boresight_core::Detection;
use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{CalibrationOptions, Calibrator, FrameInput, Method, MotionMethod};
use std::sync::Arc;

/// Both networks' file without its checksum.
const KEPT: &[u8] = {
    let bytes = include_bytes!("../../../../tests/golden/motion/deepego-plus/weights.bin");
    bytes.split_at(bytes.len() - 4).0
};

fn drive(network: &Arc<MotionNetwork>, motion: MotionMethod) {
    let options = CalibrationOptions {
        x_m: 3.6,
        method: Method::LeastSquares,
        motion: Some(motion),
        ..CalibrationOptions::default()
    };
    let Ok(mut calibrator) = Calibrator::with_network(options, Some(network)) else { return };
    for frame in 0..12_u8 {
        let detections: Vec<Detection> = (0..4 * frame)
            .map(|i| {
                let azimuth_rad = f32::from(i) * 0.05 - 1.0;
                Detection {
                    azimuth_rad,
                    range_rate_mps: -10.0 * azimuth_rad.cos(),
                    range_m: if i % 3 == 0 { f32::NAN } else { 20.0 },
                    rcs_dbsm: if i % 2 == 0 { f32::NAN } else { 5.0 },
                }
            })
            .collect();
        let outcome = calibrator
            .add(FrameInput {
                time_s: 0.074 * f64::from(frame),
                detections: &detections,
                yaw_rate_radps: Some(0.02),
                speed_mps: Some(10.0),
            })
            .expect("a frame as any");
        assert!(outcome.weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
        if let Some(motion) = outcome.motion {
            let [[xx, xy], [_, yy]] = motion.covariance;
            assert!(motion.velocity_mps.iter().all(|v| v.is_finite()), "{motion:?}");
            assert!(xx > 0.0 && yy > 0.0 && xy.is_finite(), "{motion:?}");
        }
    }
    assert!(!(calibrator.estimate().converged && calibrator.estimate().sigma_rad.is_nan()));
}

/// Checks one input.
pub fn check(bytes: &[u8]) {
    // Bytes in some places of a true one: place, and what stands there. A checksum would refuse them, so it is made anew.
    let mut weights = KEPT.to_vec();
    for &[low, middle, high, value] in bytes.as_chunks::<4>().0 {
        let place = u32::from_le_bytes([low, middle, high, 0]) as usize;
        weights[place % KEPT.len()] = value;
    }
    weights.extend(crc32fast::hash(&weights).to_le_bytes());
    let Ok(network) = MotionNetwork::read(&weights) else { return };
    let network = Arc::new(network);
    drive(&network, MotionMethod::Deepego);
    drive(&network, MotionMethod::DeepegoPlus);
}
