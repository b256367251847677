//! Captures: a configuration, a line with `%%`, and the samples.

use boresight_formats::{Capture, RadarConfig};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let Some(at) = bytes.windows(3).position(|window| window == b"%%\n") else { return };
    let Ok(config) = RadarConfig::parse(&bytes[..at]) else { return };
    let samples = &bytes[at + 3..];
    if let Ok(capture) = Capture::new(samples, &config) {
        let whole = capture.frames() as u64 * config.frame_bytes();
        assert_eq!(whole + capture.trailing_bytes() as u64, samples.len() as u64);
        for index in [0, capture.frames() - 1] {
            let Ok(frame) = capture.frame(index) else { panic!("frame {index} is there") };
            assert_eq!(frame.samples.shape(), capture.shape());
            assert!(frame.clipped <= frame.samples.len());
        }
        assert!(capture.frame(capture.frames()).is_err());
    }
}
