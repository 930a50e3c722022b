//! Learning curves of a run: what was gathered while training, and how its snapshots did (the paper's Figure 3).

use super::drawing;
use super::plot::{BLUE as BLUE_, ORANGE};
use crate::base::error::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

const SIZE: (u32, u32) = (900, 700);

/// One iteration.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub minutes: f64,
    /// Mean gates passed in the episodes that ended; none ended in some iterations.
    pub gates: Option<f64>,
}

/// One snapshot's evaluation.
#[derive(Clone, Copy, Debug)]
pub struct SnapshotMark {
    pub minutes: f64,
    /// Share of agents that completed a lap from the pad and from along the spline, 0..1.
    pub fixed: f64,
    pub random: f64,
    /// Whether it is the one that was kept.
    pub chosen: bool,
}

/// An SVG with lap completion of the snapshots above and gates an episode below, over minutes of training.
pub fn svg(curve: &[Point], snapshots: &[SnapshotMark], title: &str) -> Result<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(drawing)?;
        let root = root.titled(title, ("sans-serif", 20)).map_err(drawing)?;
        let (above, below) = root.split_vertically(340);
        let end = curve.last().map_or(1.0, |p| p.minutes);
        draw_completion(&above, snapshots, end)?;
        draw_gates(&below, curve, end)?;
        root.present().map_err(drawing)?;
    }
    Ok(text)
}

fn draw_completion(area: &DrawingArea<SVGBackend, Shift>, snapshots: &[SnapshotMark], end: f64) -> Result<()> {
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..end * 1.02, 0.0..105.0)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", 16))
        .y_desc("agents that complete a lap, %")
        .x_desc("training, minutes")
        .draw()
        .map_err(drawing)?;
    type MarkValue = fn(&SnapshotMark) -> f64;
    let lines: [(&str, RGBColor, MarkValue); 2] =
        [("fixed start", BLUE_, |s| s.fixed), ("random start", ORANGE, |s| s.random)];
    for (name, colour, of) in lines {
        let points = || snapshots.iter().map(|s| (s.minutes, 100.0 * of(s)));
        chart
            .draw_series(LineSeries::new(points(), colour.stroke_width(2)))
            .map_err(drawing)?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
        chart.draw_series(points().map(|p| Circle::new(p, 4, colour.filled()))).map_err(drawing)?;
    }
    let criterion = [(0.0, 95.0), (end * 1.02, 95.0)];
    chart
        .draw_series(DashedLineSeries::new(criterion, 6, 4, BLACK.stroke_width(1)))
        .map_err(drawing)?
        .label("95 %, ready for deployment")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 20, y)], BLACK));
    let chosen = snapshots.iter().filter(|s| s.chosen).map(|s| (s.minutes, 100.0 * s.fixed));
    chart
        .draw_series(chosen.map(|p| Circle::new(p, 9, BLACK.stroke_width(2))))
        .map_err(drawing)?
        .label("kept")
        .legend(|(x, y)| Circle::new((x + 10, y), 6, BLACK.stroke_width(2)));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::MiddleRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 16))
        .draw()
        .map_err(drawing)
}

fn draw_gates(area: &DrawingArea<SVGBackend, Shift>, curve: &[Point], end: f64) -> Result<()> {
    let top = curve.iter().filter_map(|p| p.gates).fold(1.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..end * 1.02, 0.0..top * 1.05)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .label_style(("sans-serif", 16))
        .x_desc("training, minutes")
        .y_desc("gates an episode, training")
        .draw()
        .map_err(drawing)?;
    let points = curve.iter().filter_map(|p| Some((p.minutes, p.gates?)));
    chart.draw_series(LineSeries::new(points, BLUE_.stroke_width(1))).map_err(drawing)?;
    Ok(())
}
