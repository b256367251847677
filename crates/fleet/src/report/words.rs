//! What page and terminal say in the same words.

use crate::fleet::{Drive, Fleet, LogCounts, VehicleRadar};
use boresight_report::within;

/// Letters of a text from outside that are shown.
const LETTERS: usize = 120;
/// Numbers beyond are no angles and no times.
const LARGEST: f64 = 1e9;

/// Text from outside as a line: without what moves the cursor or turns the direction of writing, and cut where it is long.
pub(crate) fn shown(text: &str) -> String {
    let steers = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let mut line: String =
        text.chars().take(LETTERS).map(|c| if steers(c) { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(LETTERS).is_some() {
        line.push('\u{2026}');
    }
    line
}

/// An angle in degrees; not a number where none is meant.
pub(crate) fn degrees(rad: f64) -> f64 {
    sane(rad.to_degrees())
}

/// A number that can be written and drawn; others are infinite.
pub(crate) fn sane(value: f64) -> f64 {
    if value.abs() < LARGEST { value } else { f64::INFINITY }
}

/// A value with its deviation to as many digits as tell two of the deviation, with its unit.
pub(crate) fn trimmed(value: f64, sigma: f64, unit: &str) -> String {
    let digits = match sigma > 0.0 && sigma.is_finite() {
        true => (1.0 - sigma.log10().floor()).clamp(0.0, 9.0) as usize,
        false => 3,
    };
    within(value, sigma, digits, unit)
}

/// The angle now.
pub(crate) fn angle(radar: &VehicleRadar) -> String {
    within(degrees(radar.angle_rad), degrees(radar.sigma_rad), 3, " deg")
}

/// A number of things, with its word in the singular or the plural.
pub(crate) fn count(number: u64, of: &str) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    format!("{grouped} {of}{}", if number == 1 { "" } else { "s" })
}

/// What became of the logs.
pub(crate) fn logs(counts: &LogCounts) -> String {
    let mut line = format!(
        "{} planned: {} calibrated, {} failed, {} without a record",
        count(counts.planned, "log"),
        counts.done,
        counts.failed,
        counts.missing
    );
    if counts.foreign > 0 {
        line += &format!("; {} outside the plan left out", count(counts.foreign, "log"));
    }
    line
}

/// Vehicles, radars, drives and the time that they span.
pub(crate) fn extent(fleet: &Fleet) -> String {
    let radars: usize = fleet.vehicles.iter().map(|vehicle| vehicle.radars.len()).sum();
    let drives: usize = fleet.vehicles.iter().map(|vehicle| vehicle.drives.len()).sum();
    let all = fleet.vehicles.iter().flat_map(|vehicle| &vehicle.drives);
    format!(
        "{}, {}, {}{}",
        count(fleet.vehicles.len() as u64, "vehicle"),
        count(radars as u64, "radar"),
        count(drives as u64, "drive"),
        span(all).map_or_else(|| ", no times".into(), |span| format!(", {span}"))
    )
}

/// From the first drive's day to the last's, where any has a time.
pub(crate) fn span<'a>(drives: impl Iterator<Item = &'a Drive>) -> Option<String> {
    let times = drives.filter_map(|drive| drive.time_s).filter(|time| time.is_finite());
    let [first, last] = times
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], time| [a.min(time), b.max(time)])
        .map(day);
    Some(match (first?, last?) {
        (first, last) if first == last => format!("{first} (UTC)"),
        (first, last) => format!("{first} to {last} (UTC)"),
    })
}

/// The day of a time, s since 1970; none of times that no calendar has.
fn day(time_s: f64) -> Option<String> {
    if !time_s.is_finite() {
        return None;
    }
    let stamp = jiff::Timestamp::from_second(time_s.floor() as i64).ok()?;
    Some(stamp.to_string().chars().take(10).collect())
}
