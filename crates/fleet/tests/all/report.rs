//! The page and the lines on made-up fleets.

use crate::support::fleet::{knock, large, radar, small, vehicle};
use boresight_core::Random;
use boresight_fleet::FleetOptions;
use boresight_fleet::fleet::{DriveAngle, FailureCount, Fleet, Vehicle, VehicleRadar};
use boresight_fleet::report::attention::{Need, attention};
use boresight_fleet::{report, text};
use boresight_mounting::Alignment;
use boresight_report::{About, Source};

fn page(fleet: &Fleet) -> String {
    let about = About {
        made: "2026-03-04".into(),
        version: "9.9".into(),
        asked: "boresight fleet merge <a>&b".into(),
        sources: vec![Source { name: "<x>.jsonl".into(), bytes: 3, sha256: "ba78".into() }],
    };
    sound(report::page(&about, fleet, &FleetOptions::default()))
}

fn lines(fleet: &Fleet) -> String {
    let text = text::summary(fleet, &FleetOptions::default());
    assert!(text.ends_with('\n') && !numberless(&text), "{text}");
    text
}

/// Whether a word is how Rust writes what is no number.
fn numberless(text: &str) -> bool {
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    words.any(|word| matches!(word, "NaN" | "inf"))
}

/// A page whose tags are closed in order, whose links lead somewhere in it and which asks for nothing.
fn sound(html: String) -> String {
    let policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-";
    assert!(
        html[..html.find("<title>").unwrap()].contains(policy),
        "no policy ahead of the contents"
    );
    for inline in ["<script", " style=", " onload=", " onclick="] {
        assert!(!html.contains(inline), "the policy blocks {inline}");
    }
    let mut open: Vec<&str> = vec![];
    let mut targets = vec![];
    for (at, _) in html.match_indices('<') {
        let end = at + html[at..].find('>').unwrap();
        let tag = &html[at + 1..end];
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if let Some(id) = tag.split(" id=\"").nth(1) {
            targets.push(id.split('"').next().unwrap());
        }
        match name {
            "!DOCTYPE" | "meta" => {}
            _ if tag.starts_with('/') => assert_eq!(open.pop(), Some(name), "{}", &html[..end]),
            _ => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
    let count = targets.len();
    for link in html.split("href=\"").skip(1) {
        let place = link.split('"').next().unwrap().strip_prefix('#').unwrap();
        assert!(targets.contains(&place), "{place}");
    }
    targets.sort_unstable();
    targets.dedup();
    assert_eq!(targets.len(), count, "an id twice");
    assert!(!html.contains("src=") && !html.contains("<script") && !html.contains("@import"));
    assert_eq!(html.matches("url(").count(), html.matches("url(#").count());
    assert!(!numberless(&html));
    html
}

/// Whether a text has all parts, each after the one before.
fn in_order(text: &str, parts: &[&str]) {
    let mut from = 0;
    for part in parts {
        let at =
            text[from..].find(part).unwrap_or_else(|| panic!("no {part} in {}", &text[from..]));
        from += at + part.len();
    }
}

#[test]
fn a_page_says_what_needs_attention_first_and_why() {
    let html = page(&small());
    in_order(
        &html,
        &[
            "<h1>",
            "6 vehicles, 6 radars, 202 drives, 2026-01-02 to 2026-02-10 (UTC)",
            "206 logs planned: 202 calibrated, 3 failed, 1 without a record",
            "What needs attention",
            "5 radars: 1 misaligned, 1 knocked, 1 drifting, 1 unlike the others, 1 undecided.",
            "<b>misaligned</b> 1.400 \u{b1} 0.009 deg off nominal",
            "<b>knocked</b> by 0.450 \u{b1} 0.020 deg before &quot;drive 25&quot;",
            "<b>drifting</b> by 0.01200 \u{b1} 0.00090 deg a day",
            "<b>unlike the others</b> 6.3 deviations from them",
            "<b>undecided</b> 0.970 \u{b1} 0.042 deg off nominal",
            "log/no-radar",
            "no radar has detections",
            "Radars of all vehicles",
            "0.120 deg",
            "<h2>misaligned</h2>",
            "Fail: misaligned",
            "<h2>knocked</h2>",
            "before &quot;drive 25&quot;, between day 24.00 and 25.00",
            "<h2>drifting</h2>",
            "<h2>unlike</h2>",
            "Beyond the axes: 1 drive.",
            "Drives far off</th><td>drive 30",
            "<h2>undecided</h2>",
            "so the drives do not decide",
            "<h2>calm</h2>",
            "Pass: aligned",
            "1.00210 \u{b1} 0.00040",
            "43.0 \u{b1} 2.0 ms",
            "Where it comes from",
        ],
    );
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/fleet.html"), &html).unwrap();
    // What is given and nothing else makes the page.
    assert_eq!(html, page(&small()));
}

#[test]
fn lines_say_the_same_in_the_same_order() {
    let text = lines(&small());
    in_order(
        &text,
        &[
            "206 logs planned",
            "6 vehicles",
            "failed: 3 logs log/no-radar: no radar has detections (calm/77.mcap)",
            "needs attention: 5 radars: 1 misaligned, 1 knocked",
            "\nmisaligned radar 1: 24.300 +- 0.009 deg, misaligned 1.400",
            "\nknocked radar 1: 23.450",
            "\ndrifting radar 1: ",
            "\nunlike radar 1: ",
            "\nundecided radar 1: ",
            "\ncalm radar 1: 23.000 +- 0.009 deg, aligned\n",
        ],
    );
}

#[test]
fn needs_are_told_of_a_radar_together_and_by_the_worst() {
    let random = &mut Random::new(1, 0);
    let mut both = radar(2, 9, 0.9, random);
    knock(&mut both, 4, 0.5);
    both.alignment = Some(Alignment::Misaligned);
    let silent = VehicleRadar { sigma_rad: f64::INFINITY, ..VehicleRadar::default() };
    let vehicles = vec![
        vehicle("a", 9, vec![radar(1, 9, 0.0, random), silent]),
        vehicle("b", 9, vec![radar(1, 9, 0.0, random), both]),
    ];
    let fleet = Fleet { vehicles, ..Fleet::default() };
    let told: Vec<_> = attention(&fleet)
        .into_iter()
        .map(|a| (a.vehicle, a.radar, a.needs.into_iter().map(|(n, _)| n).collect::<Vec<_>>()))
        .collect();
    let expected = [(1, 1, vec![Need::Misaligned, Need::Knocked]), (0, 1, vec![Need::Undecided])];
    assert_eq!(told, expected);
    assert!(page(&fleet).contains("Of 1 radar the nominal angle is not known"));
}

#[test]
fn nothing_from_outside_is_read_as_html_or_steers_a_terminal() {
    let hostile = "<script>alert('&\"')</script>\u{1b}[2J\n\u{202e}";
    let mut fleet = small();
    for vehicle in &mut fleet.vehicles {
        vehicle.name += hostile;
        for drive in &mut vehicle.drives {
            drive.name = hostile.into();
        }
        for drive in vehicle.radars.iter_mut().flat_map(|radar| &mut radar.drives) {
            drive.warnings = vec![hostile.into()];
        }
    }
    let [code, message, path] = [hostile; 3].map(String::from);
    fleet.failures = vec![FailureCount { code, count: 1, message, path }];
    fleet.radars[0].outlying = vec![hostile.into()];
    let html = page(&fleet);
    // Vehicles' heads and lines, drives, warnings, failures, radars: all are there, as text.
    assert!(html.matches("&lt;script&gt;alert('&amp;&quot;')").count() > 15);
    let text = lines(&fleet);
    let moves = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!text.contains(moves) && !html.contains(moves));
    assert_eq!(text.lines().count(), lines(&small()).lines().count());
}

#[test]
fn a_large_fleet_has_a_page_that_can_be_opened() {
    // A hundred thousand drives; the lists and texts beside them are longer than any real ones.
    let html = page(&large(1000, 100));
    assert!(html.len() < 5_000_000, "{}", html.len());
    assert_eq!(html.matches("<article").count(), 60);
    assert!(html.contains("Shown below are 60 of 1,000 vehicles"));
    assert!(html.contains("940 are left out"));
    // The hundred that need attention are all listed, those with a section with a link, which come first.
    assert_eq!(html.matches("<b>misaligned</b>").count(), 100);
    assert_eq!(html.matches("href=").count(), 60);
    assert!(html.contains("<h2>car-900</h2>") && !html.contains("<h2>car-0</h2>"));
    assert!(html.contains("And 160 more") && html.contains("And 216 more"));
    let text = lines(&large(1000, 2));
    assert!(text.len() < 20_000 && text.contains("and 1,960 more radars\n"), "{text}");
    assert!(text.contains("failed: for 195 more reasons"));
}

#[test]
fn long_series_are_thinned_and_say_so_and_knocks_stay_sharp() {
    let mut long = radar(1, 10_000, 0.0, &mut Random::new(2, 0));
    knock(&mut long, 5_017, 0.4);
    let many = radar(1, 10_000, 0.0, &mut Random::new(3, 0));
    let radars = std::iter::once(long).chain(std::iter::repeat_n(many, 255)).collect();
    let fleet = Fleet { vehicles: vec![vehicle("v", 10_000, radars)], ..Fleet::default() };
    let html = page(&fleet);
    assert!(html.len() < 500_000, "{}", html.len());
    assert!(html.contains("Of 10000 drives 203 are drawn"));
    assert!(html.contains("244 radars are not shown"));
    // The fitted line is broken once, and its second part begins at the abscissa of the knock.
    let line = html.split("<path class=\"line\" d=\"").nth(1).unwrap().split('"').next().unwrap();
    let parts: Vec<&str> = line.split('M').skip(1).collect();
    assert_eq!(parts.len(), 2, "{line}");
    let x = |part: &str| part.split(' ').next().unwrap().parse::<f64>().unwrap();
    let (first, last) = (x(parts[0]), x(line.rsplit('L').next().unwrap()));
    // Abscissas are written to a tenth.
    let expected = first + (last - first) * 5_017.0 / 9_999.0;
    assert!((x(parts[1]) - expected).abs() < 0.11, "{} {expected}", x(parts[1]));
}

#[test]
fn numbers_that_are_none_do_not_show() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE] {
        let mut fleet = small();
        fleet.radars[0].centre_rad = value;
        fleet.radars[0].threshold = value;
        for vehicle in &mut fleet.vehicles {
            vehicle.drives[0].at = value;
            vehicle.drives[0].time_s = Some(value);
            vehicle.drives[0].duration_s = value;
            let shared = vehicle.shared.as_mut().unwrap();
            (shared.scale, shared.delay_sigma_s) = (Some(value), Some(value));
            let radar = &mut vehicle.radars[0];
            radar.drives[0].angle_rad = value;
            radar.drives[1].sigma_rad = value;
            radar.drives[1].fitted_rad = value;
            (radar.angle_rad, radar.sigma_rad, radar.scatter) = (value, value, value);
            radar.nominal_rad = radar.nominal_rad.map(|_| value);
            radar.outlying = radar.outlying.map(|_| value);
            for knock in &mut radar.knocks {
                (knock.step_rad, knock.sigma_rad, knock.after) = (value, value, value);
            }
            if let Some(drift) = &mut radar.drift {
                (drift.rate_rad, drift.sigma_rad) = (value, value);
            }
        }
        let html = page(&fleet);
        assert!(html.len() < 200_000, "{}", html.len());
        lines(&fleet);
    }
}

#[test]
fn odd_shapes_have_pages() {
    let html = page(&Fleet::default());
    assert!(html.contains("No drive was calibrated"));
    assert!(lines(&Fleet::default()).contains("0 vehicles"));
    // Drives and knocks that point beyond the drives there are.
    let mut lost = radar(1, 3, 0.0, &mut Random::new(4, 0));
    knock(&mut lost, 1, 0.2);
    lost.knocks[0].drive = 99;
    lost.drives.push(DriveAngle { drive: 77, ..DriveAngle::default() });
    let vehicles = vec![
        Vehicle::default(),
        Vehicle { name: "v".into(), radars: vec![lost], ..Vehicle::default() },
    ];
    page(&Fleet { vehicles, ..Fleet::default() });
}

#[test]
fn angles_near_half_a_turn_are_drawn_together() {
    let mut back = radar(1, 20, 0.0, &mut Random::new(5, 0));
    let turned = |rad: &mut f64| *rad = boresight_mounting::wrap(*rad + 157.1_f64.to_radians());
    for drive in &mut back.drives {
        turned(&mut drive.angle_rad);
        turned(&mut drive.fitted_rad);
    }
    turned(&mut back.angle_rad);
    back.nominal_rad = Some(std::f64::consts::PI);
    let html = page(&Fleet { vehicles: vec![vehicle("v", 20, vec![back])], ..Fleet::default() });
    assert!(!html.contains("Beyond the axes"));
    assert!(html.contains(">180.0</text>") || html.contains(">180.00</text>"));
    assert!(!html.contains(">-"), "all of the axis lies about 180 deg");
}
