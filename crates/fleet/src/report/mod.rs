//! The page of a fleet: what needs attention, why logs failed, how radars lie about each other, and a section a vehicle.

pub mod attention;
mod figure;
mod vehicle;
pub(crate) mod words;

use crate::fleet::Fleet;
use crate::options::FleetOptions;
use crate::report::attention::Attention;
use boresight_report::About;
use boresight_report::escape::escaped;
use boresight_report::html::{document, origin, phrase};
use std::fmt::Write as _;
use vehicle::cell;
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
    let mut body = format!(
        "<section><h2>The fleet</h2>\n<p>{}.</p>\n<p>{}.</p></section>\n",
        escaped(&words::extent(fleet)),
        escaped(&words::logs(&fleet.logs))
    );
    attention_section(&mut body, fleet, &needing, &shown_vehicles);
    failures(&mut body, fleet);
    radars(&mut body, fleet);
    let left = fleet.vehicles.len() - shown_vehicles.len();
    if left > 0 {
        let _ = writeln!(
            body,
            "<p>Shown below are {} of {}, those that need attention first; {} left out. \
             <code>fleet.json</code> and the Parquet files hold all.</p>",
            shown_vehicles.len(),
            count(fleet.vehicles.len() as u64, "vehicle"),
            if left == 1 { "1 is".into() } else { format!("{left} are") },
        );
    }
    body += &sections;
    origin(&mut body, about, ROWS);
    let lead =
        "Angles are those of boresight in the car's frame, counter-clockwise from straight ahead.";
    document(about, "Mounting angles of a fleet", lead, &body)
}

/// The vehicles' sections, and which vehicles have one.
fn sections(fleet: &Fleet, needing: &[Attention], options: &FleetOptions) -> (String, Vec<usize>) {
    let mut first = vec![vec![]; fleet.vehicles.len()];
    let mut order = vec![];
    for need in needing {
        if first[need.vehicle].is_empty() {
            order.push(need.vehicle);
        }
        first[need.vehicle].push(need.radar);
    }
    order.extend((0..fleet.vehicles.len()).filter(|&vehicle| first[vehicle].is_empty()));
    let mut html = String::new();
    let mut there = vec![];
    for vehicle in order.into_iter().take(SECTIONS) {
        if html.len() > BYTES {
            break;
        }
        vehicle::section(&mut html, vehicle, &fleet.vehicles[vehicle], &first[vehicle], options);
        there.push(vehicle);
    }
    (html, there)
}

fn attention_section(html: &mut String, fleet: &Fleet, needing: &[Attention], there: &[usize]) {
    *html += "<section><h2>What needs attention</h2>\n";
    match attention::counts(needing) {
        Some(counts) => {
            let radars = count(needing.len() as u64, "radar");
            let _ = writeln!(html, "<p>{radars}: {counts}.</p>");
        }
        None if fleet.vehicles.is_empty() => *html += "<p>No drive was calibrated.</p>\n",
        None => *html += "<p>No radar.</p>\n",
    }
    let all = || fleet.vehicles.iter().flat_map(|vehicle| &vehicle.radars);
    let free = all().filter(|radar| radar.nominal_rad.is_none()).count();
    if free > 0 {
        let _ = writeln!(
            html,
            "<p class=\"undecided\">Of {} the nominal angle is not known, so nothing says whether they are aligned.</p>",
            count(free as u64, "radar")
        );
    }
    if !needing.is_empty() {
        let rows = needing.iter().take(LINES).map(|need| {
            let vehicle = &fleet.vehicles[need.vehicle];
            let name = escaped(&shown(&vehicle.name));
            let name = match there.contains(&need.vehicle) {
                true => format!("<a href=\"#vehicle-{}\">{name}</a>", need.vehicle),
                false => name,
            };
            let why: Vec<String> = need
                .needs
                .iter()
                .map(|(need, how)| format!("<b>{}</b> {}", need.title(), phrase(how)))
                .collect();
            format!(
                "<td class=\"long\">{name}</td><td>{}</td><td class=\"long\">{}</td>",
                vehicle.radars[need.radar].sensor,
                why.join("; ")
            )
        });
        columns(html, "What needs attention", &["Vehicle", "Radar", "Why"], rows);
        left_out(html, needing.len().saturating_sub(LINES));
    }
    *html += "</section>\n";
}

fn failures(html: &mut String, fleet: &Fleet) {
    if fleet.failures.is_empty() {
        return;
    }
    *html += "<section><h2>Logs that failed</h2>\n";
    let rows = fleet.failures.iter().take(ROWS).map(|failure| {
        cell(&shown(&failure.code), "long")
            + &cell(&failure.count.to_string(), "")
            + &cell(&shown(&failure.message), "long")
            + &cell(&shown(&failure.path), "long")
    });
    columns(html, "Logs that failed", &["Code", "Logs", "First message", "Its log"], rows);
    left_out(html, fleet.failures.len().saturating_sub(ROWS));
    *html += "</section>\n";
}

fn radars(html: &mut String, fleet: &Fleet) {
    if fleet.radars.is_empty() {
        return;
    }
    *html += "<section><h2>Radars of all vehicles</h2>\n<p class=\"small\">How the vehicles' angles off nominal, or angles where not all \
              have a nominal one, lie about each other. The spread is beyond what their deviations have.</p>\n";
    let rows = fleet.radars.iter().take(ROWS).map(|radar| {
        let number = |value: f64, digits: usize, unit: &str| match words::sane(value).is_finite() {
            true => format!("{value:.digits$}{unit}"),
            false => "not determined".into(),
        };
        let names: Vec<String> = radar.outlying.iter().take(LIST).map(|name| shown(name)).collect();
        let mut names = names.join(", ");
        if radar.outlying.is_empty() {
            names += "none";
        } else if radar.outlying.len() > LIST {
            let _ = write!(names, " and {} more", radar.outlying.len() - LIST);
        }
        [
            radar.sensor.to_string(),
            radar.vehicles.to_string(),
            number(degrees(radar.centre_rad), 3, " deg"),
            number(degrees(radar.spread_rad), 3, " deg"),
            number(radar.threshold, 1, " deviations"),
        ]
        .map(|text| cell(&text, ""))
        .concat()
            + &cell(&names, "long")
    });
    let names = ["Radar", "Vehicles", "Centre", "Spread", "Unlike from", "Unlike the others"];
    columns(html, "Radars of all vehicles", &names, rows);
    left_out(html, fleet.radars.len().saturating_sub(ROWS));
    *html += "</section>\n";
}

/// A table of several columns, whose rows are HTML; where it is wider than the page it is scrolled, also by keys.
fn columns(html: &mut String, title: &str, names: &[&str], rows: impl Iterator<Item = String>) {
    let names: String = names.iter().map(|name| format!("<th>{name}</th>")).collect();
    let _ = writeln!(
        html,
        "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"{title}\"><table><thead><tr>{names}</tr></thead>\n<tbody>"
    );
    for row in rows {
        let _ = writeln!(html, "<tr>{row}</tr>");
    }
    *html += "</tbody></table></div>\n";
}

fn left_out(html: &mut String, rows: usize) {
    if rows > 0 {
        let _ = writeln!(html, "<p>And {rows} more, which <code>fleet.json</code> holds.</p>");
    }
}
