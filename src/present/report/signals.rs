//! A channel: measured and predicted over time, the residual below (the paper's Figure 1).

use crate::base::error::Result;
use crate::insight::identify::rates::Compared;
use crate::insight::identify::result::ComparedChannel;
use crate::present::report::drawing;
use crate::present::report::plot::{self, Area, Chart, legend, mesh, range};
use plotters::prelude::*;

const HEIGHT: u32 = 420;
/// Points drawn of a signal; a screen shows no more.
const POINTS: usize = 3000;
/// Blue and orange that differ in lightness too.
const MEASURED: RGBColor = RGBColor(0, 84, 147);
const PREDICTED: RGBColor = RGBColor(230, 140, 0);

/// An SVG of one channel: the ten seconds around the border between training and validation above, all of the residual
/// below.
pub fn channel(channel: &ComparedChannel) -> Result<String> {
    plot::svg(HEIGHT, |root| {
        let (above, below) = root.split_vertically(HEIGHT * 6 / 10);
        signals(&above, channel)?;
        residual(&below, channel)
    })
}

/// Samples joined end to end, in the order of flight: seconds of data, whatever was left out between.
fn joined(channel: &ComparedChannel) -> (Vec<[f64; 3]>, f64) {
    let mut out = Vec::new();
    let mut clock = 0.0;
    let mut border = 0.0;
    for part in [&channel.train, &channel.validation] {
        border = clock;
        let usual = crate::flight::series::period(&part.time);
        let Compared { time, measured, predicted } = part;
        for i in 0..time.len() {
            out.push([clock, measured[i], predicted[i]]);
            clock += usual;
        }
    }
    (out, border)
}

fn signals(area: &Area, channel: &ComparedChannel) -> Result<()> {
    let (all, border) = joined(channel);
    let shown: Vec<[f64; 3]> = all.into_iter().filter(|p| (p[0] - border).abs() <= 5.0).collect();
    // Room for the legend.
    let y = range(shown.iter().flat_map(|p| [p[1], p[2]]));
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{}: ten seconds around the border", channel.name), ("sans-serif", 18))
        .margin(8)
        .x_label_area_size(30)
        .y_label_area_size(64)
        .build_cartesian_2d(border - 5.0..border + 5.0, y.start..y.end + 0.35 * (y.end - y.start))
        .map_err(drawing)?;
    mesh(&mut chart, "", channel.unit, [10, 6])?;
    for (k, name, colour, width) in [(1, "measured", MEASURED, 2), (2, "predicted", PREDICTED, 1)] {
        let step = shown.len().div_ceil(POINTS).max(1);
        chart
            .draw_series(LineSeries::new(shown.iter().step_by(step).map(|p| (p[0], p[k])), colour.stroke_width(width)))
            .map_err(drawing)?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(3)));
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)?;
    divide(&mut chart, border)
}

fn residual(area: &Area, channel: &ComparedChannel) -> Result<()> {
    let (all, border) = joined(channel);
    let step = all.len().div_ceil(POINTS).max(1);
    // Of each step the largest, so that nothing is hidden.
    let points: Vec<(f64, f64)> = all
        .chunks(step)
        .filter_map(|chunk| {
            let most = chunk.iter().max_by(|a, b| (a[1] - a[2]).abs().total_cmp(&(b[1] - b[2]).abs()))?;
            Some((most[0], most[1] - most[2]))
        })
        .collect();
    let end = points.last().map_or(1.0, |p| p.0.max(1e-3));
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, range(points.iter().map(|p| p.1)))
        .map_err(drawing)?;
    mesh(&mut chart, "usable flight, s", &format!("residual, {}", channel.unit), [10, 6])?;
    chart.draw_series(LineSeries::new(points, BLACK.mix(0.7))).map_err(drawing)?;
    divide(&mut chart, border)
}

/// The border between training and validation.
fn divide(chart: &mut Chart, border: f64) -> Result<()> {
    let y = chart.y_range();
    let line = PathElement::new([(border, y.start), (border, y.end)], BLACK.mix(0.5).stroke_width(2));
    chart.draw_series([line]).map_err(drawing)?;
    Ok(())
}
