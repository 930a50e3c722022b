//! What figures share: colours, axes, legends.

use super::drawing;
use crate::base::error::Result;
use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

// Blue, orange and black are told apart by readers of every kind of colour vision (Okabe and Ito).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const ORANGE: RGBColor = RGBColor(213, 94, 0);
/// Of a figure that fills the width of a page, and of the text in it.
pub const WIDTH: u32 = 960;
pub const TEXT: i32 = 16;

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// A chart over two axes.
pub type On<'a, 'b, X, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>;
pub type Linear = plotters::coord::types::RangedCoordf64;
pub type Chart<'a, 'b> = On<'a, 'b, Linear, Linear>;

/// An SVG of this height that `draw` draws.
pub fn svg(height: u32, draw: impl FnOnce(&Area) -> Result<()>) -> Result<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, height)).into_drawing_area();
        root.fill(&WHITE).map_err(drawing)?;
        draw(&root)?;
        root.present().map_err(drawing)?;
    }
    Ok(text)
}

/// A range that holds all values, with a margin.
pub fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let margin = 0.05 * (high - low).max(1e-9);
    low - margin..high + margin
}

/// Axes with a light grid.
pub fn mesh<X, Y>(chart: &mut On<X, Y>, x: &str, y: &str, labels: [usize; 2]) -> Result<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .label_style(("sans-serif", TEXT))
        .x_desc(x)
        .y_desc(y)
        .x_labels(labels[0])
        .y_labels(labels[1])
        .draw()
        .map_err(drawing)
}

/// The names of all series.
pub fn legend<'a, 'b: 'a, X, Y>(chart: &mut On<'a, 'b, X, Y>, position: SeriesLabelPosition) -> Result<()>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.8))
        .label_font(("sans-serif", TEXT))
        .draw()
        .map_err(drawing)
}

/// A line.
pub fn line<X, Y>(chart: &mut On<X, Y>, points: impl IntoIterator<Item = (f64, f64)>, style: ShapeStyle) -> Result<()>
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    chart.draw_series(LineSeries::new(points, style)).map_err(drawing)?;
    Ok(())
}

/// [`svg`] with the names of all lines above what `draw` draws, where they hide nothing.
pub fn keyed(height: u32, lines: &[(&str, ShapeStyle)], draw: impl FnOnce(&Area) -> Result<()>) -> Result<String> {
    const KEY: u32 = 24;
    svg(height + KEY, |root| {
        let (names, rest) = root.split_vertically(KEY);
        let mut x = 72;
        for (name, style) in lines {
            names.draw(&PathElement::new([(x, 12), (x + 28, 12)], *style)).map_err(drawing)?;
            names.draw(&Text::new(name.to_string(), (x + 36, 4), ("sans-serif", TEXT))).map_err(drawing)?;
            x += 70 + 8 * name.len() as i32;
        }
        draw(&rest)
    })
}
