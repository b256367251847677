//! What a fleet's records come to, in a few lines for a terminal.

use crate::fleet::Fleet;
use crate::options::FleetOptions;
use crate::report::{attention, words};
use std::fmt::Write as _;
use words::shown;

/// Lines of radars, and of reasons why logs failed.
const LINES: usize = 40;
const REASONS: usize = 5;

/// What became of the logs, what needs attention, and the radars' angles, those that need attention first; of many only the first. Each line
/// ends with a newline.
#[must_use]
pub fn summary(fleet: &Fleet, options: &FleetOptions) -> String {
    let needing = attention::attention(fleet);
    let mut text = format!("{}\n{}\n", words::logs(&fleet.logs), words::extent(fleet));
    for failure in fleet.failures.iter().take(REASONS) {
        let [code, message, path] =
            [&failure.code, &failure.message, &failure.path].map(|t| shown(t));
        let _ = writeln!(
            text,
            "failed: {} {code}: {message} ({path})",
            words::count(failure.count, "log")
        );
    }
    let more = fleet.failures.len().saturating_sub(REASONS);
    if more > 0 {
        let _ = writeln!(text, "failed: for {}", words::count(more as u64, "more reason"));
    }
    let limit = options.alarm_rad.to_degrees();
    match attention::counts(&needing) {
        Some(counts) => {
            let radars = words::count(needing.len() as u64, "radar");
            let _ =
                writeln!(text, "needs attention: {radars}: {counts} ({limit:.2} deg are allowed)");
        }
        None => text += "needs attention: no radar\n",
    }
    let mut calm: Vec<Vec<bool>> =
        fleet.vehicles.iter().map(|vehicle| vec![true; vehicle.radars.len()]).collect();
    let mut lines = vec![];
    for need in &needing {
        calm[need.vehicle][need.radar] = false;
        let why: Vec<String> =
            need.needs.iter().map(|(need, how)| format!("{} {how}", need.title())).collect();
        lines.push((need.vehicle, need.radar, why.join("; ")));
    }
    for (vehicle, radars) in calm.into_iter().enumerate() {
        let radars = radars.into_iter().enumerate().filter(|(_, calm)| *calm);
        lines.extend(radars.map(|(radar, _)| (vehicle, radar, String::new())));
    }
    for (vehicle, radar, why) in lines.iter().take(LINES) {
        let vehicle = &fleet.vehicles[*vehicle];
        let radar = &vehicle.radars[*radar];
        let why = match (why.is_empty(), radar.nominal_rad) {
            (false, _) => why,
            (true, Some(_)) => "aligned",
            (true, None) => "no nominal angle",
        };
        let (name, angle) = (shown(&vehicle.name), words::angle(radar));
        let _ = writeln!(text, "{name} radar {}: {angle}, {why}", radar.sensor);
    }
    let more = lines.len().saturating_sub(LINES);
    if more > 0 {
        let _ = writeln!(text, "and {}", words::count(more as u64, "more radar"));
    }
    text
}
