//! Evaluation reports as text.

use crate::race::eval::Report;
use crate::race::eval::choose::DEPLOYABLE;
use crate::race::eval::pace::Pace;
use crate::race::eval::score::{Benchmark, LapTime};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Gates named among the failures of one start distribution.
const FAILURES: usize = 5;

/// The benchmarks side by side, a line each metric.
pub fn report(report: &Report) -> String {
    let columns: Vec<(&str, &Benchmark)> = [("fixed start", &report.fixed), ("random start", &report.random)]
        .into_iter()
        .filter_map(|(name, benchmark)| Some((name, benchmark.as_ref()?)))
        .collect();
    let mut text = String::new();
    let mut line = |name: &str, cell: &dyn Fn(&Benchmark) -> String| {
        let cells: String = columns.iter().map(|(_, benchmark)| format!("{:>16}", cell(benchmark))).collect();
        let _ = writeln!(text, "{name:<28}{cells}");
    };
    let lap_time =
        |benchmark: &Benchmark, show: &dyn Fn(LapTime) -> String| benchmark.lap_time_s.map_or("-".into(), show);
    line("agents", &|b| b.agents.to_string());
    line("lap completion", &|b| percent(b.lap_completion));
    line("lap time, median", &|b| lap_time(b, &|time| format!("{:.2} s", time.median)));
    line("  5 to 95 %", &|b| lap_time(b, &|time| format!("{:.2} - {:.2} s", time.p05, time.p95)));
    line("  best", &|b| lap_time(b, &|time| format!("{:.2} s", time.best)));
    line("gates passed, median", &|b| format!("{:.1}", b.gates_passed.median));
    line("  mean", &|b| format!("{:.1}", b.gates_passed.mean));
    line("top speed", &|b| format!("{:.1} m/s", b.top_speed_m_s));
    line("commands with |a| > 0.95", &|b| percent(b.saturated_share));
    line("mean |a_t - a_(t-1)|^2", &|b| format!("{:.4}", b.mean_action_change_sq));
    let sections: BTreeSet<&String> = columns.iter().flat_map(|(_, benchmark)| benchmark.sections.keys()).collect();
    for section in sections {
        line(&format!("passed the {section}"), &|b| {
            b.sections.get(section).map_or("-".into(), |&share| percent(share))
        });
    }
    let header: String = columns.iter().map(|(name, _)| format!("{name:>16}")).collect();
    let failures: String = columns.iter().map(|(name, benchmark)| failures(name, benchmark)).collect();
    let criterion = report.fixed.as_ref().map(|fixed| {
        let met = if fixed.lap_completion >= DEPLOYABLE { "met" } else { "not met" };
        format!("\ncriterion for deployment, {} of fixed starts: {met}", percent(DEPLOYABLE))
    });
    format!("{:<28}{header}\n{text}{}{}", "", failures, criterion.unwrap_or_default())
}

/// The median laps over the reference lap, in the columns of [`report`].
pub fn pace(pace: Option<&Pace>) -> String {
    let Some(pace) = pace else { return String::new() };
    let ratios: Vec<_> = [("fixed", pace.fixed), ("random", pace.random)]
        .into_iter()
        .filter_map(|(name, ratio)| Some(format!("{:.3} from {name} starts", ratio?)))
        .collect();
    let ratios = if ratios.is_empty() { "no lap completed".into() } else { ratios.join(", ") };
    format!(
        "\nmedian lap over the reference lap: {ratios}\n  reference lap {:.2} s at {:.1} V: {}",
        pace.reference_s, pace.voltage_v, pace.method
    )
}

/// The gates at which most flights ended, and why.
fn failures(name: &str, benchmark: &Benchmark) -> String {
    let mut gates: Vec<_> = benchmark.failures_by_gate.iter().collect();
    gates.sort_by_key(|(_, causes)| std::cmp::Reverse(causes.values().sum::<usize>()));
    let mut text = String::new();
    for (gate, causes) in gates.iter().take(FAILURES) {
        let causes: Vec<_> =
            causes.iter().map(|(cause, count)| format!("{count} {}", cause.replace('_', " "))).collect();
        let _ = writeln!(text, "  gate {gate}: {}", causes.join(", "));
    }
    if gates.len() > FAILURES {
        let _ = writeln!(text, "  and {} more gates", gates.len() - FAILURES);
    }
    if text.is_empty() { text } else { format!("failures, {name}\n{text}") }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
