//! Line plots with labelled axes, as SVG.

use crate::EvaluateError;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// Colours that people with colour-blindness can tell apart (Okabe and Ito 2008).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];
/// Size of a panel, pixels.
const PANEL: (u32, u32) = (560, 300);

/// One pair of axes.
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// Label of the abscissa, with unit.
    pub x: String,
    /// Label of the ordinate, with unit.
    pub y: String,
    /// Both axes logarithmic; needs positive numbers.
    pub logarithmic: bool,
    /// Lines.
    pub series: Vec<Series>,
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

/// Draws the panels in rows of `columns`.
pub fn draw(panels: &[Panel], columns: usize) -> Result<String, EvaluateError> {
    let rows = panels.len().div_ceil(columns);
    let mut svg = String::new();
    {
        let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(figure)?;
        for (panel, area) in panels.iter().zip(area.split_evenly((rows, columns))) {
            panel_on(panel, &area)?;
        }
        area.present().map_err(figure)?;
    }
    Ok(svg)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn panel_on(panel: &Panel, area: &Area) -> Result<(), EvaluateError> {
    let [x0, x1] = limits(panel, |point| point.0);
    let [y0, y1] = limits(panel, |point| point.1);
    if panel.logarithmic {
        axes(panel, area, (x0..x1).log_scale(), (y0..y1).log_scale())
    } else {
        axes(panel, area, x0..x1, y0..y1)
    }
}

fn axes<X, Y>(panel: &Panel, area: &Area, x: X, y: Y) -> Result<(), EvaluateError>
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
    let number = |x: &f64| format!("{}", (x * 1e6).round() / 1e6);
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc(&panel.x)
        .y_desc(&panel.y)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .draw()
        .map_err(figure)?;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let style = colour.stroke_width(2);
        let points = || series.points.iter().copied();
        let shown = if series.dashed {
            chart.draw_series(DashedLineSeries::new(points(), 6, 4, style))
        } else {
            chart.draw_series(LineSeries::new(points(), style))
        }
        .map_err(figure)?;
        shown
            .label(&series.name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 16, y)], style));
        if series.marked {
            let marks = points().map(|point| Circle::new(point, 3, colour.filled()));
            chart.draw_series(marks).map_err(figure)?;
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", 11))
        .draw()
        .map_err(figure)
}

/// Smallest and largest number with a margin.
fn limits(panel: &Panel, of: fn(&(f64, f64)) -> f64) -> [f64; 2] {
    let all = || panel.series.iter().flat_map(|s| &s.points).map(of);
    let usable = |x: &f64| x.is_finite() && (!panel.logarithmic || *x > 0.0);
    let low = all().filter(usable).fold(f64::INFINITY, f64::min);
    let high = all().filter(usable).fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return [1.0, 10.0];
    }
    if panel.logarithmic {
        return [low / 1.25, high * 1.25];
    }
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    [low - margin, high + margin]
}

fn figure(error: impl std::fmt::Display) -> EvaluateError {
    EvaluateError::Figure(error.to_string())
}
