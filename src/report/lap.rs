//! A flight from above, coloured by speed (the paper's Figures 2 and 5).

use super::{drawing, viridis};
use crate::eval::fly::Moment;
use crate::track::{GateKind, Track};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const SIZE: (u32, u32) = (900, 900);
/// Width of the colour scale, pixels.
const SCALE: u32 = 110;

/// An SVG of `trace` over the gates of `track`.
pub fn svg(track: &Track, trace: &[Moment], title: &str) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(drawing)?;
        let (map, scale) = root.split_horizontally(SIZE.0 - SCALE);
        let top = trace.iter().map(speed).fold(1.0, f64::max);
        draw_map(&map, track, trace, top, title)?;
        draw_scale(&scale, top)?;
        root.present().map_err(drawing)?;
    }
    Ok(text)
}

fn speed(m: &Moment) -> f64 {
    f64::from(m.vx.powi(2) + m.vy.powi(2) + m.vz.powi(2)).sqrt()
}

fn draw_map(
    area: &DrawingArea<SVGBackend, Shift>,
    track: &Track,
    trace: &[Moment],
    top: f64,
    title: &str,
) -> anyhow::Result<()> {
    let points = || {
        let gates = track.gates.iter().map(|g| (g.position_m[0], g.position_m[1]));
        let start = (track.start.position_m[0], track.start.position_m[1]);
        gates.chain([start]).chain(trace.iter().map(|m| (f64::from(m.x), f64::from(m.y))))
    };
    let range = |of: fn((f64, f64)) -> f64| {
        points().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    // Equal scales: the longer side decides.
    let (x, y) = (range(|p| p.0), range(|p| p.1));
    let half = 0.5 * (x.1 - x.0).max(y.1 - y.0) + 2.0;
    let around = |(low, high): (f64, f64)| 0.5 * (low + high) - half..0.5 * (low + high) + half;
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(56)
        .build_cartesian_2d(around(x), around(y))
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .label_style(("sans-serif", 16))
        .x_desc("x, east, m")
        .y_desc("y, north, m")
        .draw()
        .map_err(drawing)?;

    for pair in trace.windows(2) {
        let at = |m: &Moment| (f64::from(m.x), f64::from(m.y));
        let line = PathElement::new([at(&pair[0]), at(&pair[1])], viridis(speed(&pair[0]) / top).stroke_width(4));
        chart.draw_series([line]).map_err(drawing)?;
    }
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
        let bar = PathElement::new([along(0.0, -half), along(0.0, half)], style);
        let arrow = PathElement::new([along(0.0, 0.0), along(1.2, 0.0)], style);
        chart.draw_series([bar, arrow]).map_err(drawing)?;
        // Gates one above the other get their names side by side.
        let above = track.gates[..i].iter().filter(|g| (g.position() - p).xy().norm() < 0.5).count();
        let font = ("sans-serif", 18).into_font().color(&BLACK);
        let label = Text::new(track.gate_label(i), along(-0.4, half + 0.7 + 1.1 * above as f64), font);
        chart.draw_series([label]).map_err(drawing)?;
    }
    let start = (track.start.position_m[0], track.start.position_m[1]);
    chart.draw_series([TriangleMarker::new(start, 9, BLACK.filled())]).map_err(drawing)?;
    let font = ("sans-serif", 18).into_font().color(&BLACK);
    let below = (start.0, start.1 - 0.9);
    let centred = font.pos(Pos::new(HPos::Center, VPos::Center));
    chart.draw_series([Text::new("start", below, centred)]).map_err(drawing)?;
    Ok(())
}

fn draw_scale(area: &DrawingArea<SVGBackend, Shift>, top: f64) -> anyhow::Result<()> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(50)
        .margin_bottom(60)
        .margin_right(64)
        .margin_left(4)
        .right_y_label_area_size(0)
        .build_cartesian_2d(0.0..1.0, 0.0..top)
        .map_err(drawing)?;
    const BANDS: usize = 100;
    for i in 0..BANDS {
        let at = |i: usize| top * i as f64 / BANDS as f64;
        let band = Rectangle::new([(0.0, at(i)), (1.0, at(i + 1))], viridis(i as f64 / BANDS as f64).filled());
        chart.draw_series([band]).map_err(drawing)?;
    }
    let font = || ("sans-serif", 16).into_font().color(&BLACK);
    let step = if top > 12.0 { 5.0 } else { 2.0 };
    let mut mark = 0.0;
    while mark < top {
        chart.draw_series([Text::new(format!("{mark:.0}"), (1.15, mark + 0.01 * top), font())]).map_err(drawing)?;
        mark += step;
    }
    area.draw(&Text::new("speed, m/s", (0, 26), font())).map_err(drawing)
}
