//! The health of a training: its numbers over time with their bounds, and in words what is wrong.

use super::drawing;
use super::plot::{self, BLUE, ORANGE, TEXT};
use crate::base::error::Result;
use crate::base::stats;
use crate::present::run::health::{BOUNDS, Bound, JudgedNumber};
use maud::{Markup, html};
use plotters::prelude::*;

/// A row of the log: million steps, and the numbers of [`BOUNDS`].
pub type HealthRow = (f64, [Option<f64>; BOUNDS.len()]);

const PANEL: u32 = 140;
/// Points of a curve.
const POINTS: usize = 300;

/// A panel for each number: its mean over parts of the training, and its bounds where they are in sight.
pub fn svg(rows: &[HealthRow]) -> Result<String> {
    plot::svg(PANEL * BOUNDS.len() as u32 + 30, |root| {
        let end = rows.last().map_or(1.0, |row| row.0).max(1e-6);
        for (k, area) in root.split_evenly((BOUNDS.len(), 1)).iter().enumerate() {
            let curve = smoothed(rows, k);
            let y = plot::range(curve.iter().map(|point| point.1).chain(curve.is_empty().then_some(0.0)));
            let mut chart = ChartBuilder::on(area)
                .caption(BOUNDS[k].column, ("sans-serif", TEXT))
                .margin_right(16)
                .x_label_area_size(if k + 1 == BOUNDS.len() { 40 } else { 26 })
                .y_label_area_size(72)
                .build_cartesian_2d(0.0..end, y.clone())
                .map_err(drawing)?;
            plot::mesh(&mut chart, if k + 1 == BOUNDS.len() { "million steps" } else { "" }, "", [8, 4])?;
            for limit in [BOUNDS[k].low, BOUNDS[k].high].into_iter().filter(|limit| y.contains(limit)) {
                plot::line(&mut chart, [(0.0, limit), (end, limit)], ORANGE.stroke_width(1))?;
            }
            plot::line(&mut chart, curve, BLUE.stroke_width(2))?;
        }
        Ok(())
    })
}

fn smoothed(rows: &[HealthRow], k: usize) -> Vec<(f64, f64)> {
    let part = rows.len().div_ceil(POINTS).max(1);
    let point = |rows: &[HealthRow]| {
        let values: Vec<f64> = rows.iter().filter_map(|row| row.1[k]).collect();
        (!values.is_empty()).then(|| (rows[rows.len() - 1].0, stats::mean(&values)))
    };
    rows.chunks(part).filter_map(point).collect()
}

/// The numbers of the last tenth, and what is to be said of each.
pub fn table(judged: &[JudgedNumber]) -> Markup {
    let bounds = |Bound { low, high, .. }: &Bound| format!("{low} to {high}");
    let wrong = judged.iter().filter(|judged| judged.complaint().is_some()).count();
    html! {
        h2 { "Health of the training" }
        p {
            @match wrong {
                0 => "Over its last tenth all of these numbers were where they should be.",
                _ => "Over its last tenth something was not as it should be:",
            }
        }
        table {
            tr { th { "number" } th { "found" } th { "healthy" } th { "in words" } }
            @for judged in judged {
                tr {
                    td { (judged.bound.name) }
                    td { (judged.found.map_or("not in the log".into(), |x| format!("{x:.4}"))) }
                    td { (bounds(&judged.bound)) }
                    td { (judged.complaint().unwrap_or(if judged.found.is_some() { "healthy" } else { "-" })) }
                }
            }
        }
    }
}
