//! A run as one page that needs nothing else.

use super::page;
pub use super::study::StudyFigure;
use crate::race::eval::Report;
use crate::race::eval::score::Benchmark;
use crate::race::snapshot::About;
use maud::{Markup, PreEscaped, html};

/// The page as HTML: what was trained, how it does (and another run beside it), how healthy the training was, and the
/// figures.
pub fn page(title: &str, about: &About, flown: &[(&str, &Report)], health: &Markup, figures: &[StudyFigure]) -> String {
    const STYLE: &str = "figure{margin:1.5em 0}figcaption{color:#555}";
    let percent = |x: f64| format!("{:.1} %", 100.0 * x);
    let lap =
        |b: &Benchmark| b.lap_time_s.map_or("-".into(), |t| format!("{:.2} ({:.2} to {:.2})", t.median, t.p05, t.p95));
    type RunCell<'a> = (&'a str, &'a dyn Fn(&Benchmark) -> String);
    let rows: [RunCell; 6] = [
        ("lap completion", &|b| percent(b.lap_completion)),
        ("lap time, s: median (5 to 95 %)", &lap),
        ("gates passed, mean", &|b| format!("{:.1}", b.gates_passed.mean)),
        ("top speed, m/s", &|b| format!("{:.1}", b.top_speed_m_s)),
        ("commands with |a| > 0.95", &|b| percent(b.saturated_share)),
        ("mean |a_t - a_(t-1)|\u{b2}", &|b| format!("{:.4}", b.mean_action_change_sq)),
    ];
    let columns: Vec<(String, &Benchmark)> = flown
        .iter()
        .flat_map(|(name, report)| {
            let starts = [("fixed start", &report.fixed), ("random start", &report.random)];
            starts.into_iter().filter_map(move |(start, b)| Some((format!("{name}, {start}"), b.as_ref()?)))
        })
        .collect();
    let body = html! {
        h1 { (title) }
        p {
            "Track " (about.track.name) ", vehicle " (about.vehicle.name) ", seed " (about.seed) ", "
            (format!("{:.1}", about.steps as f64 / 1e6)) " M steps; " (about.eval.agents) " agents from either start."
        }
        table {
            tr { th {} @for (name, _) in &columns { th { (name) } } }
            @for (name, cell) in &rows { tr { td { (name) } @for (_, b) in &columns { td { (cell(b)) } } } }
        }
        (health)
        @for figure in figures {
            figure id=(figure.name) { (PreEscaped(&figure.svg)) figcaption { (figure.caption) } }
        }
    };
    page::page(title, STYLE, body)
}
