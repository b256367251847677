//! Radar and time in the name of a cloud.

use crate::error::FormatError;

/// What a name says.
pub(super) struct CloudName {
    /// The recording, where it is named.
    pub(super) log: Option<String>,
    /// The radar.
    pub(super) channel: String,
    /// Unix time, ns.
    pub(super) stamp_ns: i128,
}

/// Reads a name with or without folders before it; `None` where it has no time.
pub(super) fn parse(path: &str) -> Option<CloudName> {
    let mut parts = path.rsplit(['/', '\\']);
    let name = parts.next()?;
    let folder = parts.next().filter(|folder| !folder.is_empty());
    let stem = name.get(..name.len().checked_sub(4)?)?;
    let digits = stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len();
    let (before, time) = (stem[..digits].trim_end_matches(['_', '-', ' ']), &stem[digits..]);
    let stamp_ns = stamp_ns(time)?;
    let (log, channel) = match before.split_once("__") {
        Some((log, channel)) => (Some(log.to_owned()), channel),
        None => (None, before),
    };
    let channel = match channel {
        "" => folder.unwrap_or("radar"),
        channel => channel,
    };
    Some(CloudName { log, channel: channel.to_owned(), stamp_ns })
}

/// A time by its digits: seconds with a point or of 10 digits, or as many more as make milli-, micro- or nanoseconds.
fn stamp_ns(text: &str) -> Option<i128> {
    if let Some((seconds, part)) = text.split_once('.') {
        let digits = part.len();
        let part: i128 = part.parse().ok().filter(|_| (1..=9).contains(&digits))?;
        let seconds: i128 = seconds.parse().ok().filter(|_| seconds.len() <= 12)?;
        return Some(seconds * 1_000_000_000 + part * 10_i128.pow(9 - digits as u32));
    }
    let power = match text.len() {
        10 => 9,
        13 => 6,
        16 => 3,
        19 => 0,
        _ => return None,
    };
    Some(text.parse::<i128>().ok()? * 10_i128.pow(power))
}

/// The error for a name without a time.
pub(super) fn untimed(path: &str) -> FormatError {
    FormatError::NoDriveLog {
        expected: "a Unix time at the end of each cloud's name, as in \
                   n015-2018-07-24-11-22-45+0800__RADAR_FRONT__1532402927664178.pcd"
            .into(),
        given: super::base(path).chars().take(80).collect(),
    }
}
