//! What each axis does to smoothness, saturation, lap time and success: means over all else.

use super::StudyFigure;
use crate::base::error::Result;
use crate::present::report::drawing;
use crate::present::report::plot::{self, Area, TEXT};
use crate::present::study::results::{Results, RunGroup};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Heading, metric and factor of a column.
const COLUMNS: [(&str, &str, f64); 4] = [
    ("fixed starts that lap, %", "fixed_completion", 100.0),
    ("median lap, s", "lap_time_median_s", 1.0),
    ("mean |Δa|²", "action_change_sq", 1.0),
    ("|a| > 0.95, %", "saturated_share", 100.0),
];
const ROW: u32 = 200;
const HEAD: i32 = 30;

/// A row each axis, a column each metric; none of a study with a single axis.
pub fn figure(results: &Results) -> Result<Option<StudyFigure>> {
    let axes = &results.axes;
    if axes.is_empty() {
        return Ok(None);
    }
    let svg = plot::svg(ROW * axes.len() as u32 + HEAD as u32, |root| {
        let (head, rows) = root.split_vertically(HEAD);
        let columns = rows.split_evenly((axes.len(), COLUMNS.len()));
        for (c, ((heading, metric, factor), title)) in
            COLUMNS.iter().zip(head.split_evenly((1, COLUMNS.len()))).enumerate()
        {
            let font = ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Center));
            let middle = (title.dim_in_pixel().0 as i32 / 2 + 20, HEAD / 2);
            title.draw(&Text::new(heading.to_string(), middle, font)).map_err(drawing)?;
            // One scale a metric, so that axes can be compared.
            let values = axes.iter().flat_map(|(_, levels)| levels).filter_map(|level| level.metrics.get(*metric));
            let ends = values.flat_map(|s| s.interval.unwrap_or([s.mean; 2]).map(|x| factor * x));
            let range = plot::range(ends);
            let range = if range.start.is_finite() { range } else { 0.0..1.0 };
            for (r, (axis, levels)) in axes.iter().enumerate() {
                panel(&columns[r * COLUMNS.len() + c], axis, levels, (metric, *factor), range.clone())?;
            }
        }
        Ok(())
    })?;
    let caption = "Each value of each axis: mean over all other axes and seeds, with its 95 % interval. The scale of a \
column is the same in all rows.";
    Ok(Some(StudyFigure { name: "axes", caption: caption.into(), svg }))
}

fn panel(
    area: &Area,
    axis: &str,
    levels: &[RunGroup],
    (metric, factor): (&str, f64),
    range: std::ops::Range<f64>,
) -> Result<()> {
    let bottom = range.start;
    let mut chart = ChartBuilder::on(area)
        .margin_right(8)
        .margin_bottom(48)
        .margin_top(6)
        .y_label_area_size(52)
        .build_cartesian_2d(-0.5..levels.len() as f64 - 0.5, range)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .label_style(("sans-serif", TEXT - 2))
        .disable_x_mesh()
        .x_labels(0)
        .y_labels(4)
        .draw()
        .map_err(drawing)?;
    let means = levels.iter().enumerate().filter_map(|(i, level)| Some((i as f64, level.metrics.get(metric)?)));
    let means: Vec<_> = means.collect();
    plot::line(&mut chart, means.iter().map(|(x, s)| (*x, factor * s.mean)), plot::BLUE.mix(0.5).stroke_width(1))?;
    for (x, summary) in means {
        if let Some([low, high]) = summary.interval {
            plot::line(&mut chart, [(x, factor * low), (x, factor * high)], plot::BLUE.stroke_width(2))?;
        }
        chart.draw_series([Circle::new((x, factor * summary.mean), 5, plot::BLUE.filled())]).map_err(drawing)?;
    }
    let font = || ("sans-serif", TEXT - 2).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Center));
    let (left, top) = area.get_base_pixel();
    let at = |x: f64, below: i32| {
        let (px, py) = chart.backend_coord(&(x, bottom));
        (px - left, py - top + below)
    };
    for (i, level) in levels.iter().enumerate() {
        area.draw(&Text::new(level.name.clone(), at(i as f64, 14), font())).map_err(drawing)?;
    }
    let middle = 0.5 * (levels.len() as f64 - 1.0);
    area.draw(&Text::new(axis.to_string(), at(middle, 34), font())).map_err(drawing)
}
