//! The tables on a study's page.

use crate::present::report::page::number;
use crate::present::study::metric::Metric;
use crate::present::study::results::{Results, RunGroup};
use crate::present::study::summary::SeedSummary;
use maud::{Markup, html};

/// Heading, metric, factor and digits of what stands beside a setting.
const COLUMNS: [(&str, &str, f64, usize); 7] = [
    ("random start, %", "random_completion", 100.0, 1),
    ("median lap, s", "lap_time_median_s", 1.0, 2),
    ("top speed, m/s", "top_speed_m_s", 1.0, 1),
    ("|Δa|²", "action_change_sq", 1.0, 4),
    ("|a| > 0.95, %", "saturated_share", 100.0, 1),
    ("steps, M", "trained_steps", 1e-6, 1),
    ("M steps/s", "steps_per_s", 1e-6, 2),
];

/// The settings in order.
pub fn ranking(results: &Results) -> Markup {
    html! {
        h2 { "Ranking" }
        div class="wide" { table {
            tr {
                th { "setting" } th { "runs" } th { "laps, % (95 %)" } th { "ready" } th { "best, %" }
                th { "ranks, 95 %" }
                @for (heading, ..) in COLUMNS { th { (heading) } }
            }
            @for place in &results.ranking {
                @if let Some(group) = results.settings.iter().find(|group| group.name == place.setting) {
                    tr {
                        td { (place.rank) ". " (place.setting) }
                        (laps(group))
                        td { (number(place.best.map(|best| 100.0 * best), 0)) }
                        td { (place.ranks.map_or("-".into(), |[low, high]| format!("{low} to {high}"))) }
                        (means(group))
                    }
                }
            }
        } }
    }
}

/// Each axis: the means over all else.
pub fn axes(results: &Results) -> Markup {
    html! {
        @if !results.axes.is_empty() {
            h2 { "Axes" }
            p { "Each value's mean over all settings and seeds that have it." }
            @for (axis, levels) in &results.axes {
                div class="wide" { table {
                    tr {
                        th { (axis) } th { "runs" } th { "laps, % (95 %)" } th { "ready" }
                        @for (heading, ..) in COLUMNS { th { (heading) } }
                    }
                    @for group in levels { tr { td { (group.name) } (laps(group)) (means(group)) } }
                } }
            }
        }
    }
}

fn laps(group: &RunGroup) -> Markup {
    let completion = group.metrics.get("fixed_completion");
    let interval = completion.and_then(|summary| summary.interval);
    let ready = group.metrics.get("ready").map(|s| format!("{:.0} of {}", s.mean * s.n as f64, s.n));
    let mean = number(completion.map(|summary| 100.0 * summary.mean), 1);
    let around = interval.map(|[low, high]| format!(" ({:.1} to {:.1})", 100.0 * low, 100.0 * high));
    html! {
        td { (group.finished) }
        td { (mean) (around.unwrap_or_default()) }
        td { (ready.unwrap_or("-".into())) }
    }
}

fn means(group: &RunGroup) -> Markup {
    let mean = |name: &str, factor: f64| group.metrics.get(name).map(|summary| factor * summary.mean);
    html! { @for (_, name, factor, digits) in COLUMNS { td { (number(mean(name, factor), digits)) } } }
}

/// Every metric of every setting.
pub fn settings(results: &Results) -> Markup {
    html! {
        h2 { "Settings" }
        @for group in results.settings.iter().filter(|group| group.finished > 0) {
            details {
                summary { (group.name) ", " (group.finished) " of " (group.planned) " runs" }
                table {
                    tr { th { "" } th { "n" } th { "mean" } th { "95 %" } th { "sd" } th { "min" } th { "max" } }
                    @for metric in &results.metrics {
                        @if let Some(summary) = group.metrics.get(&metric.name) { (line(metric, summary)) }
                    }
                }
            }
        }
    }
}

fn line(metric: &Metric, s: &SeedSummary) -> Markup {
    html! {
        tr {
            td { (metric.name) } td { (s.n) } td { (short(s.mean)) }
            td { (s.interval.map_or("-".into(), |[low, high]| format!("{} to {}", short(low), short(high)))) }
            td { (s.sd.map_or("-".into(), short)) } td { (short(s.min)) } td { (short(s.max)) }
        }
    }
}

/// Every metric of every run.
pub fn runs(results: &Results) -> Markup {
    html! {
        h2 { "Runs" }
        details {
            summary { "All " (results.finished()) " finished runs" }
            div class="wide" { table {
                tr { th { "run" } @for metric in &results.metrics { th { (metric.name) } } }
                @for run in results.runs.iter().flatten() {
                    tr {
                        td { (run.run) }
                        @for metric in &results.metrics { td { (metric.of(run).map_or("-".into(), short)) } }
                    }
                }
            } }
        }
    }
}

/// Four digits, or all of those before the point.
fn short(x: f64) -> String {
    match x.abs() {
        size if size >= 1000.0 || x == x.round() => format!("{x:.0}"),
        size if size >= 1.0 => format!("{x:.2}"),
        _ => format!("{x:.4}"),
    }
}
