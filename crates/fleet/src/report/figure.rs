//! A radar's angle over the drives of its vehicle, drawn.

use super::words::{count, degrees, sane};
use crate::fleet::{DriveAngle, Vehicle, VehicleRadar};
use crate::options::FleetOptions;
use boresight_mounting::wrap;
use boresight_report::chart::{Chart, Mark, SIZE};
use maud::Markup;

/// Drives that are drawn of more; beside them those next to a knock and those far off, up to `SPECIAL` each.
const DRAWN: usize = 200;
const SPECIAL: usize = 50;
/// Share of the drives, at either end, that does not widen the axis of angles.
const TAIL: f64 = 0.02;

/// The picture, and what is to be read with it.
pub(super) fn angles(
    vehicle: &Vehicle,
    radar: &VehicleRadar,
    options: &FleetOptions,
    id: &str,
) -> (Markup, String) {
    // Angles are drawn about one of them, so that those near half a turn stay together.
    let about = radar.nominal_rad.filter(|n| n.is_finite()).unwrap_or(radar.angle_rad);
    let near = |rad: f64| degrees(about + wrap(rad - about));
    let at = |drive: &DriveAngle| vehicle.drives.get(drive.drive).map_or(f64::NAN, |d| sane(d.at));
    let chosen = chosen(radar);
    let [mut usual, mut far] = [vec![], vec![]];
    let mut line = vec![];
    let mut knocks = radar.knocks.iter().peekable();
    for drive in chosen.iter().filter_map(|&place| radar.drives.get(place)) {
        let angle = near(drive.angle_rad);
        let point = [at(drive), angle, degrees(drive.sigma_rad)];
        // A drive that says nothing is no point.
        if point[2].is_finite() {
            if drive.outlying { far.push(point) } else { usual.push(point) }
        }
        if knocks.next_if(|knock| knock.drive <= drive.drive).is_some() {
            line.push([f64::NAN; 2]);
            while knocks.next_if(|knock| knock.drive <= drive.drive).is_some() {}
        }
        line.push([at(drive), near(drive.fitted_rad)]);
    }
    let now = near(radar.angle_rad);
    let sigma = degrees(radar.sigma_rad);
    let mut marks = vec![];
    let mut ordinates: Vec<f64> = line.iter().map(|point| point[1]).collect();
    ordinates.extend([now - sigma, now + sigma]);
    let last = radar.drives.iter().rev().map(at).find(|at| at.is_finite());
    if let (Some(last), true) = (last, sigma.is_finite()) {
        let first = radar.drives.iter().map(at).find(|at| at.is_finite()).unwrap_or(last);
        // A drifting angle is that of the last drive alone.
        let from = match (radar.drift, radar.knocks.last()) {
            (Some(_), _) => last - 0.03 * (last - first),
            (None, Some(knock)) => sane(knock.before),
            (None, None) => first,
        };
        if from.is_finite() && from <= last {
            let edges = [now - sigma, now + sigma];
            let reach = if from < last { [from, last] } else { [last - 0.1, last + 0.1] };
            marks.push(Mark::Band("now", reach.map(|x| [x, edges[0], edges[1]]).to_vec()));
        }
    }
    if radar.nominal_rad.is_some() {
        let [nominal, alarm] = [near(about), degrees(options.alarm_rad)];
        for (class, level) in [("level", 0.0), ("limit", -alarm), ("limit", alarm)] {
            let level = nominal + level;
            if level.is_finite() {
                marks.push(Mark::Level(class, level));
                ordinates.push(level);
            }
        }
    }
    for knock in radar.knocks.iter().take(SPECIAL) {
        let middle = sane(0.5 * (knock.after + knock.before));
        if middle.is_finite() {
            marks.push(Mark::Upright("event", middle));
        }
    }
    let limits = limits(ordinates, &usual);
    let beyond = usual.iter().chain(&far).filter(|p| p[1] < limits[0] || p[1] > limits[1]).count();
    marks.push(Mark::Points("usual", usual));
    marks.push(Mark::Points("far", far));
    marks.push(Mark::Line("line", line));
    let x = if vehicle.timed { "days since the first drive" } else { "drives since the first" };
    let chart = Chart {
        title: format!("Angle of radar {} over the drives", radar.sensor),
        axes: [x, "angle / deg"],
        logarithmic: [false; 2],
        limits: Some(limits),
        size: SIZE,
        marks,
    };
    (chart.svg(id), caption(radar, chosen.len(), beyond))
}

/// Which of the radar's drives are drawn, in their order.
fn chosen(radar: &VehicleRadar) -> Vec<usize> {
    let drives = &radar.drives;
    let step = drives.len().div_ceil(DRAWN).max(1);
    let mut chosen: Vec<usize> = (0..drives.len()).step_by(step).collect();
    chosen.extend(drives.len().checked_sub(1));
    for knock in radar.knocks.iter().take(SPECIAL) {
        let after = drives.partition_point(|drive| drive.drive < knock.drive);
        chosen.extend(after.checked_sub(1));
        chosen.push(after.min(drives.len().saturating_sub(1)));
    }
    chosen.extend((0..drives.len()).filter(|&place| drives[place].outlying).take(SPECIAL));
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// The axis of angles: all that must be seen, and the drives but for the furthest.
fn limits(mut ordinates: Vec<f64>, points: &[[f64; 3]]) -> [f64; 2] {
    let mut angles: Vec<f64> = points.iter().map(|p| p[1]).filter(|y| y.is_finite()).collect();
    angles.sort_by(f64::total_cmp);
    let tail = (TAIL * angles.len() as f64) as usize;
    ordinates.extend(angles.get(tail));
    ordinates.extend(angles.iter().rev().nth(tail));
    let [low, high] = ordinates
        .into_iter()
        .filter(|y| y.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], y| [a.min(y), b.max(y)]);
    if low > high {
        return [-1.0, 1.0];
    }
    let margin = (0.08 * (high - low)).max(0.02);
    [low - margin, high + margin]
}

fn caption(radar: &VehicleRadar, drawn: usize, beyond: usize) -> String {
    let mut caption = String::from(
        "Dots: each drive's own angle with its standard deviation, red where it is further off than chance has it. Blue: the angle over \
         time. Green: the angle now with its standard deviation.",
    );
    if radar.nominal_rad.is_some() {
        caption += " Solid, all along: nominal angle. Dashed: what is allowed.";
    }
    if !radar.knocks.is_empty() {
        caption += " Dotted: knocks.";
    }
    let silent = radar.drives.iter().filter(|drive| !drive.sigma_rad.is_finite()).count();
    if silent > 0 {
        caption += &format!(
            " Not drawn, as they do not tell the angle: {}.",
            count(silent as u64, "drive")
        );
    }
    if beyond > 0 {
        caption += &format!(" Beyond the axes: {}.", count(beyond as u64, "drive"));
    }
    if drawn < radar.drives.len() {
        caption += &format!(
            " Of {} drives {drawn} are drawn, evenly, with those next to a knock and those far off.",
            radar.drives.len()
        );
    }
    caption
}
