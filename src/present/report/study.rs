//! A study as figures and as one page that needs nothing else.

mod bands;
mod effects;
mod learning;
mod marks;
mod ranked;
mod tables;

use super::page;
use crate::base::error::Result;
use crate::present::study::curves::Curves;
use crate::present::study::results::Results;
use maud::{PreEscaped, html};

/// Settings that figures of curves tell apart; more would need more colours than are told apart.
const SHOWN: usize = 6;

/// A figure and what it shows.
pub struct StudyFigure {
    /// File name without ending.
    pub name: &'static str,
    pub caption: String,
    pub svg: String,
}

/// All figures of a study with a finished run.
pub fn figures(results: &Results, curves: &Curves) -> Result<Vec<StudyFigure>> {
    let mut figures = vec![ranked::figure(results)?];
    figures.extend(effects::figure(results)?);
    figures.push(learning::figure(results, curves)?);
    figures.push(bands::completion(results, curves)?);
    figures.push(bands::learning(results, curves)?);
    Ok(figures)
}

/// The best settings: places in the plan.
fn best(results: &Results) -> Vec<usize> {
    let place = |name: &str| results.plan.settings.iter().position(|setting| setting.name == name);
    results.ranking.iter().take(SHOWN).filter_map(|ranked| place(&ranked.setting)).collect()
}

/// The page as HTML.
pub fn page(results: &Results, figures: &[StudyFigure]) -> String {
    const STYLE: &str = "figure{margin:1.5em 0}figcaption{color:#555}code{font-size:.9em}td.text{text-align:left}
.wide{overflow-x:auto}.wide table{font-size:.8em}.wide td{white-space:nowrap}
.wide td,.wide th{padding:.2em .5em}dt{font-weight:bold}dd{margin:0 0 .5em 1.5em;color:#333}";
    let plan = &results.plan;
    let counts = format!(
        "{} of {} runs of {} each, {} settings; made by racer {}.",
        results.finished(),
        results.runs.len(),
        plan.budget(),
        plan.settings.len(),
        env!("CARGO_PKG_VERSION")
    );
    let body = html! {
        h1 { "Study " (plan.study) }
        p { (counts) }
        @if let Some(told) = results.told_diverged() { p { (told) } }
        (tables::ranking(results))
        @for figure in figures {
            figure id=(figure.name) { (PreEscaped(&figure.svg)) figcaption { (figure.caption) } }
        }
        (tables::axes(results))
        (tables::settings(results))
        (tables::runs(results))
        h2 { "How the numbers were made" }
        dl { @for (name, text) in results.methods() { dt { (name) } dd { (text) } } }
    };
    page::page(&format!("Study {}", plan.study), STYLE, body)
}
