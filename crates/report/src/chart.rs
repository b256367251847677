//! Charts as SVG. Text is placed without measuring it, which needs a document that WebAssembly workers lack.

use crate::axis::{extent, labels};
use maud::{Markup, html};
use std::fmt::Write as _;

/// Width and height of a chart in a report, px.
pub const SIZE: [f64; 2] = [720.0, 250.0];
/// Margins between the chart's edges and its axes (left, right, top, bottom), px.
const MARGIN: [f64; 4] = [80.0, 12.0, 14.0, 44.0];

/// A part of a chart, with the CSS class that styles it.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark<'a> {
    /// Line through points. It is interrupted at points that the axes cannot show.
    Line(&'a str, Vec<[f64; 2]>),
    /// Area between two ordinates, as points of an abscissa and both ordinates.
    Band(&'a str, Vec<[f64; 3]>),
    /// Horizontal line at an ordinate.
    Level(&'a str, f64),
    /// Vertical line at an abscissa.
    Upright(&'a str, f64),
    /// Dots at an abscissa and an ordinate, with error bars where the third number, the standard deviation, is finite.
    Points(&'a str, Vec<[f64; 3]>),
}

/// A pair of axes with marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart<'a> {
    /// Description for screen readers.
    pub title: String,
    /// Labels of abscissa and ordinate, with units.
    pub axes: [&'a str; 2],
    /// Whether abscissa and ordinate are logarithmic. Such an axis shows positive numbers only.
    pub logarithmic: [bool; 2],
    /// Smallest and largest ordinate. Without valid limits, those of the marks are used.
    pub limits: Option<[f64; 2]>,
    /// Width and height, px.
    pub size: [f64; 2],
    /// Marks, from back to front.
    pub marks: Vec<Mark<'a>>,
}

impl Chart<'_> {
    /// Returns an SVG element. Marks are clipped at the axes, by a path with the given id.
    pub fn svg(&self, id: &str) -> Markup {
        let points = || {
            self.marks.iter().flat_map(|mark| match mark {
                Mark::Line(_, points) => points.clone(),
                Mark::Points(_, points) => points.iter().map(|p| [p[0], p[1]]).collect(),
                Mark::Band(_, points) => {
                    points.iter().flat_map(|p| [[p[0], p[1]], [p[0], p[2]]]).collect()
                }
                Mark::Level(_, _) | Mark::Upright(_, _) => vec![],
            })
        };
        // On logarithmic axes zero and less become minus infinity, where lines break and error bars leave the axes.
        let scaled = |axis: usize, value: f64| {
            if self.logarithmic[axis] { value.max(0.0).log10() } else { value }
        };
        let range = |axis: usize| {
            let numbers = points().map(|point| scaled(axis, point[axis]));
            extent(numbers, self.logarithmic[axis])
        };
        let given = self.limits.map(|limits| limits.map(|value| scaled(1, value)));
        let given = given.filter(|[low, high]| low < high && (high - low).is_finite());
        let limits = [range(0), given.unwrap_or_else(|| range(1))];
        let [width, height] = self.size;
        let [left, right, top, bottom] =
            [MARGIN[0], width - MARGIN[1], MARGIN[2], height - MARGIN[3]];
        let place = |axis: usize, value: f64| {
            let [low, high] = limits[axis];
            let [from, to] = [[left, right], [bottom, top]][axis];
            let share = (scaled(axis, value) - low) / (high - low);
            (from + share * (to - from)).clamp(-1e4, 1e4)
        };
        let across = |value: f64| place(0, value);
        let up = |value: f64| place(1, value);
        let at = |point: [f64; 2]| format!("{:.1} {:.1}", across(point[0]), up(point[1]));
        let shown = |x: f64, y: f64| scaled(0, x).is_finite() && scaled(1, y).is_finite();
        let drawn = |mark: &Mark| match mark {
            Mark::Line(class, points) => {
                let mut path = String::new();
                let mut command = "M";
                for point in points {
                    if shown(point[0], point[1]) {
                        path = path + command + &at(*point);
                        command = "L";
                    } else {
                        command = "M";
                    }
                }
                html! { path class=(class) d=(path) {} }
            }
            Mark::Band(class, points) => {
                let there = points.iter().map(|p| [p[0], p[1]]);
                let back = points.iter().rev().map(|p| [p[0], p[2]]);
                let corners: Vec<String> = there.chain(back).map(at).collect();
                html! { polygon class=(class) points=(corners.join(" ")) {} }
            }
            Mark::Level(class, value) => {
                html! { path class=(class) d=(format!("M{left} {:.1}H{right}", up(*value))) {} }
            }
            Mark::Upright(class, value) => {
                html! { path class=(class) d=(format!("M{:.1} {top}V{bottom}", across(*value))) {} }
            }
            Mark::Points(class, points) => {
                let [mut bars, mut dots] = [String::new(), String::new()];
                for [x, y, deviation] in points.iter().filter(|p| shown(p[0], p[1])) {
                    // A line of no length, whose round ends make the dot.
                    let _ = write!(dots, "M{}h0", at([*x, *y]));
                    if deviation.is_finite() {
                        let end = up(y + deviation);
                        let _ = write!(bars, "M{}V{end:.1}", at([*x, y - deviation]));
                    }
                }
                html! {
                    path.bars d=(bars) {}
                    path class={ "dots " (class) } d=(dots) {}
                }
            }
        };
        let labels = |axis: usize| labels(limits[axis], self.logarithmic[axis]);
        html! {
            svg viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(self.title) {
                clipPath id=(id) {
                    rect x=(left) y=(top) width=(right - left) height=(bottom - top) {}
                }
                @for (value, label) in labels(0) {
                    path.grid d=(format!("M{:.1} {top}V{bottom}", across(value))) {}
                    text x=(tenths(across(value))) y=(tenths(bottom + 16.0)) text-anchor="middle" {
                        (label)
                    }
                }
                @for (value, label) in labels(1) {
                    path.grid d=(format!("M{left} {:.1}H{right}", up(value))) {}
                    text x=(tenths(left - 6.0)) y=(tenths(up(value) + 4.0)) text-anchor="end" {
                        (label)
                    }
                }
                path.axis d=(format!("M{left} {top}V{bottom}H{right}")) {}
                text x=(tenths(0.5 * (left + right))) y=(tenths(height - 6.0)) text-anchor="middle" {
                    (self.axes[0])
                }
                text transform="rotate(-90)" x=(tenths(-0.5 * (top + bottom))) y="14" text-anchor="middle" {
                    (self.axes[1])
                }
                g clip-path={ "url(#" (id) ")" } {
                    @for mark in &self.marks { (drawn(mark)) }
                }
            }
        }
    }
}

/// A coordinate to a tenth.
fn tenths(value: f64) -> String {
    format!("{value:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(logarithmic: [bool; 2], marks: Vec<Mark>) -> String {
        let (title, axes) = ("<t>".into(), ["x", "y"]);
        let chart = Chart { title, axes, logarithmic, limits: None, size: SIZE, marks };
        chart.svg("a").into_string()
    }

    /// The path of the only mark of a class.
    fn path<'a>(svg: &'a str, class: &str) -> &'a str {
        let start = svg.split(&format!("class=\"{class}\" d=\"")).nth(1).unwrap();
        start.split('"').next().unwrap()
    }

    #[test]
    fn a_chart_of_nothing_and_one_of_anything_can_be_drawn() {
        for marks in
            [vec![], vec![Mark::Line("line", vec![[f64::NAN; 2], [1.0, 1e300], [2.0, -1e300]])]]
        {
            let svg = chart([false; 2], marks);
            assert!(svg.ends_with("</g></svg>") && !svg.contains("NaN"), "{svg}");
        }
    }

    #[test]
    fn points_have_a_bar_where_their_deviation_is_finite() {
        let points = [[0.0, 1.0, 0.5], [1.0, 2.0, f64::INFINITY], [2.0, f64::NAN, 1.0]];
        let marks = vec![Mark::Points("usual", points.to_vec()), Mark::Upright("event", 1.0)];
        let svg = chart([false; 2], marks);
        assert_eq!(path(&svg, "bars").matches('M').count(), 1, "{svg}");
        let dots = path(&svg, "dots usual");
        assert_eq!(dots.matches('M').count(), 2, "{svg}");
        // The vertical goes through the second dot.
        let second = dots.split('M').nth(2).unwrap().split(' ').next().unwrap();
        assert!(path(&svg, "event").starts_with(&format!("M{second} ")), "{svg}");
        assert!(svg.contains("aria-label=\"&lt;t&gt;\""));
    }

    #[test]
    fn a_line_breaks_where_a_logarithmic_axis_has_no_place() {
        let ordinates = [1.0, 10.0, 0.0, 10.0, -1.0, f64::NAN, f64::INFINITY, 100.0];
        let points = ordinates.iter().zip(1..).map(|(y, x)| [f64::from(x), *y]).collect();
        let bar = vec![Mark::Line("line", points), Mark::Points("dot", vec![[1.0, 1.0, 2.0]])];
        for logarithmic in [[false, true], [true, true]] {
            let svg = chart(logarithmic, bar.clone());
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            let line = path(&svg, "line");
            assert_eq!((line.matches('M').count(), line.matches('L').count()), (3, 1), "{line}");
            // Two decades: the second point is half way up, the last at the top.
            let middle = 0.5 * (MARGIN[2] + SIZE[1] - MARGIN[3]);
            assert!(line.contains(&format!(" {middle:.1}M")), "{line}");
            assert!(line.ends_with(&format!(" {:.1}", MARGIN[2])), "{line}");
        }
        let nothing = vec![Mark::Line("line", vec![[0.0, -1.0]])];
        assert!(!chart([true, true], nothing).contains("NaN"));
    }
}
