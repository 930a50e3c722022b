//! A study's results as text: the ranking with what matters beside it, then each axis.

use crate::cli::columns;
use crate::present::study::results::{Results, RunGroup};
use crate::present::study::summary::SeedSummary;

/// All tables.
pub fn results(results: &Results) -> String {
    let plan = &results.plan;
    let (finished, all) = (results.finished(), results.runs.len());
    let mut text = format!("{}: {finished} of {all} runs of {} each\n\n{}", plan.study, plan.budget(), ranked(results));
    for (axis, levels) in &results.axes {
        text += &format!("\n\n{}", groups(axis, levels));
    }
    if let Some(told) = results.told_diverged() {
        text += &format!("\n\n{told}");
    }
    let best = results.ranking.iter().any(|place| place.best.is_some());
    text += "\n\nlaps: share of fixed-start agents that complete a lap with a run's best snapshot, mean over \
             seeds (95 %, Student's t).";
    if best {
        text +=
            "\nbest, ranks: share of 10000 draws of the seeds in which a setting is best; 95 % of its ranks in them.";
    }
    text
}

const METRICS: [&str; 6] = ["seeds", "laps, %", "min - max", "ready", "median lap, s", "|da|^2"];

/// The cells of [`METRICS`] and the share of saturated commands.
fn cells(group: &RunGroup) -> Vec<String> {
    let of = |name: &str| group.metrics.get(name);
    let mean = |name: &str, digits: usize| of(name).map_or("-".into(), |s| format!("{:.digits$}", s.mean));
    let laps = |show: &dyn Fn(&SeedSummary) -> String| of("fixed_completion").map_or("-".into(), show);
    let seeds = if group.finished == group.planned {
        group.finished.to_string()
    } else {
        format!("{} of {}", group.finished, group.planned)
    };
    let percent = |share: f64| format!("{:.1}", 100.0 * share);
    vec![
        seeds,
        laps(&|s| match s.interval {
            Some([low, high]) => format!("{} ({} to {})", percent(s.mean), percent(low), percent(high)),
            None => percent(s.mean),
        }),
        laps(&|s| format!("{} - {}", percent(s.min), percent(s.max))),
        of("ready").map_or("-".into(), |s| format!("{:.0} of {}", s.mean * s.n as f64, s.n)),
        mean("lap_time_median_s", 2),
        mean("action_change_sq", 4),
        of("saturated_share").map_or("-".into(), |s| format!("{} %", percent(s.mean))),
    ]
}

fn ranked(results: &Results) -> String {
    let header = [&["", "setting"], &METRICS[..], &["|a|>.95", "best, %", "ranks"]].concat();
    let rows = results.ranking.iter().filter_map(|place| {
        let group = results.settings.iter().find(|group| group.name == place.setting)?;
        let mut row = vec![place.rank.to_string(), place.setting.clone()];
        row.extend(cells(group));
        row.push(place.best.map_or("-".into(), |best| format!("{:.0}", 100.0 * best)));
        row.push(place.ranks.map_or("-".into(), |[low, high]| format!("{low} - {high}")));
        Some(row)
    });
    columns::table(&header, rows.collect(), 2..header.len())
}

fn groups(axis: &str, levels: &[RunGroup]) -> String {
    let header = [&[axis, "runs"], &METRICS[1..], &["|a|>.95"]].concat();
    let row = |group: &RunGroup| [vec![group.name.clone()], cells(group)].concat();
    columns::table(&header, levels.iter().map(row).collect(), 1..header.len())
}
