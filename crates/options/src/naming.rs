//! What fields are called outside Rust, and in which units.
//!
//! Rust has `field_of_view_rad` in radians. JavaScript has `fieldOfViewDeg`, the command line
//! `--field-of-view DEG`, both in degrees.

/// The endings of names that tell units: in Rust, elsewhere, and as people write them.
const UNITS: [(&str, &str, &str); 11] = [
    ("radps", "degps", "deg/s"),
    ("rad", "deg", "deg"),
    ("dbsm", "dbsm", "dBsm"),
    ("db", "db", "dB"),
    ("mps", "mps", "m/s"),
    ("m", "m", "m"),
    ("hz", "hz", "Hz"),
    ("hz_per_s", "hz_per_s", "Hz/s"),
    ("degps", "degps", "deg/s"),
    ("deg", "deg", "deg"),
    ("s", "s", "s"),
];

fn entry(name: &str) -> Option<(&str, (&str, &str, &str))> {
    UNITS
        .iter()
        .filter_map(|unit| Some((name.strip_suffix(unit.0)?.strip_suffix('_')?, *unit)))
        .min_by_key(|(stem, _)| stem.len())
}

/// Whether a field holds angles or rates of turn, in radians in Rust and in degrees elsewhere.
#[must_use]
pub fn is_angle(name: &str) -> bool {
    name.ends_with("_rad") || name.ends_with("_radps")
}

/// An angle in degrees as one would give it: without the last digits, which the conversion to radians
/// and back changes.
#[must_use]
pub fn in_degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let rounded = (degrees * 1e9).round() / 1e9;
    if rounded == 0.0 { degrees } else { rounded }
}

/// The unit outside Rust; empty for none.
#[must_use]
pub fn unit(name: &str) -> &'static str {
    UNITS
        .iter()
        .find(|unit| entry(name).is_some_and(|(_, found)| found.0 == unit.0))
        .map_or("", |unit| unit.2)
}

/// The name in JavaScript: `fieldOfViewDeg` for `field_of_view_rad`.
#[must_use]
pub fn javascript(name: &str) -> String {
    let Some((stem, (_, outside, _))) = entry(name) else { return camel_case(name) };
    camel_case(&format!("{stem}_{outside}"))
}

/// The flag of the command line without its dashes: `field-of-view` for `field_of_view_rad`.
#[must_use]
pub fn flag(name: &str) -> String {
    entry(name).map_or(name, |(stem, _)| stem).replace('_', "-")
}

/// Names as JavaScript writes them, their units as they are; points and brackets of paths stay.
#[must_use]
pub fn camel_case(name: &str) -> String {
    let mut camel = String::with_capacity(name.len());
    let mut upper = false;
    for c in name.chars() {
        match c {
            '_' => upper = true,
            c if upper => {
                camel.push(c.to_ascii_uppercase());
                upper = false;
            }
            c => camel.push(c),
        }
    }
    camel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_carry_the_unit_they_are_given_in() {
        for (rust, js, flagged, units) in [
            ("field_of_view_rad", "fieldOfViewDeg", "field-of-view", "deg"),
            ("max_yaw_rate_radps", "maxYawRateDegps", "max-yaw-rate", "deg/s"),
            ("slope_hz_per_s", "slopeHzPerS", "slope", "Hz/s"),
            ("threshold_db", "thresholdDb", "threshold", "dB"),
            ("rcs_dbsm", "rcsDbsm", "rcs", "dBsm"),
            ("min_speed_mps", "minSpeedMps", "min-speed", "m/s"),
            ("x_m", "xM", "x", "m"),
            ("grid_points", "gridPoints", "grid-points", ""),
            ("samples", "samples", "samples", ""),
        ] {
            assert_eq!(javascript(rust), js);
            assert_eq!(flag(rust), flagged);
            assert_eq!(unit(rust), units);
        }
        assert_eq!(in_degrees(120.0_f64.to_radians()), 120.0);
        assert_eq!(in_degrees(0.1_f64.to_radians()), 0.1);
    }
}
