//! Times of a log as messages have them.

use super::messages::Time;
use boresight_core::{DriveLog, InputError};

/// Seconds that fit into a time of a message.
const LONGEST_S: f64 = u32::MAX as f64;

/// Turns times of a log into whole nanoseconds from its zero, or from its first time where that is negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    zero_s: f64,
}

impl Clock {
    /// The clock of a log.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for times beyond 2^32 s after its zero.
    pub fn of(log: &DriveLog) -> Result<Self, InputError> {
        let scans = log.scans.iter().map(|scan| scan.time_s);
        let times = scans.chain(log.motion.iter().map(|sample| sample.time_s));
        let (first, last) = times.fold((0.0_f64, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
        if last - first <= LONGEST_S {
            return Ok(Self { zero_s: first });
        }
        Err(InputError::OutOfRange {
            what: "time of the log".into(),
            expected: format!("at most {LONGEST_S} s after its zero"),
            given: last - first,
        })
    }

    /// A time of the log, ns.
    #[must_use]
    pub fn nanoseconds(&self, time_s: f64) -> u64 {
        // In two parts: a double holds no nanoseconds of a date.
        let since_s = time_s - self.zero_s;
        let whole_s = since_s.floor();
        whole_s as u64 * 1_000_000_000 + ((since_s - whole_s) * 1e9).round() as u64
    }
}

impl From<u64> for Time {
    fn from(time_ns: u64) -> Self {
        Self {
            sec: u32::try_from(time_ns / 1_000_000_000).unwrap_or(u32::MAX),
            nsec: (time_ns % 1_000_000_000) as u32,
        }
    }
}
