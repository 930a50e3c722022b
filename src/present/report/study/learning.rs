//! Learning curves of all runs, with sections and chosen snapshots marked (the paper's Figure 3).

use super::marks::{self, Key};
use super::{StudyFigure, best};
use crate::base::error::Result;
use crate::present::report::drawing;
use crate::present::report::plot::{self, Area, TEXT};
use crate::present::study::curves::{Curve, Curves, Over};
use crate::present::study::results::Results;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const PANEL: u32 = 400;
/// Runs that are not among the best, and their stars.
const OTHERS: RGBColor = RGBColor(210, 210, 210);
const DARKER: RGBColor = RGBColor(165, 165, 165);

/// Over time above, over steps below.
pub fn figure(results: &Results, curves: &Curves) -> Result<StudyFigure> {
    // Of each of the best settings the best run; of equals that with the lowest seed.
    let of = |setting: usize| {
        let runs = curves.runs.iter().filter(|curve| curve.setting == setting);
        runs.reduce(|a, b| if b.best_completion > a.best_completion { b } else { a })
    };
    let shown: Vec<&Curve> = best(results).into_iter().filter_map(of).collect();
    let name = |(i, curve): (usize, &&Curve)| {
        let run = &results.plan.runs[curve.run].name;
        (marks::colour(i), format!("{}  {run}: {:.1} % of fixed starts lap", i + 1, curve.best_completion))
    };
    let sections = results.plan.sections.iter().enumerate();
    let passed = sections.map(|(i, section)| (marks::section(i), format!("passes the {section}")));
    let key = Key {
        lines: shown.iter().enumerate().map(name).collect(),
        shapes: passed.chain([(marks::star(9.0), "best snapshot".into())]).collect(),
    };
    let svg = plot::svg(key.height() as u32 + 2 * PANEL, |root| {
        let (names, panels) = root.split_vertically(key.height());
        key.draw(&names)?;
        let (above, below) = panels.split_vertically(PANEL);
        panel(&above, curves, &shown, Over::Minutes)?;
        panel(&below, curves, &shown, Over::Steps)
    })?;
    let share = 100.0 * results.plan.section_share;
    let caption = format!(
        "Learning curves of {} runs, smoothed. In colour: of each of the best settings the run that laps most. Shapes: \
the first snapshot with which {share:.0} % of random-start agents pass a section. Stars: the snapshot chosen by \
fixed-start lap completion.",
        curves.runs.len()
    );
    Ok(StudyFigure { name: "learning-curves", caption, svg })
}

fn panel(area: &Area, curves: &Curves, shown: &[&Curve], over: Over) -> Result<()> {
    let all = || curves.runs.iter().flat_map(|curve| &curve.learning);
    let end = all().map(|at| over.x(at)).fold(0.0, f64::max).max(1e-9);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .margin_right(30)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..1.02 * end, plot::range(all().map(|at| at.value)))
        .map_err(drawing)?;
    plot::mesh(&mut chart, axis(over), curves.what, [10, 6])?;
    let line = |curve: &Curve| curve.learning.iter().map(|at| (over.x(at), at.value)).collect::<Vec<_>>();
    for curve in curves.runs.iter().filter(|curve| shown.iter().all(|s| s.run != curve.run)) {
        plot::line(&mut chart, line(curve), OTHERS.stroke_width(1))?;
        marks::draw(&mut chart, (over.x(&curve.best), curve.best.value), &marks::star(4.0), [DARKER; 2])?;
    }
    // The best on top.
    for (i, curve) in shown.iter().enumerate().rev() {
        plot::line(&mut chart, line(curve), marks::colour(i).stroke_width(2))?;
        if let Some(last) = curve.learning.last() {
            let font =
                ("sans-serif", TEXT).into_font().color(&marks::colour(i)).pos(Pos::new(HPos::Left, VPos::Center));
            let label = EmptyElement::at((over.x(last), last.value)) + Text::new((i + 1).to_string(), (5, 0), font);
            chart.draw_series([label]).map_err(drawing)?;
        }
    }
    for (i, curve) in shown.iter().enumerate().rev() {
        for (s, at) in curve.sections.iter().enumerate().filter_map(|(s, at)| Some((s, (*at)?))) {
            marks::draw(&mut chart, (over.x(&at), at.value), &marks::section(s), [marks::colour(i), BLACK])?;
        }
        marks::draw(&mut chart, (over.x(&curve.best), curve.best.value), &marks::star(9.0), [marks::colour(i), BLACK])?;
    }
    Ok(())
}

/// Name of the horizontal axis.
pub fn axis(over: Over) -> &'static str {
    match over {
        Over::Minutes => "training, minutes",
        Over::Steps => "training, million steps",
    }
}
