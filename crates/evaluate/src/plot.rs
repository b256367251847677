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
/// Size of a panel and height of the legend, pixels.
const PANEL: (u32, u32) = (560, 280);
const LEGEND: u32 = 30;

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
    /// Smallest and largest ordinate; those of the points if `None`.
    pub y_limits: Option<[f64; 2]>,
    /// Lines, the same ones in every panel of a figure.
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

/// Draws the panels in rows of `columns` under a legend.
pub fn draw(panels: &[Panel], columns: usize) -> Result<String, EvaluateError> {
    let rows = panels.len().div_ceil(columns);
    let mut svg = String::new();
    {
        let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32 + LEGEND);
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(figure)?;
        let (top, rest) = area.split_vertically(LEGEND);
        if let Some(panel) = panels.first() {
            legend(panel, &top)?;
        }
        for (panel, area) in panels.iter().zip(rest.split_evenly((rows, columns))) {
            panel_on(panel, &area)?;
        }
        area.present().map_err(figure)?;
    }
    Ok(svg)
}

fn legend(panel: &Panel, area: &Area) -> Result<(), EvaluateError> {
    let mut x = 16;
    for (series, colour) in panel.series.iter().zip(COLOURS.iter().cycle()) {
        let line = PathElement::new(vec![(x, 17), (x + 18, 17)], colour.stroke_width(3));
        area.draw(&line).map_err(figure)?;
        let text = Text::new(series.name.as_str(), (x + 23, 11), ("sans-serif", 12));
        area.draw(&text).map_err(figure)?;
        x += 42 + 6 * series.name.len() as i32;
    }
    Ok(())
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn panel_on(panel: &Panel, area: &Area) -> Result<(), EvaluateError> {
    let [x0, x1] = limits(panel, |point| point.0);
    let [y0, y1] = panel.y_limits.unwrap_or_else(|| limits(panel, |point| point.1));
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
    // On a logarithmic axis 1, 2 and 5 of each decade.
    let number = |x: &f64| {
        let leading = x / 10_f64.powf(x.log10().floor());
        let shown = [1.0, 2.0, 5.0, 10.0].iter().any(|digit| (leading - digit).abs() < 1e-6);
        if panel.logarithmic && !shown {
            return String::new();
        }
        format!("{}", (x * 1e6).round() / 1e6)
    };
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
fn limits(panel: &Panel, of: fn(&(f64, f64)) -> f64) -> [f64; 2] {
    let all = || panel.series.iter().flat_map(|s| &s.points).map(of);
    let usable = |x: &f64| x.is_finite() && (!panel.logarithmic || *x > 0.0);
    let low = all().filter(usable).fold(f64::INFINITY, f64::min);
    let high = all().filter(usable).fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return [1.0, 10.0];
    }
    if panel.logarithmic {
        // Whole decades: the axis is labelled from one to the next.
        return [10_f64.powf(low.log10().floor()), 10_f64.powf(high.log10().ceil())];
    }
    let margin = if high > low { 0.05 * (high - low) } else { 1.0 };
    [low - margin, high + margin]
}

fn figure(error: impl std::fmt::Display) -> EvaluateError {
    EvaluateError::Figure(error.to_string())
}
