//! A drive, frame by frame.

use crate::frame::FrameInput;
use boresight_core::{DriveLog, Scan};

/// The scans that some radars of a log took, in the order of the log, each as a frame with the car's motion looked up at
/// its time.
#[derive(Debug, Clone)]
pub struct Frames<'a> {
    log: &'a DriveLog,
    scans: std::vec::IntoIter<&'a Scan>,
    max_gap_s: f64,
}

impl<'a> Frames<'a> {
    /// Of the radars that `wanted` takes by their numbers. The motion is interpolated over gaps of at most `max_gap_s`.
    pub fn of(log: &'a DriveLog, wanted: impl Fn(u8) -> bool, max_gap_s: f64) -> Self {
        let scans: Vec<&Scan> = log.scans.iter().filter(|scan| wanted(scan.sensor)).collect();
        Self { log, scans: scans.into_iter(), max_gap_s }
    }
}

impl<'a> Iterator for Frames<'a> {
    /// The number of the radar, and its frame.
    type Item = (u8, FrameInput<'a>);

    fn next(&mut self) -> Option<Self::Item> {
        let scan = self.scans.next()?;
        let frame = FrameInput {
            time_s: scan.time_s,
            detections: &scan.detections,
            yaw_rate_radps: self.log.yaw_rate_at(scan.time_s, self.max_gap_s),
            speed_mps: self.log.speed_at(scan.time_s, self.max_gap_s),
        };
        Some((scan.sensor, frame))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.scans.size_hint()
    }
}

impl ExactSizeIterator for Frames<'_> {}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::drive::MotionSample;

    #[test]
    fn frames_are_those_of_the_radars_wanted_with_the_motion_at_their_time() {
        let scan = |sensor, time_s| Scan { sensor, time_s, detections: vec![], labels: vec![] };
        let sample = |time_s: f64| MotionSample {
            time_s,
            yaw_rate_radps: 0.1 * time_s,
            speed_mps: Some(10.0 + time_s),
            pose: None,
        };
        let log = DriveLog {
            scans: vec![scan(1, 0.5), scan(2, 0.75), scan(1, 1.5), scan(3, 1.75), scan(1, 9.0)],
            motion: vec![sample(0.0), sample(1.0), sample(2.0)],
            ..DriveLog::default()
        };
        let mut frames = Frames::of(&log, |sensor| sensor != 2, 1.0);
        assert_eq!(frames.len(), 4);
        let seen: Vec<_> = frames
            .by_ref()
            .map(|(sensor, f)| (sensor, f.time_s, f.yaw_rate_radps, f.speed_mps))
            .collect();
        let expected = [(1, 0.5), (1, 1.5), (3, 1.75)];
        for ((sensor, time_s), seen) in expected.into_iter().zip(&seen) {
            assert_eq!((seen.0, seen.1, seen.3), (sensor, time_s, Some(10.0 + time_s)));
            assert!((seen.2.unwrap_or(f64::NAN) - 0.1 * time_s).abs() < 1e-15);
        }
        // After the last sample nothing is known.
        assert_eq!(seen[3], (1, 9.0, None, None));
        assert_eq!(frames.len(), 0);
        // Nor is it where samples lie further apart than asked for.
        let gap = Frames::of(&log, |_| true, 0.9).map(|(_, f)| f.speed_mps);
        assert!(gap.clone().all(|speed| speed.is_none()) && gap.len() == 5);
    }
}
