//! What pictures from above share: equal scales, gates, the start, paths, a scale of speeds.

use super::drawing;
use super::plot::{Chart, TEXT};
use crate::base::error::Result;
use crate::model::track::{GateKind, Track};
use crate::present::colour::viridis;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A place from above, m.
pub type MapPoint = (f64, f64);

/// Axes of equal scale around the track and all `places`.
pub fn chart<'a, 'b>(
    area: &DrawingArea<SVGBackend<'b>, Shift>,
    track: &Track,
    places: impl Iterator<Item = MapPoint>,
    title: &str,
) -> Result<Chart<'a, 'b>> {
    let gates = track.gates.iter().map(|g| (g.position_m[0], g.position_m[1]));
    let start = (track.start.position_m[0], track.start.position_m[1]);
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for (x, y) in gates.chain([start]).chain(places) {
        for (end, value) in ends.iter_mut().zip([x, y]) {
            *end = [end[0].min(value), end[1].max(value)];
        }
    }
    // The side that needs more metres a pixel decides.
    let (width, height) = area.dim_in_pixel();
    const FRAME: [u32; 2] = [56 + 24, 46 + 24 + 28];
    let pixels = [width.saturating_sub(FRAME[0]).max(1), height.saturating_sub(FRAME[1]).max(1)].map(f64::from);
    let wanted = ends.map(|[low, high]| high - low + 6.0);
    let scale = (wanted[0] / pixels[0]).max(wanted[1] / pixels[1]);
    let around = |axis: usize| {
        let middle = 0.5 * (ends[axis][0] + ends[axis][1]);
        middle - 0.5 * scale * pixels[axis]..middle + 0.5 * scale * pixels[axis]
    };
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(56)
        .build_cartesian_2d(around(0), around(1))
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .label_style(("sans-serif", TEXT))
        .x_desc("x, east, m")
        .y_desc("y, north, m")
        .draw()
        .map_err(drawing)?;
    Ok(chart)
}

/// A line through `places`.
pub fn path(chart: &mut Chart, places: impl IntoIterator<Item = MapPoint>, style: ShapeStyle) -> Result<()> {
    chart.draw_series([PathElement::new(places.into_iter().collect::<Vec<_>>(), style)]).map_err(drawing)?;
    Ok(())
}

/// The reset spline, dotted.
pub fn spline(chart: &mut Chart, track: &Track) -> Result<()> {
    const DOTS: usize = 400;
    let dots = track.reset_spline().samples(DOTS).into_iter();
    let dots = dots.map(|s| Circle::new((s.position.x, s.position.y), 1, BLACK.mix(0.45).filled()));
    chart.draw_series(dots).map_err(drawing)?;
    Ok(())
}

/// A line through `places` coloured by the speed (m/s) beside each, of at most `top`.
pub fn coloured(chart: &mut Chart, places: &[(MapPoint, f64)], top: f64) -> Result<()> {
    let pieces = places
        .windows(2)
        .map(|pair| PathElement::new([pair[0].0, pair[1].0], viridis(pair[0].1 / top).stroke_width(4)));
    chart.draw_series(pieces).map_err(drawing)?;
    Ok(())
}

/// Gates with their names and directions of crossing, and the start.
pub fn gates(chart: &mut Chart, track: &Track) -> Result<()> {
    for (i, gate) in track.gates.iter().enumerate() {
        let (p, rotation) = (gate.position(), gate.rotation());
        let half = 0.5 * gate.outer_m.unwrap_or(2.0 * gate.radius_m);
        let along = |forward: f64, left: f64| {
            let q = p + rotation * nalgebra::Vector3::new(forward, left, 0.0);
            (q.x, q.y)
        };
        let style = match gate.kind {
            GateKind::Physical => BLACK.stroke_width(3),
            GateKind::Virtual => BLACK.mix(0.4).stroke_width(2),
        };
        path(chart, [along(0.0, -half), along(0.0, half)], style)?;
        path(chart, [along(0.0, 0.0), along(1.2, 0.0)], style)?;
        path(chart, [along(0.8, 0.25), along(1.2, 0.0), along(0.8, -0.25)], style)?;
        // Gates one above the other get their names side by side.
        let above = track.gates[..i].iter().filter(|g| (g.position() - p).xy().norm() < 0.5).count();
        // Virtual gates often stand beside physical ones: their names go to the other side.
        let side = if gate.kind == GateKind::Physical { 1.0 } else { -1.0 };
        let place = along(0.0, side * (half + 0.7 + 1.1 * above as f64));
        chart.draw_series([Text::new(track.gate_label(i), place, centred())]).map_err(drawing)?;
    }
    let start = (track.start.position_m[0], track.start.position_m[1]);
    chart.draw_series([TriangleMarker::new(start, 9, BLACK.filled())]).map_err(drawing)?;
    chart.draw_series([Text::new("start", (start.0, start.1 - 0.9), centred())]).map_err(drawing)?;
    Ok(())
}

fn centred() -> TextStyle<'static> {
    ("sans-serif", 18).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Center))
}

/// A scale of speeds up to `top`, m/s.
pub fn scale(area: &DrawingArea<SVGBackend, Shift>, top: f64) -> Result<()> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(50)
        .margin_bottom(60)
        .margin_right(64)
        .margin_left(4)
        .right_y_label_area_size(0)
        .build_cartesian_2d(0.0..1.0, 0.0..top)
        .map_err(drawing)?;
    const BANDS: usize = 100;
    let at = |i: usize| top * i as f64 / BANDS as f64;
    let bands = (0..BANDS)
        .map(|i| Rectangle::new([(0.0, at(i)), (1.0, at(i + 1).min(top))], viridis(i as f64 / BANDS as f64).filled()));
    chart.draw_series(bands).map_err(drawing)?;
    let font = || ("sans-serif", TEXT).into_font().color(&BLACK);
    let step = if top > 12.0 { 5.0 } else { 2.0 };
    let mut mark = 0.0;
    while mark < top {
        chart.draw_series([Text::new(format!("{mark:.0}"), (1.15, mark + 0.01 * top), font())]).map_err(drawing)?;
        mark += step;
    }
    area.draw(&Text::new("speed, m/s", (0, 26), font())).map_err(drawing)
}
