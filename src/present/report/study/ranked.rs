//! The settings in order: each run, the mean and its interval.

use super::StudyFigure;
use crate::base::error::Result;
use crate::present::report::drawing;
use crate::present::report::plot::{self, TEXT};
use crate::present::study::results::Results;
use crate::race::eval::choose::DEPLOYABLE;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Height of a setting, pixels.
const ROW: u32 = 24;
/// Width of a letter, pixels.
const LETTER: u32 = 8;

/// Fixed-start lap completion, a row each setting.
pub fn figure(results: &Results) -> Result<StudyFigure> {
    let n = results.ranking.len();
    let longest = results.ranking.iter().map(|place| place.setting.len() + 4).max().unwrap_or_default() as u32;
    let left = (LETTER * longest).clamp(80, 460);
    let svg = plot::svg(ROW * n as u32 + 70, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(10)
            .margin_right(if results.ranking.iter().any(|place| place.best.is_some()) { 190 } else { 20 })
            .x_label_area_size(44)
            .y_label_area_size(left)
            .build_cartesian_2d(0.0..100.0, -0.5 - n as f64..-0.5)
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .label_style(("sans-serif", TEXT))
            .x_label_formatter(&|x| format!("{x:.0}"))
            .x_desc("fixed starts that complete a lap, %")
            .disable_y_mesh()
            .y_labels(0)
            .draw()
            .map_err(drawing)?;
        let level = 100.0 * DEPLOYABLE;
        let ends = [(level, -0.5), (level, -0.5 - n as f64)];
        chart.draw_series(DashedLineSeries::new(ends, 6, 4, BLACK.mix(0.5).stroke_width(1))).map_err(drawing)?;
        for (row, place) in results.ranking.iter().enumerate() {
            let y = -1.0 - row as f64;
            let runs = results.runs.iter().flatten().filter(|run| run.setting == place.setting);
            let dots = runs.map(|run| (100.0 * run.fixed.lap_completion, y));
            chart.draw_series(dots.map(|at| Circle::new(at, 4, plot::ORANGE.mix(0.6).filled()))).map_err(drawing)?;
            let group = results.settings.iter().find(|group| group.name == place.setting);
            let summary = group.and_then(|group| group.metrics.get("fixed_completion"));
            if let Some([low, high]) = summary.and_then(|summary| summary.interval) {
                plot::line(&mut chart, [(100.0 * low, y), (100.0 * high, y)], plot::BLUE.stroke_width(2))?;
            }
            let mean = (100.0 * place.score, y);
            let bar = EmptyElement::at(mean) + Rectangle::new([(-2, -8), (2, 8)], plot::BLUE.filled());
            chart.draw_series([bar]).map_err(drawing)?;
            let font = |side| ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(side, VPos::Center));
            let (x0, y0) = chart.backend_coord(&(0.0, y));
            let name = format!("{}. {}", place.rank, place.setting);
            root.draw(&Text::new(name, (x0 - 8, y0), font(HPos::Right))).map_err(drawing)?;
            if let (Some(best), Some([low, high])) = (place.best, place.ranks) {
                let (x1, _) = chart.backend_coord(&(100.0, y));
                let text = format!("best {:.0} %, rank {low} to {high}", 100.0 * best);
                root.draw(&Text::new(text, (x1 + 12, y0), font(HPos::Left))).map_err(drawing)?;
            }
        }
        Ok(())
    })?;
    let caption = "Settings by mean fixed-start lap completion of their runs' best snapshots (bars, with the 95 % \
interval of the mean where there are several seeds); dots are runs. Dashed: 95 %, ready for deployment. To the right: \
how often a setting is the best, and where it ranks, when the seeds are drawn again.";
    Ok(StudyFigure { name: "ranking", caption: caption.into(), svg })
}
