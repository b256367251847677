//! The page of a fleet: what needs attention, why logs failed, how radars lie about each other, and a section a vehicle.

pub mod attention;
mod figure;
mod vehicle;
pub(crate) mod words;

use crate::fleet::Fleet;
use crate::options::FleetOptions;
use crate::report::attention::Attention;
use boresight_report::About;
use boresight_report::html::{Phrase, document, origin};
use maud::{Markup, html};
use words::{count, degrees, shown};

/// Vehicles with a section; no more begin once the page has so many bytes.
const SECTIONS: usize = 60;
const BYTES: usize = 4_000_000;
/// Lines of the list of radars that need attention.
const LINES: usize = 200;
/// Rows of other lists, and names in a row.
const ROWS: usize = 40;
const LIST: usize = 10;

/// The report of a fleet, as HTML that needs nothing else. Where vehicles are many, those that need attention come first and the others
/// are left out, which the page says. It depends on what is given alone.
#[must_use]
pub fn page(about: &About, fleet: &Fleet, options: &FleetOptions) -> String {
    let needing = attention::attention(fleet);
    let (sections, shown_vehicles) = sections(fleet, &needing, options);
    let left = fleet.vehicles.len() - shown_vehicles.len();
    let body = html! {
        section {
            h2 { "The fleet" }
            p { (words::extent(fleet)) "." }
            p { (words::logs(&fleet.logs)) "." }
        }
        (attention_section(fleet, &needing, &shown_vehicles))
        (failures(fleet))
        (radars(fleet))
        @if left > 0 {
            p {
                "Shown below are " (shown_vehicles.len()) " of " (count(fleet.vehicles.len() as u64, "vehicle"))
                ", those that need attention first; " (left) (if left == 1 { " is" } else { " are" }) " left out. "
                code { "fleet.json" } " and the Parquet files hold all."
            }
        }
        @for section in &sections { (section) }
        (origin(about, ROWS))
    };
    let lead =
        "Angles are those of boresight in the car's frame, counter-clockwise from straight ahead.";
    document(about, "Mounting angles of a fleet", lead, &body)
}

/// The vehicles' sections, and which vehicles have one.
fn sections(
    fleet: &Fleet,
    needing: &[Attention],
    options: &FleetOptions,
) -> (Vec<Markup>, Vec<usize>) {
    let mut first = vec![vec![]; fleet.vehicles.len()];
    let mut order = vec![];
    for need in needing {
        if first[need.vehicle].is_empty() {
            order.push(need.vehicle);
        }
        first[need.vehicle].push(need.radar);
    }
    order.extend((0..fleet.vehicles.len()).filter(|&vehicle| first[vehicle].is_empty()));
    let (mut sections, mut there, mut bytes) = (vec![], vec![], 0);
    for vehicle in order.into_iter().take(SECTIONS) {
        if bytes > BYTES {
            break;
        }
        let section = vehicle::section(vehicle, &fleet.vehicles[vehicle], &first[vehicle], options);
        bytes += section.0.len();
        sections.push(section);
        there.push(vehicle);
    }
    (sections, there)
}

fn attention_section(fleet: &Fleet, needing: &[Attention], there: &[usize]) -> Markup {
    let summary = match attention::counts(needing) {
        Some(counts) => format!("{}: {counts}.", count(needing.len() as u64, "radar")),
        None if fleet.vehicles.is_empty() => "No drive was calibrated.".into(),
        None => "No radar.".into(),
    };
    let all = fleet.vehicles.iter().flat_map(|vehicle| &vehicle.radars);
    let free = all.filter(|radar| radar.nominal_rad.is_none()).count();
    let row = |need: &Attention| {
        let vehicle = &fleet.vehicles[need.vehicle];
        html! {
            td.long {
                @if there.contains(&need.vehicle) {
                    a href={ "#vehicle-" (need.vehicle) } { (shown(&vehicle.name)) }
                } @else {
                    (shown(&vehicle.name))
                }
            }
            td { (vehicle.radars[need.radar].sensor) }
            td.long {
                @for (place, (need, how)) in need.needs.iter().enumerate() {
                    @if place > 0 { "; " }
                    b { (need.title()) } " " (Phrase(how))
                }
            }
        }
    };
    let title = "What needs attention";
    html! {
        section {
            h2 { (title) }
            p { (summary) }
            @if free > 0 {
                p.undecided {
                    "Of " (count(free as u64, "radar"))
                    " the nominal angle is not known, so nothing says whether they are aligned."
                }
            }
            @if !needing.is_empty() {
                (columns(title, &["Vehicle", "Radar", "Why"], needing.iter().take(LINES).map(row)))
                (left_out(needing.len().saturating_sub(LINES)))
            }
        }
    }
}

fn failures(fleet: &Fleet) -> Markup {
    let rows = fleet.failures.iter().take(ROWS).map(|failure| {
        html! {
            td.long { (shown(&failure.code)) }
            td { (failure.count) }
            td.long { (Phrase(&shown(&failure.message))) }
            td.long { (shown(&failure.path)) }
        }
    });
    let title = "Logs that failed";
    html! {
        @if !fleet.failures.is_empty() {
            section {
                h2 { (title) }
                (columns(title, &["Code", "Logs", "First message", "Its log"], rows))
                (left_out(fleet.failures.len().saturating_sub(ROWS)))
            }
        }
    }
}

fn radars(fleet: &Fleet) -> Markup {
    let number = |value: f64, digits: usize, unit: &str| match words::sane(value).is_finite() {
        true => format!("{value:.digits$}{unit}"),
        false => "not determined".into(),
    };
    let rows = fleet.radars.iter().take(ROWS).map(|radar| {
        let names: Vec<String> = radar.outlying.iter().take(LIST).map(|name| shown(name)).collect();
        html! {
            td { (radar.sensor) }
            td { (radar.vehicles) }
            td { (number(degrees(radar.centre_rad), 3, " deg")) }
            td { (number(degrees(radar.spread_rad), 3, " deg")) }
            td { (number(radar.threshold, 1, " deviations")) }
            td.long {
                (names.join(", "))
                @if names.is_empty() { "none" }
                @if radar.outlying.len() > LIST { " and " (radar.outlying.len() - LIST) " more" }
            }
        }
    });
    let names = ["Radar", "Vehicles", "Centre", "Spread", "Unlike from", "Unlike the others"];
    let title = "Radars of all vehicles";
    html! {
        @if !fleet.radars.is_empty() {
            section {
                h2 { (title) }
                p.small {
                    "How the vehicles' angles off nominal, or angles where not all have a nominal one, lie about each other. The \
                     spread is beyond what their deviations have."
                }
                (columns(title, &names, rows))
                (left_out(fleet.radars.len().saturating_sub(ROWS)))
            }
        }
    }
}

/// A table of several columns; where it is wider than the page it is scrolled, also by keys.
fn columns(title: &str, names: &[&str], rows: impl Iterator<Item = Markup>) -> Markup {
    html! {
        div.wide role="region" tabindex="0" aria-label=(title) {
            table {
                thead { tr { @for name in names { th { (name) } } } }
                tbody { @for row in rows { tr { (row) } } }
            }
        }
    }
}

fn left_out(rows: usize) -> Markup {
    html! {
        @if rows > 0 {
            p { "And " (rows) " more, which " code { "fleet.json" } " holds." }
        }
    }
}
