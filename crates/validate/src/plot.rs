//! Figures of charts in rows under a common legend, as SVG files.

use boresight_report::chart::{Chart, Mark};
use maud::{Markup, html};

/// Colours that colour-blind readers can distinguish: those of Okabe and Ito (2008), then some of Tol's.
const COLOURS: [&str; 12] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#000000", "#882255", "#999933",
    "#332288", "#777777", "#cc6677", "#662506",
];
const STYLE: &str = "text{font:11px sans-serif}.title{font-size:13px}svg{overflow:visible}\
path{fill:none;stroke-width:2;stroke-linejoin:round}.dashed{stroke-dasharray:6 4}\
.dots{stroke-width:6;stroke-linecap:round;stroke-dasharray:none}\
.grid{stroke:#e0e0e0;stroke-width:1}.axis{stroke:#444;stroke-width:1}";
/// Width and height of a panel, the parts of both without a chart (margin and title), and height of a row of the legend, px.
const PANEL: [f64; 2] = [560.0, 280.0];
const REST: [f64; 2] = [16.0, 22.0];
const ROW: f64 = 22.0;

/// One pair of axes.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Label of the abscissa, with unit.
    pub x: String,
    /// Label of the ordinate, with unit.
    pub y: String,
    /// Whether abscissa and ordinate are logarithmic.
    pub logarithmic: [bool; 2],
    /// Smallest and largest ordinate; those of the points if `None`.
    pub y_limits: Option<[f64; 2]>,
    /// Lines, the same ones in every panel of a figure.
    pub series: Vec<Series>,
}

/// One line.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Abscissas and ordinates.
    pub points: Vec<(f64, f64)>,
    /// Whether the line is dashed.
    pub dashed: bool,
    /// Whether each point has a dot.
    pub marked: bool,
}

/// Draws the panels in rows of `columns` under the legend of the first panel, as an SVG document.
pub fn draw(panels: &[Panel], columns: usize) -> String {
    let columns = columns.max(1);
    let width = PANEL[0] * columns as f64;
    let series = panels.first().map_or(&[][..], |panel| &panel.series);
    let places = legend(series, width);
    let top = places.last().map_or(0.0, |place| place[1]) + ROW;
    let height = top + PANEL[1] * panels.len().div_ceil(columns) as f64;
    let figure = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox={ "0 0 " (width) " " (height) } {
            style {
                (STYLE)
                @for (index, colour) in COLOURS.iter().enumerate() { ".c" (index) "{stroke:" (colour) "}" }
            }
            rect width="100%" height="100%" fill="#fff" {}
            @for (line, [x, y]) in series.iter().enumerate().zip(places) {
                g transform={ "translate(" (x) " " (y) ")" } {
                    path class=(class(line)) d="M0 0h18" {}
                    text x="23" y="4" { (line.1.name) }
                }
            }
            @for (index, panel) in panels.iter().enumerate() {
                @let [x, y] = [PANEL[0] * (index % columns) as f64, top + PANEL[1] * (index / columns) as f64];
                g transform={ "translate(" (x) " " (y) ")" } { (panel.draw(index)) }
            }
        }
    };
    figure.into_string()
}

impl Panel {
    fn draw(&self, index: usize) -> Markup {
        let size = [PANEL[0] - REST[0], PANEL[1] - REST[1]];
        let classes: Vec<String> = self.series.iter().enumerate().map(class).collect();
        let mut marks = vec![];
        for (series, class) in self.series.iter().zip(&classes) {
            marks.push(Mark::Line(class, series.points.iter().map(|&(x, y)| [x, y]).collect()));
            if series.marked {
                let points = series.points.iter().map(|&(x, y)| [x, y, f64::NAN]);
                marks.push(Mark::Points(class, points.collect()));
            }
        }
        let chart = Chart {
            title: format!("{} against {}", self.y, self.x),
            axes: [&self.x, &self.y],
            logarithmic: self.logarithmic,
            limits: self.y_limits,
            size,
            marks,
        };
        html! {
            text.title x=(0.5 * PANEL[0]) y="17" text-anchor="middle" { (self.title) }
            svg y=(REST[1]) width=(size[0]) height=(size[1]) { (chart.svg(&format!("panel{index}"))) }
        }
    }
}

/// CSS classes of a numbered line.
fn class((index, series): (usize, &Series)) -> String {
    format!("c{}{}", index % COLOURS.len(), if series.dashed { " dashed" } else { "" })
}

/// Left ends of the legend's entries, px. Widths of names are estimated from their length.
fn legend(series: &[Series], width: f64) -> Vec<[f64; 2]> {
    let mut next = [16.0, 15.0];
    let place = |series: &Series| {
        let entry = 40.0 + 6.5 * series.name.chars().count() as f64;
        if next[0] > 16.0 && next[0] + entry > width {
            next = [16.0, next[1] + ROW];
        }
        next[0] += entry;
        [next[0] - entry, next[1]]
    };
    series.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(name: &str, dashed: bool) -> Series {
        let points = vec![(1.0, 0.1), (2.0, 0.0), (3.0, f64::NAN), (4.0, 10.0)];
        Series { name: name.into(), points, dashed, marked: true }
    }

    #[test]
    fn panels_share_a_legend_and_the_document_is_well_formed() {
        let panel = |logarithmic| Panel {
            title: "a < b".into(),
            x: "R&D".into(),
            y: "\"y\"".into(),
            logarithmic,
            series: vec![line("solid", false), line("5 > 4", true)],
            ..Panel::default()
        };
        let svg = draw(&[[false; 2], [false, true], [true; 2]].map(panel), 2);
        let count = |text: &str| svg.matches(text).count();
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1120\""));
        assert_eq!(["panel0", "panel1", "panel2"].map(|id| count(&format!("id=\"{id}\""))), [1; 3]);
        // The second row has one panel.
        assert_eq!((count("translate(0 317)"), count("translate(560 317)")), (1, 0), "{svg}");
        // Lines of three panels and an entry of the legend each.
        assert_eq!((count("class=\"c0\""), count("class=\"c1 dashed\"")), (4, 4), "{svg}");
        assert_eq!((count(">solid</text>"), count(">5 &gt; 4</text>")), (1, 1), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        let mut open = vec![];
        for tag in svg.split('<').skip(1) {
            let (name, text) = tag.split_once('>').unwrap();
            assert!(!text.contains('>'), "{text}");
            match name.strip_prefix('/') {
                Some(name) => assert_eq!(open.pop(), Some(name)),
                None => open.extend(name.split(' ').next()),
            }
        }
        assert!(open.is_empty(), "{open:?}");
        let entities = ["lt;", "gt;", "amp;", "quot;"];
        let escaped = |text: &str| entities.iter().any(|entity| text.starts_with(entity));
        assert!(svg.split('&').skip(1).all(escaped), "{svg}");
    }

    #[test]
    fn a_long_legend_takes_several_rows_and_no_panel_needs_none() {
        let names = ["short", "a name of about forty characters, or more", "another such name"];
        let places = legend(&names.map(|name| line(name, false)), 400.0);
        assert_eq!(places.iter().map(|place| place[1]).collect::<Vec<_>>(), [15.0, 15.0, 37.0]);
        assert!(draw(&[], 0).ends_with("</svg>"));
    }
}
