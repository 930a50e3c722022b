//! Results as files: CSV tables and one JSON document.

use super::metric::Metric;
use super::results::{Results, RunGroup};
use super::summary::SeedSummary;
use crate::base::encode;
use crate::base::error::{Error, Result};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Name of the JSON document in a study's folder.
pub const RESULTS: &str = "results.json";

/// Names and contents of all tables.
pub fn files(results: &Results) -> Result<Vec<(&'static str, Vec<u8>)>> {
    Ok(vec![
        ("runs.csv", runs(results, &results.shown().collect::<Vec<_>>())?),
        ("timing.csv", runs(results, &results.metrics.iter().filter(|metric| metric.clock).collect::<Vec<_>>())?),
        ("settings.csv", groups(results, &[("setting".into(), results.settings.clone())])?),
        ("axes.csv", groups(results, &results.axes)?),
        ("ranking.csv", ranking(results)?),
        (RESULTS, json(results)?.into_bytes()),
    ])
}

/// A line each finished run.
fn runs(results: &Results, metrics: &[&Metric]) -> Result<Vec<u8>> {
    let plan = &results.plan;
    encode::csv("the table of runs", |csv| {
        let header = ["run", "setting"].into_iter().chain(plan.axes.iter().map(String::as_str)).chain(["seed"]);
        csv.write_record(header.chain(metrics.iter().map(|metric| metric.name.as_str())))?;
        for (planned, run) in plan.runs.iter().zip(&results.runs) {
            let Some(run) = run else { continue };
            let setting = &plan.settings[planned.setting];
            let mut row = vec![run.run.clone(), run.setting.clone()];
            row.extend(setting.levels.iter().cloned());
            row.push(run.seed.to_string());
            row.extend(metrics.iter().map(|metric| cell(metric.of(run))));
            csv.write_record(row)?;
        }
        Ok(())
    })
}

/// A line each group and metric.
fn groups(results: &Results, axes: &[(String, Vec<RunGroup>)]) -> Result<Vec<u8>> {
    encode::csv("the table of settings", |csv| {
        csv.write_record(["axis", "value", "metric", "n", "mean", "sd", "min", "max", "low_95", "high_95"])?;
        for (axis, groups) in axes {
            for group in groups {
                for metric in results.shown() {
                    let Some(SeedSummary { n, mean, sd, min, max, interval }) = group.metrics.get(&metric.name) else {
                        continue;
                    };
                    let [low, high] = interval.map_or([None; 2], |ends| ends.map(Some));
                    let numbers = [Some(*mean), *sd, Some(*min), Some(*max), low, high].map(cell);
                    let names = [axis.clone(), group.name.clone(), metric.name.clone(), n.to_string()];
                    csv.write_record(names.into_iter().chain(numbers))?;
                }
            }
        }
        Ok(())
    })
}

fn ranking(results: &Results) -> Result<Vec<u8>> {
    encode::csv("the ranking", |csv| {
        csv.write_record(["rank", "setting", "runs", "score", "probability_best", "rank_low_95", "rank_high_95"])?;
        for place in &results.ranking {
            let [low, high] = place.ranks.map_or([None; 2], |ends| ends.map(Some));
            let names = [place.rank.to_string(), place.setting.clone(), place.runs.to_string()];
            csv.write_record(names.into_iter().chain([Some(place.score), place.best, low, high].map(cell)))?;
        }
        Ok(())
    })
}

fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

/// A finished run in the JSON document.
#[derive(Serialize)]
struct RunLine<'a> {
    run: &'a str,
    setting: &'a str,
    seed: u64,
    metrics: BTreeMap<&'a str, Option<f64>>,
}

/// All tables and how they were made.
pub fn json(results: &Results) -> Result<String> {
    let shown: Vec<&Metric> = results.shown().collect();
    let of = |metrics: &BTreeMap<String, SeedSummary>| {
        let metrics = metrics.iter().filter(|(name, _)| shown.iter().any(|metric| metric.name == **name));
        metrics.map(|(name, summary)| (name.clone(), *summary)).collect::<BTreeMap<_, _>>()
    };
    let group = |group: &RunGroup| RunGroup { metrics: of(&group.metrics), ..group.clone() };
    let runs = results.runs.iter().flatten().map(|run| RunLine {
        run: &run.run,
        setting: &run.setting,
        seed: run.seed,
        metrics: shown.iter().map(|metric| (metric.name.as_str(), metric.of(run))).collect(),
    });
    let axes = results.axes.iter().map(|(axis, groups)| {
        let levels: Vec<RunGroup> = groups.iter().map(group).collect();
        serde_json::to_value(levels).map(|levels| (axis.clone(), levels)).map_err(Error::encode("the axes"))
    });
    let methods: BTreeMap<_, _> = results.methods().into_iter().collect();
    let document = json!({
        "study": results.plan.study,
        "planned": results.runs.len(),
        "finished": results.finished(),
        "diverged": results.diverged,
        "plan": results.plan,
        "methods": methods,
        "ranking": results.ranking,
        "settings": results.settings.iter().map(group).collect::<Vec<_>>(),
        "axes": axes.collect::<Result<Map<String, Value>>>()?,
        "runs": runs.collect::<Vec<_>>(),
    });
    encode::json("the results", &document)
}
