//! Line plots with labelled axes, as SVG.

use crate::error::ValidateError;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// Colours that people with colour-blindness can tell apart: those of Okabe and Ito (2008), then some of
/// Tol's.
const COLOURS: [RGBColor; 12] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(136, 34, 85),
    RGBColor(153, 153, 51),
    RGBColor(51, 34, 136),
    RGBColor(119, 119, 119),
    RGBColor(204, 102, 119),
    RGBColor(102, 37, 6),
];
/// Size of a panel and height of a line of the legend, pixels.
const PANEL: (u32, u32) = (560, 280);
const LEGEND: u32 = 22;

/// Which axes are logarithmic; those need positive numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// None.
    Linear,
    /// The abscissa.
    LogAbscissa,
    /// The ordinate.
    LogOrdinate,
    /// Both.
    Logarithmic,
}

/// One pair of axes.
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// Label of the abscissa, with unit.
    pub x: String,
    /// Label of the ordinate, with unit.
    pub y: String,
    /// Which axes are logarithmic.
    pub axes: Axes,
    /// Smallest and largest ordinate; those of the points if `None`.
    pub y_limits: Option<[f64; 2]>,
    /// Lines, the same ones in every panel of a figure.
    pub series: Vec<Series>,
}

impl Panel {
    /// Whether abscissa and ordinate are logarithmic.
    fn logarithmic(&self) -> [bool; 2] {
        let one_of = |axes: [Axes; 2]| axes.contains(&self.axes);
        [
            one_of([Axes::LogAbscissa, Axes::Logarithmic]),
            one_of([Axes::LogOrdinate, Axes::Logarithmic]),
        ]
    }
}

/// One line.
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points.
    pub points: Vec<(f64, f64)>,
    /// Dashed.
    pub dashed: bool,
    /// With a mark at each point.
    pub marked: bool,
}

/// Draws the panels in rows of `columns` under a legend.
pub fn draw(panels: &[Panel], columns: usize) -> Result<String, ValidateError> {
    let rows = panels.len().div_ceil(columns);
    let width = PANEL.0 * columns as u32;
    let lines = panels.first().map_or(vec![], |panel| legend_lines(panel, width as i32));
    let height = 8 + LEGEND * lines.len() as u32;
    let mut svg = String::new();
    {
        let size = (width, PANEL.1 * rows as u32 + height);
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(figure)?;
        let (top, rest) = area.split_vertically(height);
        legend(&lines, &top)?;
        for (panel, area) in panels.iter().zip(rest.split_evenly((rows, columns))) {
            panel_on(panel, &area)?;
        }
        area.present().map_err(figure)?;
    }
    Ok(svg)
}

/// An entry of the legend: its abscissa, line and colour.
type Entry<'a> = (i32, &'a Series, &'static RGBColor);

/// Entries of the legend in as many lines as they need.
fn legend_lines(panel: &Panel, width: i32) -> Vec<Vec<Entry<'_>>> {
    let mut lines = vec![vec![]];
    let mut x = 16;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let entry = 42 + 6 * series.name.len() as i32;
        if x > 16 && x + entry > width {
            lines.push(vec![]);
            x = 16;
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, series, colour));
        }
        x += entry;
    }
    lines
}

fn legend(lines: &[Vec<Entry>], area: &Area) -> Result<(), ValidateError> {
    for (line, top) in lines.iter().zip((9..).step_by(LEGEND as usize)) {
        for &(x, series, colour) in line {
            let dashes = if series.dashed { vec![(0, 7), (11, 18)] } else { vec![(0, 18)] };
            for (from, to) in dashes {
                let path = vec![(x + from, top + 6), (x + to, top + 6)];
                area.draw(&PathElement::new(path, colour.stroke_width(3))).map_err(figure)?;
            }
            let text = Text::new(series.name.as_str(), (x + 23, top), ("sans-serif", 12));
            area.draw(&text).map_err(figure)?;
        }
    }
    Ok(())
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn panel_on(panel: &Panel, area: &Area) -> Result<(), ValidateError> {
    let [logarithmic_x, logarithmic_y] = panel.logarithmic();
    let [x0, x1] = limits(panel, |point| point.0, logarithmic_x);
    let [y0, y1] = panel.y_limits.unwrap_or_else(|| limits(panel, |point| point.1, logarithmic_y));
    match panel.axes {
        Axes::Linear => axes(panel, area, x0..x1, y0..y1),
        Axes::LogAbscissa => axes(panel, area, (x0..x1).log_scale(), y0..y1),
        Axes::LogOrdinate => axes(panel, area, x0..x1, (y0..y1).log_scale()),
        Axes::Logarithmic => axes(panel, area, (x0..x1).log_scale(), (y0..y1).log_scale()),
    }
}

fn axes<X, Y>(panel: &Panel, area: &Area, x: X, y: Y) -> Result<(), ValidateError>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 15))
        .margin(8)
        .x_label_area_size(34)
        .y_label_area_size(60)
        .build_cartesian_2d(x, y)
        .map_err(figure)?;
    // On a logarithmic axis 1, 2 and 5 of each decade.
    let number = |x: &f64, logarithmic: bool| {
        let leading = x / 10_f64.powf(x.log10().floor());
        let shown = [1.0, 2.0, 5.0, 10.0].iter().any(|digit| (leading - digit).abs() < 1e-6);
        if logarithmic && !shown {
            return String::new();
        }
        format!("{}", (x * 1e6).round() / 1e6)
    };
    let [logarithmic_x, logarithmic_y] = panel.logarithmic();
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc(&panel.x)
        .y_desc(&panel.y)
        .x_label_formatter(&|x| number(x, logarithmic_x))
        .y_label_formatter(&|y| number(y, logarithmic_y))
        .draw()
        .map_err(figure)?;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let style = colour.stroke_width(2);
        let points = || series.points.iter().copied();
        if series.dashed {
            chart.draw_series(DashedLineSeries::new(points(), 6, 4, style))
        } else {
            chart.draw_series(LineSeries::new(points(), style))
        }
        .map_err(figure)?;
        if series.marked {
            let marks = points().map(|point| Circle::new(point, 3, colour.filled()));
            chart.draw_series(marks).map_err(figure)?;
        }
    }
    Ok(())
}

/// Smallest and largest number with a margin.
fn limits(panel: &Panel, of: fn(&(f64, f64)) -> f64, logarithmic: bool) -> [f64; 2] {
    let all = || panel.series.iter().flat_map(|s| &s.points).map(of);
    let usable = |x: &f64| x.is_finite() && (!logarithmic || *x > 0.0);
    let low = all().filter(usable).fold(f64::INFINITY, f64::min);
    let high = all().filter(usable).fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return [1.0, 10.0];
    }
    if logarithmic {
        // Whole decades: the axis is labelled from one to the next.
        return [10_f64.powf(low.log10().floor()), 10_f64.powf(high.log10().ceil())];
    }
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    [low - margin, high + margin]
}

fn figure(error: impl std::fmt::Display) -> ValidateError {
    ValidateError::Figure(error.to_string())
}
