//! Vehicle, drive and time of a log from its path.

use crate::error::FleetError;
use jiff::civil::{Date, DateTime};
use jiff::tz::TimeZone;
use std::collections::HashSet;

/// What the end of a path is made of: components between slashes, in which `{vehicle}`, `{drive}`, `{time}` and `*` stand for text of any length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    text: String,
    components: Vec<Vec<Piece>>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Literal(String),
    Vehicle,
    Drive,
    Time,
    Any,
}

/// What a path says of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Named {
    /// The vehicle.
    pub vehicle: Option<String>,
    /// The drive.
    pub drive: Option<String>,
    /// When it began, s since 1970.
    pub time_s: Option<f64>,
}

/// The folder that holds the log names the vehicle, and the log the drive.
pub const DEFAULT_PATTERN: &str = "{vehicle}/{drive}";

const PLACES: [(&str, Piece); 4] = [
    ("{vehicle}", Piece::Vehicle),
    ("{drive}", Piece::Drive),
    ("{time}", Piece::Time),
    ("*", Piece::Any),
];
/// Forms of times without a zone, which are taken as UTC.
const TIMES: [&str; 7] = [
    "%Y-%m-%dT%H:%M:%S",
    "%Y-%m-%dT%H-%M-%S",
    "%Y-%m-%d_%H-%M-%S",
    "%Y-%m-%d-%H-%M-%S",
    "%Y%m%dT%H%M%S",
    "%Y%m%d_%H%M%S",
    "%Y%m%d-%H%M%S",
];
/// Longest component that is matched, bytes; file systems allow about 255 characters.
const LONGEST_COMPONENT: usize = 1024;
/// Longest text that may be a time, bytes.
const LONGEST_TIME: usize = 64;
const DATES: [&str; 2] = ["%Y-%m-%d", "%Y%m%d"];

impl Pattern {
    /// Reads a pattern such as `{vehicle}/{drive}` or `{vehicle}/{time}_{drive}.mcap`.
    ///
    /// # Errors
    /// [`FleetError::Name`] for a place of another name, one that stands twice or right behind another, and a pattern without `{vehicle}`.
    pub fn new(text: &str) -> Result<Self, FleetError> {
        let wrong = || {
            FleetError::Name {
            what: "the pattern of paths",
            expected: "{vehicle}, {drive}, {time} and *, each but * at most once, with text or a slash between them, and {vehicle} among them"
                .into(),
            given: format!("{text:?}"),
        }
        };
        let components: Option<Vec<_>> = text.split('/').map(pieces).collect();
        let components = components.ok_or_else(wrong)?;
        let count = |piece: &Piece| components.iter().flatten().filter(|p| *p == piece).count();
        let once = [Piece::Drive, Piece::Time].iter().all(|piece| count(piece) <= 1);
        if count(&Piece::Vehicle) != 1 || !once {
            return Err(wrong());
        }
        Ok(Self { text: text.into(), components })
    }

    /// What a path says, whose components are separated by slashes. A drive that the pattern does not name is the last component.
    ///
    /// # Errors
    /// [`FleetError::Name`] for a path that does not end in what the pattern says, and a `{time}` that is none.
    pub fn read(&self, path: &str) -> Result<Named, FleetError> {
        let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty()).collect();
        let wrong = |expected: String| FleetError::Name {
            what: "the path",
            expected,
            given: format!("{path:?}"),
        };
        let skipped = parts.len().checked_sub(self.components.len());
        let ends = skipped.map(|skipped| &parts[skipped..]);
        let matched = |timed: bool| -> Option<Vec<(&Piece, &str)>> {
            let mut found = vec![];
            for (pieces, part) in self.components.iter().zip(ends?) {
                found.extend(matched(pieces, part, timed)?);
            }
            Some(found)
        };
        let Some(found) = matched(true) else {
            let times = matched(false);
            let times = times.iter().flatten().find(|(piece, _)| **piece == Piece::Time);
            return Err(wrong(times.map_or_else(
                || format!("an end as {}", self.text),
                |(_, text)| {
                    format!(
                        "{{time}} as 2026-05-01T10-00-00, 2026-05-01, 20260501_100000 or s since 1970, not {text:?}"
                    )
                },
            )));
        };
        let mut named = Named::default();
        for (piece, text) in found {
            match piece {
                Piece::Vehicle => named.vehicle = Some(text.into()),
                Piece::Drive => named.drive = Some(text.into()),
                Piece::Time => named.time_s = time_s(text),
                Piece::Literal(_) | Piece::Any => {}
            }
        }
        named.drive = named.drive.or_else(|| parts.last().map(|last| (*last).to_owned()));
        Ok(named)
    }
}

/// The pieces of a component; `None` where a place follows another, or has no name.
fn pieces(text: &str) -> Option<Vec<Piece>> {
    let mut pieces = vec![];
    let mut rest = text;
    while !rest.is_empty() {
        let next = PLACES.iter().filter_map(|(name, piece)| Some((rest.find(name)?, name, piece)));
        let Some((at, name, piece)) = next.min_by_key(|(at, _, _)| *at) else {
            pieces.push(Piece::Literal(rest.into()));
            break;
        };
        if at > 0 {
            pieces.push(Piece::Literal(rest[..at].into()));
        } else if pieces.last().is_some_and(|last| !matches!(last, Piece::Literal(_))) {
            return None;
        }
        pieces.push(piece.clone());
        rest = &rest[at + name.len()..];
    }
    let odd = |piece: &Piece| matches!(piece, Piece::Literal(text) if text.contains(['{', '}']));
    (!pieces.is_empty() && !pieces.iter().any(odd)).then_some(pieces)
}

/// The text of each place of a component; `None` where it is not made of the pieces. Each place takes the shortest text, from left to right,
/// that lets the remaining pieces match; with `timed` that of `{time}` is a time.
fn matched<'a>(
    pieces: &'a [Piece],
    text: &'a str,
    timed: bool,
) -> Option<Vec<(&'a Piece, &'a str)>> {
    if text.len() > LONGEST_COMPONENT {
        return None;
    }
    let mut search = Search { pieces, text, timed, failed: HashSet::new() };
    let mut found = vec![];
    search.from(0, 0, &mut found).then(|| {
        found.reverse();
        found
    })
}

/// A search that tries each piece at each offset once, so that its cost is bounded by the square of the length.
struct Search<'a> {
    pieces: &'a [Piece],
    text: &'a str,
    timed: bool,
    /// Pieces, and offsets at which they and those behind them do not match.
    failed: HashSet<(usize, usize)>,
}

impl<'a> Search<'a> {
    /// Matches the pieces from one on with the text from an offset on. `found` becomes their places, the last first.
    fn from(&mut self, piece: usize, at: usize, found: &mut Vec<(&'a Piece, &'a str)>) -> bool {
        let (pieces, rest) = (self.pieces, &self.text[at..]);
        let Some(first) = pieces.get(piece) else { return rest.is_empty() };
        if self.failed.contains(&(piece, at)) {
            return false;
        }
        let fits = match first {
            Piece::Literal(literal) => {
                rest.starts_with(&**literal) && self.from(piece + 1, at + literal.len(), found)
            }
            // A place ends where the next literal begins, or with the component.
            place => self.ends(piece, rest).any(|end| {
                let text = &rest[..end];
                let is_time = || text.len() <= LONGEST_TIME && time_s(text).is_some();
                let accepted = !(self.timed && *place == Piece::Time) || is_time();
                let fits = accepted && self.from(piece + 1, at + end, found);
                if fits {
                    found.push((place, text));
                }
                fits
            }),
        };
        if !fits {
            self.failed.insert((piece, at));
        }
        fits
    }

    /// Lengths that a place may have, the shortest first.
    fn ends(&self, piece: usize, rest: &'a str) -> impl Iterator<Item = usize> + use<'a> {
        let literal = match self.pieces.get(piece + 1) {
            Some(Piece::Literal(literal)) => Some(&**literal),
            _ => None,
        };
        let inner = literal.into_iter().flat_map(move |literal| {
            rest.char_indices().map(|(at, _)| at).filter(move |at| rest[*at..].starts_with(literal))
        });
        let whole = literal.is_none().then_some(rest.len());
        inner.chain(whole).filter(|end| *end > 0)
    }
}

/// A time, s since 1970, from the forms that names of recordings have; without a zone it is UTC.
pub fn time_s(text: &str) -> Option<f64> {
    let of = |time: DateTime| {
        let stamp = time.to_zoned(TimeZone::UTC).ok()?.timestamp();
        Some(stamp.as_second() as f64)
    };
    if let Ok(stamp) = text.parse::<jiff::Timestamp>() {
        return Some(stamp.as_second() as f64 + 1e-9 * f64::from(stamp.subsec_nanosecond()));
    }
    let times = TIMES.iter().find_map(|form| DateTime::strptime(form, text).ok());
    let dates = DATES.iter().find_map(|form| Date::strptime(form, text).ok());
    if let Some(time) = times.or(dates.map(|date| date.at(0, 0, 0, 0))) {
        return of(time);
    }
    let seconds: f64 = text.parse().ok()?;
    (1e8..1e11).contains(&seconds).then_some(seconds)
}

/// Names as people order them: numbers in them by their value, so that `drive_2` comes before `drive_10`.
#[must_use]
pub fn natural_order(a: &str, b: &str) -> std::cmp::Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        match (left.chars().next(), right.chars().next()) {
            (Some(l), Some(r)) if l.is_ascii_digit() && r.is_ascii_digit() => {
                let [(x, after_x), (y, after_y)] = [number(left), number(right)];
                // Of two numbers without leading zeros the longer is larger.
                let order = x.len().cmp(&y.len()).then_with(|| x.cmp(y));
                if order.is_ne() {
                    return order;
                }
                (left, right) = (after_x, after_y);
            }
            (Some(l), Some(r)) if l == r => {
                (left, right) = (&left[l.len_utf8()..], &right[r.len_utf8()..]);
            }
            (l, r) if l == r => return a.cmp(b),
            (l, r) => return l.cmp(&r),
        }
    }
}

/// The digits that a text begins with, without leading zeros, and what follows.
fn number(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    (text[..end].trim_start_matches('0'), &text[end..])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn paths_are_taken_apart() {
        let read = |pattern: &str, path: &str| {
            let named = Pattern::new(pattern).unwrap().read(path).ok()?;
            Some((named.vehicle.unwrap(), named.drive.unwrap(), named.time_s))
        };
        let told = |v: &str, d: &str, t| Some((v.to_owned(), d.to_owned(), t));
        assert_eq!(read(DEFAULT_PATTERN, "/logs/car 7/d.mcap"), told("car 7", "d.mcap", None));
        assert_eq!(read(DEFAULT_PATTERN, "logs/car7/drive_1/"), told("car7", "drive_1", None));
        assert_eq!(read(DEFAULT_PATTERN, "d.mcap"), None);
        let may = time_s("2026-05-01");
        let read_time = |pattern: &str, name: &str| {
            read(pattern, &format!("logs/{name}")).map(|(vehicle, _, time)| (vehicle, time))
        };
        for (pattern, name, vehicle) in [
            ("{vehicle}_{time}_*.mcap", "c_1_2026-05-01_x.mcap", "c_1"),
            ("{vehicle}_{time}", "c_1_2026-05-01", "c_1"),
            ("{vehicle}_{time}.mcap", "c_2026-05-01_2026-05-01.mcap", "c_2026-05-01"),
            ("{vehicle}_{time}.mcap", "c_1_20260501_000000.mcap", "c_1"),
            ("{vehicle}-{time}-*", "a-b-2026-05-01-x", "a-b"),
            ("{vehicle}_x", "a_x_x", "a_x"),
            ("{time}_{vehicle}", "2026-05-01_a_b", "a_b"),
        ] {
            let (found, time) = read_time(pattern, name).unwrap();
            assert_eq!(found, vehicle, "{pattern} {name}");
            assert!(time.is_none() || time == may, "{pattern} {name}: {time:?}");
        }
        assert_eq!(read("{vehicle}_{drive}", "a_b_c"), told("a", "b_c", None));
        let error = Pattern::new("{vehicle}_{time}").unwrap().read("c_1_x").unwrap_err();
        assert!(error.to_string().contains("not \"1_x\""), "{error}");
        assert_eq!(
            read("{vehicle}/*/{time}_{drive}.mcap", "a/car/x/20260501T100000_night.v2.mcap"),
            told("car", "night.v2", Some(1_777_629_600.0))
        );
        assert_eq!(read("{vehicle}.mcap", "a/.mcap"), None, "a place is not empty");
        assert_eq!(read("car-{vehicle}/data", "car-ä/data"), told("ä", "data", None));
        for wrong in [
            "",
            "{drive}",
            "{vehicle}{drive}",
            "{vehicle}/{vehicle}",
            "{car}/{vehicle}",
            "{vehicle}*",
        ] {
            assert!(Pattern::new(wrong).is_err(), "{wrong}");
        }
    }

    /// Without a bound the number of ways to split this text is beyond any computer.
    #[test]
    fn many_places_are_matched_in_bounded_time() {
        let pattern = Pattern::new(&("*a".repeat(30) + "{vehicle}b")).unwrap();
        assert!(pattern.read(&"a".repeat(LONGEST_COMPONENT)).is_err());
        let fits = "a".repeat(LONGEST_COMPONENT - 1) + "b";
        assert!(pattern.read(&fits).is_ok());
        assert!(pattern.read(&("a".to_owned() + &fits)).is_err(), "too long");
    }

    #[test]
    fn times_have_the_forms_of_names_of_recordings() {
        for text in [
            "2026-05-01T10:00:00Z",
            "2026-05-01T12:00:00+02:00",
            "2026-05-01T10:00:00",
            "2026-05-01T10-00-00",
            "2026-05-01_10-00-00",
            "20260501_100000",
            "1777629600",
        ] {
            assert_eq!(time_s(text), Some(1_777_629_600.0), "{text}");
        }
        assert_eq!(time_s("2026-05-01"), time_s("20260501"));
        for wrong in ["", "7", "2026-13-01", "NaN", "1e300", "2026-05-01T25-00-00"] {
            assert_eq!(time_s(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn numbers_in_names_count() {
        let mut names = ["b", "a10", "a2", "a02b", "a2a", "a", "", "a010"];
        names.sort_by(|a, b| natural_order(a, b));
        assert_eq!(names, ["", "a", "a2", "a2a", "a02b", "a010", "a10", "b"]);
    }
}
