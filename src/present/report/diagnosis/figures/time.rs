//! Measured and predicted where the prediction is worst, and the error over the flight.

use super::{AFTER, BEFORE};
use crate::base::error::Result;
use crate::insight::diagnose::figures::ChannelFigure;
use crate::insight::diagnose::figures::windows::Window;
use crate::present::report::drawing;
use crate::present::report::page::unit;
use crate::present::report::plot::{self, Area, TEXT, line, mesh, range};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const ABOVE: u32 = 270;
const BELOW: u32 = 190;

/// The worst stretches side by side, the whole flight below.
pub fn draw(channel: &ChannelFigure) -> Result<String> {
    plot::keyed(ABOVE + BELOW, &series().map(|(_, style, name)| (name, style)), |root| {
        let (above, below) = root.split_vertically(ABOVE);
        for (i, (area, window)) in
            above.split_evenly((1, channel.windows.len())).iter().zip(&channel.windows).enumerate()
        {
            stretch(area, channel, window, i)?;
        }
        whole(&below, channel)
    })
}

fn stretch(area: &Area, channel: &ChannelFigure, window: &Window, i: usize) -> Result<()> {
    let points = &window.points;
    let y = range(points.iter().flat_map(|p| p[1..].iter().copied()));
    let flight = window.flight.map_or(String::new(), |f| format!(" of flight {f}"));
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{}: {:.1} s{flight}", mark(i), points[0][0]), ("sans-serif", 18))
        .margin(6)
        .x_label_area_size(42)
        .y_label_area_size(if i == 0 { 66 } else { 50 })
        .build_cartesian_2d(points[0][0]..points[points.len() - 1][0], y)
        .map_err(drawing)?;
    let label = if i == 0 { format!("{}, {}", channel.name, unit(channel.unit)) } else { String::new() };
    mesh(&mut chart, "time, s", &label, [4, 6])?;
    for (k, style, _) in series() {
        line(&mut chart, points.iter().map(|p| (p[0], p[k])), style)?;
    }
    Ok(())
}

/// Lines from the bottom to the top: place in a point, style, name. What was measured shows behind what was predicted.
fn series() -> [(usize, ShapeStyle, &'static str); 3] {
    [
        (1, BLACK.mix(0.35).stroke_width(4), "measured"),
        (2, BEFORE.stroke_width(2), "predicted before"),
        (3, AFTER.stroke_width(2), "predicted after"),
    ]
}

fn mark(i: usize) -> char {
    char::from(b'A' + i as u8)
}

fn whole(area: &Area, channel: &ChannelFigure) -> Result<()> {
    let errors = &channel.errors;
    let top = 1.2 * errors.pieces.iter().flatten().map(|p| p[1].max(p[2])).fold(1e-12, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .x_label_area_size(42)
        .y_label_area_size(66)
        .build_cartesian_2d(0.0..errors.end_s.max(1.0), 0.0..top)
        .map_err(drawing)?;
    for (i, [from, to]) in errors.marks.iter().enumerate() {
        chart.draw_series([Rectangle::new([(*from, 0.0), (*to, top)], BLACK.mix(0.12).filled())]).map_err(drawing)?;
        let font = ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Top));
        let text = Text::new(mark(i).to_string(), (0.5 * (from + to), top), font);
        chart.draw_series([text]).map_err(drawing)?;
    }
    mesh(&mut chart, "time, s", &format!("error, {}", unit(channel.unit)), [12, 5])?;
    for (k, colour) in [(1, BEFORE), (2, AFTER)] {
        for piece in &errors.pieces {
            line(&mut chart, piece.iter().map(|p| (p[0], p[k])), colour.stroke_width(2))?;
        }
    }
    Ok(())
}
