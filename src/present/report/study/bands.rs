//! Settings over their seeds: median and quartiles (the paper's Figure 4).

use super::learning::axis;
use super::marks::{self, Key};
use super::{StudyFigure, best};
use crate::base::error::Result;
use crate::present::report::drawing;
use crate::present::report::plot::{self, Area};
use crate::present::study::bands::{Band, band};
use crate::present::study::curves::{At, Curve, Curves, Over};
use crate::present::study::results::Results;
use crate::race::eval::choose::DEPLOYABLE;
use plotters::prelude::*;

const PANEL: u32 = 380;

/// Of the share of agents that complete a lap.
pub fn completion(results: &Results, curves: &Curves) -> Result<StudyFigure> {
    let what = What { name: "seed-bands-completion", axis: "fixed starts that lap, %", of: |curve| &curve.completion };
    let caption = "Fixed-start lap completion of the snapshots: median and quartiles over the seeds of each of the \
best settings. Dashed: 95 %, ready for deployment.";
    draw(results, curves, &what, Some(0.0..105.0), false, caption.into())
}

/// Of what was gathered while training.
pub fn learning(results: &Results, curves: &Curves) -> Result<StudyFigure> {
    let what = What { name: "seed-bands-learning", axis: curves.what, of: |curve| &curve.learning };
    let caption = format!(
        "Learning curves: median and quartiles over the seeds of each of the best settings. Shapes: where the median \
seed has its first snapshot with which {:.0} % of random-start agents pass a section.",
        100.0 * results.plan.section_share
    );
    draw(results, curves, &what, None, true, caption)
}

struct What<'a> {
    name: &'static str,
    axis: &'a str,
    of: fn(&Curve) -> &[At],
}

fn draw(
    results: &Results,
    curves: &Curves,
    what: &What,
    range: Option<std::ops::Range<f64>>,
    sections: bool,
    caption: String,
) -> Result<StudyFigure> {
    let bands = |over| best(results).into_iter().filter_map(move |setting| band(curves, setting, over, what.of));
    let (minutes, steps): (Vec<Band>, Vec<Band>) = (bands(Over::Minutes).collect(), bands(Over::Steps).collect());
    let name = |(i, band): (usize, &Band)| {
        let seeds = if band.runs == 1 { "1 seed".into() } else { format!("{} seeds", band.runs) };
        (marks::colour(i), format!("{}, {seeds}", results.plan.settings[band.setting].name))
    };
    let names = results.plan.sections.iter().enumerate().filter(|_| sections);
    let key = Key {
        lines: minutes.iter().enumerate().map(name).collect(),
        shapes: names.map(|(i, section)| (marks::section(i), format!("passes the {section}"))).collect(),
    };
    let y = range.unwrap_or_else(|| {
        plot::range(minutes.iter().chain(&steps).flat_map(|b| &b.points).flat_map(|(_, quartiles)| *quartiles))
    });
    let svg = plot::svg(key.height() as u32 + 2 * PANEL, |root| {
        let (names, panels) = root.split_vertically(key.height());
        key.draw(&names)?;
        let (above, below) = panels.split_vertically(PANEL);
        panel(&above, &minutes, [axis(Over::Minutes), what.axis], y.clone(), sections)?;
        panel(&below, &steps, [axis(Over::Steps), what.axis], y.clone(), sections)
    })?;
    Ok(StudyFigure { name: what.name, caption, svg })
}

fn panel(area: &Area, bands: &[Band], axes: [&str; 2], y: std::ops::Range<f64>, sections: bool) -> Result<()> {
    let end = bands.iter().filter_map(|band| Some(band.points.last()?.0)).fold(1e-9, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..1.02 * end, y)
        .map_err(drawing)?;
    plot::mesh(&mut chart, axes[0], axes[1], [10, 6])?;
    for (i, band) in bands.iter().enumerate().rev() {
        let edge = |q: usize| band.points.iter().map(move |(x, quartiles)| (*x, quartiles[q]));
        let around: Vec<_> = edge(0).chain(edge(2).rev()).collect();
        chart.draw_series([Polygon::new(around, marks::colour(i).mix(0.18))]).map_err(drawing)?;
    }
    for (i, band) in bands.iter().enumerate().rev() {
        let median = band.points.iter().map(|(x, quartiles)| (*x, quartiles[1]));
        plot::line(&mut chart, median, marks::colour(i).stroke_width(3))?;
        for (s, at) in band.sections.iter().enumerate().filter(|_| sections).filter_map(|(s, at)| Some((s, (*at)?))) {
            marks::draw(&mut chart, at, &marks::section(s), [marks::colour(i), BLACK])?;
        }
    }
    if !sections {
        let level = 100.0 * DEPLOYABLE;
        let criterion = DashedLineSeries::new([(0.0, level), (1.02 * end, level)], 6, 4, BLACK.stroke_width(1));
        chart.draw_series(criterion).map_err(drawing)?;
    }
    Ok(())
}
