//! Lines over a pair of axes, as SVG without text that has to be measured: plotters measures it by a page's document, which workers
//! do not have.

use maud::{Markup, html};
use std::fmt::Write as _;

/// Size of the picture and of its margins (left, right, top, bottom), in its own units.
const SIZE: [f64; 2] = [720.0, 250.0];
const MARGIN: [f64; 4] = [80.0, 12.0, 14.0, 44.0];
/// About as many labels an axis.
const TICKS: f64 = 6.0;

/// What is drawn, by the name of its style.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A line through points; where one is not finite it is broken.
    Line(&'static str, Vec<[f64; 2]>),
    /// The area between two ordinates at abscissas.
    Band(&'static str, Vec<[f64; 3]>),
    /// An ordinate all along.
    Level(&'static str, f64),
    /// An abscissa all along.
    Upright(&'static str, f64),
    /// Points of an abscissa, an ordinate and the ordinate's deviation, which is drawn as a bar where it is finite.
    Points(&'static str, Vec<[f64; 3]>),
}

/// A pair of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What it shows, for those who do not see it.
    pub title: String,
    /// Labels with units.
    pub axes: [&'static str; 2],
    /// Smallest and largest ordinate; those of the marks if `None`.
    pub limits: Option<[f64; 2]>,
    /// In the order in which they are drawn.
    pub marks: Vec<Mark>,
}

impl Chart {
    /// As an SVG element; what lies beyond the axes is cut off.
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
        let x = extent(points().map(|point| point[0]));
        let y = self.limits.unwrap_or_else(|| extent(points().map(|point| point[1])));
        let [left, right, top, bottom] =
            [MARGIN[0], SIZE[0] - MARGIN[1], MARGIN[2], SIZE[1] - MARGIN[3]];
        let across = |value: f64| left + (value - x[0]) / (x[1] - x[0]) * (right - left);
        let up = |value: f64| bottom - (value - y[0]) / (y[1] - y[0]) * (bottom - top);
        let [width, height] = SIZE;
        let (across_labels, across_digits) = ticks(x);
        let (up_labels, up_digits) = ticks(y);
        let at = |point: [f64; 2]| {
            format!("{:.1} {:.1}", across(point[0]), up(point[1]).clamp(-1e4, 1e4))
        };
        let drawn = |mark: &Mark| match mark {
            Mark::Line(class, points) => html! { path class=(class) d=(line(points, at)) {} },
            Mark::Band(class, points) => {
                let there = points.iter().map(|p| [p[0], p[1]]);
                let back = points.iter().rev().map(|p| [p[0], p[2]]);
                let corners: Vec<String> = there.chain(back).map(at).collect();
                html! { polygon class=(class) points=(corners.join(" ")) {} }
            }
            Mark::Level(class, value) => {
                let at = up(*value).clamp(-1e4, 1e4);
                html! { path class=(class) d=(format!("M{left} {at:.1}H{right}")) {} }
            }
            Mark::Upright(class, value) => {
                let at = across(*value).clamp(-1e4, 1e4);
                html! { path class=(class) d=(format!("M{at:.1} {top}V{bottom}")) {} }
            }
            Mark::Points(class, points) => {
                let [mut bars, mut dots] = [String::new(), String::new()];
                for [x, y, deviation] in points {
                    if !(x.is_finite() && y.is_finite()) {
                        continue;
                    }
                    // A line of no length, whose round ends make the dot.
                    let _ = write!(dots, "M{}h0", at([*x, *y]));
                    if deviation.is_finite() {
                        let end = up(y + deviation).clamp(-1e4, 1e4);
                        let _ = write!(bars, "M{}V{end:.1}", at([*x, y - deviation]));
                    }
                }
                html! {
                    path.bars d=(bars) {}
                    path class={ "dots " (class) } d=(dots) {}
                }
            }
        };
        html! {
            svg viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(self.title) {
                clipPath id=(id) {
                    rect x=(left) y=(top) width=(right - left) height=(bottom - top) {}
                }
                @for value in across_labels {
                    path.grid d=(format!("M{:.1} {top}V{bottom}", across(value))) {}
                    text x=(tenths(across(value))) y=(tenths(bottom + 16.0)) text-anchor="middle" {
                        (format!("{value:.across_digits$}"))
                    }
                }
                @for value in up_labels {
                    path.grid d=(format!("M{left} {:.1}H{right}", up(value))) {}
                    text x=(tenths(left - 6.0)) y=(tenths(up(value) + 4.0)) text-anchor="end" {
                        (format!("{value:.up_digits$}"))
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

/// The path through points; where one is not finite it is broken.
fn line(points: &[[f64; 2]], at: impl Fn([f64; 2]) -> String) -> String {
    let mut path = String::new();
    let mut before = "M";
    for point in points {
        if !(point[0].is_finite() && point[1].is_finite()) {
            before = "M";
            continue;
        }
        path = path + before + &at(*point);
        before = "L";
    }
    path
}

/// Smallest and largest finite number with a margin; 0 to 1 of none.
fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = numbers
        .filter(|number| number.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    if low > high {
        return [0.0, 1.0];
    }
    let margin = if high > low { 0.03 * (high - low) } else { 0.5 };
    [low - margin, high + margin]
}

/// Round numbers between two limits, and the digits that tell them apart.
fn ticks([low, high]: [f64; 2]) -> (Vec<f64>, usize) {
    let rough = (high - low) / TICKS;
    let power = rough.log10().floor();
    let unit = 10_f64.powf(power);
    let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * unit).into_iter().find(|s| *s >= rough);
    let step = step.unwrap_or(rough);
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let first = (low / step).ceil() as i64;
    let values = (first..).map(|at| at as f64 * step).take_while(|value| *value <= high);
    // Zero has no sign.
    (values.take(20).map(|value| value + 0.0).collect(), digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_round_and_within_the_limits() {
        assert_eq!(ticks([0.0, 60.0]), (vec![0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0], 0));
        let (values, digits) = ticks([-0.31, 0.29]);
        assert_eq!((values.len(), digits), (6, 1));
        assert!(values.iter().all(|value| (10.0 * value).fract().abs() < 1e-9), "{values:?}");
    }

    #[test]
    fn a_chart_of_nothing_and_one_of_anything_can_be_drawn() {
        for marks in
            [vec![], vec![Mark::Line("line", vec![[f64::NAN; 2], [1.0, 1e300], [2.0, -1e300]])]]
        {
            let chart = Chart { title: "t".into(), axes: ["x", "y"], limits: None, marks };
            let svg = chart.svg("a").into_string();
            assert!(svg.ends_with("</g></svg>") && !svg.contains("NaN"), "{svg}");
        }
    }

    #[test]
    fn points_have_a_bar_where_their_deviation_is_finite() {
        let points = [[0.0, 1.0, 0.5], [1.0, 2.0, f64::INFINITY], [2.0, f64::NAN, 1.0]];
        let marks = vec![Mark::Points("usual", points.to_vec()), Mark::Upright("event", 1.0)];
        let svg = Chart { title: "<t>".into(), axes: ["x", "y"], limits: None, marks };
        let svg = svg.svg("a").into_string();
        let path = |class: &str| {
            let start = svg.split(&format!("class=\"{class}\" d=\"")).nth(1).unwrap();
            start.split('"').next().unwrap().to_owned()
        };
        assert_eq!(path("bars").matches('M').count(), 1, "{svg}");
        let dots = path("dots usual");
        assert_eq!(dots.matches('M').count(), 2, "{svg}");
        // The vertical goes through the second dot.
        let second = dots.split('M').nth(2).unwrap().split(' ').next().unwrap();
        assert!(path("event").starts_with(&format!("M{second} ")), "{svg}");
        assert!(svg.contains("aria-label=\"&lt;t&gt;\""));
    }
}
