//! The section of a vehicle.

use super::attention::unit;
use super::words::{angle, count, degrees, sane, shown, span, trimmed};
use super::{LIST, figure};
use crate::fleet::{AngleSource, CarValues, Vehicle, VehicleRadar};
use crate::options::FleetOptions;
use boresight_mounting::wrap;
use boresight_report::html::table;
use boresight_report::{Place, verdict, within};
use maud::{Markup, html};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Radars of a vehicle that are drawn; no car has more.
const RADARS: usize = 12;

/// The section of the vehicle with that number; the radars in `first` come first.
pub(super) fn section(
    number: usize,
    vehicle: &Vehicle,
    first: &[usize],
    options: &FleetOptions,
) -> Markup {
    let hours = vehicle.drives.iter().map(|drive| drive.duration_s).sum::<f64>() / 3600.0;
    let mut line = count(vehicle.drives.len() as u64, "drive");
    if hours.is_finite() && hours < 1e6 {
        let _ = match hours < 2.0 {
            true => write!(line, " of {:.0} min together", 60.0 * hours),
            false => write!(line, " of {hours:.1} h together"),
        };
    }
    line += &span(vehicle.drives.iter()).map_or_else(String::new, |span| format!(", {span}"));
    let mut order: Vec<usize> = (0..vehicle.radars.len()).collect();
    let left = order.len().saturating_sub(RADARS);
    // Only where some are left out are those moved that must be seen.
    if left > 0 {
        order.sort_by_key(|radar| !first.contains(radar));
        order.truncate(RADARS);
        order.sort_unstable();
    }
    let rows = vehicle.shared.map(shared).unwrap_or_default();
    html! {
        article id={ "vehicle-" (number) } {
            h2 { (shown(&vehicle.name)) }
            p { (line) "." }
            @if left > 0 {
                p {
                    (left) (if left == 1 { " radar is" } else { " radars are" }) " not shown: " code { "fleet.json" } " has all."
                }
            }
            @for place in order {
                (radar_section(&format!("v{number}r{place}"), vehicle, &vehicle.radars[place], options))
            }
            @if !rows.is_empty() {
                section {
                    h3 { "What its drives share" }
                    (table(rows.into_iter()))
                }
            }
        }
    }
}

fn radar_section(
    id: &str,
    vehicle: &Vehicle,
    radar: &VehicleRadar,
    options: &FleetOptions,
) -> Markup {
    let (word, class) = verdict(radar.alignment);
    let place = radar.nominal_rad.zip(radar.alignment).map(|(nominal_rad, alignment)| Place {
        off_rad: wrap(radar.angle_rad - nominal_rad),
        sigma_rad: radar.sigma_rad,
        nominal_rad,
        alarm_rad: options.alarm_rad,
        alignment,
    });
    let (svg, caption) = figure::angles(vehicle, radar, options, id);
    html! {
        section {
            h3 { "Radar " (radar.sensor) " " span class={ "verdict " (class) } { (word) } }
            @if let Some(place) = place.filter(|place| degrees(place.nominal_rad).is_finite()) {
                p { (place.sentence("the drives do")) }
            }
            figure { (svg) figcaption { (caption) } }
            (table(facts(vehicle, radar).into_iter()))
        }
    }
}

fn facts(vehicle: &Vehicle, radar: &VehicleRadar) -> Vec<(String, String)> {
    let source = match radar.source {
        AngleSource::Joint if radar.knocks.is_empty() => "by all drives together",
        AngleSource::Joint => "by all drives since the last knock together",
        AngleSource::History => "by the drives' angles over time",
    };
    let name = |drive: usize| {
        vehicle.drives.get(drive).map_or_else(String::new, |drive| shown(&drive.name))
    };
    let unit = unit(vehicle);
    let mut rows = vec![("Angle now".into(), format!("{}, {source}", angle(radar)))];
    for (number, knock) in radar.knocks.iter().take(LIST).enumerate() {
        let step = within(degrees(knock.step_rad), degrees(knock.sigma_rad), 3, " deg");
        let mut place = format!("before \"{}\"", name(knock.drive));
        if vehicle.timed && knock.after.abs() < 1e6 && knock.before.abs() < 1e6 {
            let _ = write!(place, ", between day {:.2} and {:.2}", knock.after, knock.before);
        }
        rows.push((format!("Knock {}", number + 1), format!("{step} {place}")));
    }
    if radar.knocks.is_empty() {
        rows.push(("Knocks".into(), "none".into()));
    } else if radar.knocks.len() > LIST {
        rows.push(("Knocks".into(), format!("{} more", radar.knocks.len() - LIST)));
    }
    let drift = radar.drift.map_or_else(
        || "none beyond chance".into(),
        |drift| {
            let unit = format!(" deg a {unit}");
            trimmed(degrees(drift.rate_rad), degrees(drift.sigma_rad), &unit)
        },
    );
    rows.push(("Drift".into(), drift));
    if let Some(deviations) = radar.outlying.filter(|deviations| sane(*deviations).is_finite()) {
        let far = format!("{:.1} deviations from the other vehicles", deviations.abs());
        rows.push(("Unlike the others".into(), far));
    }
    if sane(radar.scatter).is_finite() {
        let scatter = format!("{:.2} times what the drives' deviations say", radar.scatter);
        rows.push(("Scatter".into(), scatter));
    }
    let far: Vec<usize> = radar.drives.iter().filter(|d| d.outlying).map(|d| d.drive).collect();
    if !far.is_empty() {
        let names: Vec<String> = far.iter().take(LIST).map(|&drive| name(drive)).collect();
        let more = match far.len().saturating_sub(LIST) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        rows.push(("Drives far off".into(), format!("{}{more}", names.join(", "))));
    }
    let unsettled = radar.drives.iter().filter(|drive| !drive.converged).count();
    let settled = format!("{} drives, {unsettled} of them not settled", radar.drives.len());
    rows.push(("Seen in".into(), settled));
    let mut warnings: BTreeMap<&str, u64> = BTreeMap::new();
    for code in radar.drives.iter().flat_map(|drive| &drive.warnings) {
        *warnings.entry(code).or_default() += 1;
    }
    if !warnings.is_empty() {
        let told = warnings.iter().take(LIST);
        let told: Vec<String> = told
            .map(|(code, number)| format!("{} in {}", shown(code), count(*number, "drive")))
            .collect();
        rows.push(("Warnings".into(), told.join(", ")));
    }
    rows
}

fn shared(values: CarValues) -> Vec<(String, String)> {
    let rows = [
        ("Yaw rate scale", values.scale, values.scale_sigma, 1.0, ""),
        (
            "Yaw rate bias",
            values.bias_radps.map(f64::to_degrees),
            values.bias_sigma_radps,
            1_f64.to_degrees(),
            " deg/s",
        ),
        (
            "Rear axle slip",
            values.slip_gradient_rad.map(f64::to_degrees),
            values.slip_gradient_sigma_rad,
            1_f64.to_degrees(),
            " deg/(m/s^2)",
        ),
        ("Scan delay", values.delay_s.map(|s| 1e3 * s), values.delay_sigma_s, 1e3, " ms"),
    ];
    let told = rows.into_iter().filter_map(|(name, value, sigma, factor, unit)| {
        let value = trimmed(sane(value?), sane(factor * sigma?), unit);
        Some((name.into(), value))
    });
    told.collect()
}
