//! A study's results: runs, settings, axes, ranking. Made from the plan and from whatever is finished.

use super::metric::{Metric, metrics};
use super::plan::StudyPlan;
use super::ranking::{self, NO_LAP_S, Ranked, Scored, ranking};
use super::result::RunResult;
use super::summary::SeedSummary;
use crate::race::eval::choose::DEPLOYABLE;
use serde::Serialize;
use std::collections::BTreeMap;

/// Everything that is printed, written and drawn.
pub struct Results {
    pub plan: StudyPlan,
    pub metrics: Vec<Metric>,
    /// In the plan's order; none where a run is not finished.
    pub runs: Vec<Option<RunResult>>,
    /// Names of the runs that diverged; they count nowhere.
    pub diverged: Vec<String>,
    /// The finished runs of each setting, summarised; in the plan's order.
    pub settings: Vec<RunGroup>,
    /// The same for each value of each axis that varies; none of a study with a single axis, where settings say it.
    pub axes: Vec<(String, Vec<RunGroup>)>,
    pub ranking: Vec<Ranked>,
}

/// Runs that have something in common.
#[derive(Clone, Debug, Serialize)]
pub struct RunGroup {
    pub name: String,
    pub planned: usize,
    pub finished: usize,
    /// By metric, without those that no run has.
    pub metrics: BTreeMap<String, SeedSummary>,
}

impl Results {
    pub fn new(plan: StudyPlan, runs: Vec<Option<RunResult>>, diverged: Vec<String>) -> Self {
        let metrics = metrics(&plan.sections);
        let group = |name: &str, belongs: &dyn Fn(usize) -> bool| {
            let places = plan.runs.iter().enumerate().filter(|(_, run)| belongs(run.setting)).map(|(i, _)| i);
            let places: Vec<usize> = places.collect();
            let finished: Vec<&RunResult> = places.iter().filter_map(|&i| runs[i].as_ref()).collect();
            let of = |metric: &Metric| Some((metric.name.clone(), SeedSummary::of(metric, &finished)?));
            RunGroup {
                name: name.into(),
                planned: places.len(),
                finished: finished.len(),
                metrics: metrics.iter().filter_map(of).collect(),
            }
        };
        let settings: Vec<RunGroup> =
            plan.settings.iter().enumerate().map(|(i, setting)| group(&setting.name, &|of| of == i)).collect();
        let mut axes = Vec::new();
        for (a, axis) in plan.axes.iter().enumerate() {
            let mut levels: Vec<&String> = Vec::new();
            for setting in &plan.settings {
                if !levels.contains(&&setting.levels[a]) {
                    levels.push(&setting.levels[a]);
                }
            }
            if levels.len() > 1 {
                let of = |level: &&String| group(level, &|setting| plan.settings[setting].levels[a] == **level);
                axes.push((axis.clone(), levels.iter().map(of).collect()));
            }
        }
        if axes.len() < 2 {
            axes.clear();
        }
        let scored = plan.settings.iter().enumerate().map(|(i, setting)| {
            let finished =
                || plan.runs.iter().zip(&runs).filter(|(run, _)| run.setting == i).filter_map(|(_, r)| r.as_ref());
            let lap_s = |run: &RunResult| run.fixed.lap_time_s.map_or(NO_LAP_S, |time| time.median);
            let score = |run: &RunResult| [run.fixed.lap_completion, -lap_s(run), run.fixed.gates_passed.mean];
            Scored { name: setting.name.clone(), scores: finished().map(score).collect() }
        });
        let ranking = ranking(scored.collect());
        Self { plan, metrics, runs, diverged, settings, axes, ranking }
    }

    /// Whether times belong to the result: they do under a budget of time, and under one of steps they would differ
    /// from one making of the same result to the next.
    pub fn timed(&self) -> bool {
        self.plan.minutes.is_some()
    }

    /// Metrics of the tables that are to repeat.
    pub fn shown(&self) -> impl Iterator<Item = &Metric> {
        self.metrics.iter().filter(|metric| self.timed() || !metric.clock)
    }

    /// Runs that are finished.
    pub fn finished(&self) -> usize {
        self.runs.iter().flatten().count()
    }

    /// What is to be said of runs that diverged; nothing where none did.
    pub fn told_diverged(&self) -> Option<String> {
        let names = self.diverged.join(", ");
        (!names.is_empty()).then(|| format!("diverged, and neither ranked nor part of any mean: {names}"))
    }

    /// How the numbers were made, in words.
    pub fn methods(&self) -> Vec<(&'static str, String)> {
        let share = 100.0 * self.plan.section_share;
        vec![
            (
                "best snapshot",
                "The one with the highest fixed-start lap completion among those trained under whole penalties; of \
                equals the one with the shortest median lap, then with most gates passed, then the latest. All metrics \
                of a run are its best snapshot's."
                    .into(),
            ),
            (
                "ready",
                format!(
                    "The first snapshot with which {:.0} % of the fixed-start agents complete a lap.",
                    100.0 * DEPLOYABLE
                ),
            ),
            (
                "sections",
                format!("The first snapshot with which {share:.0} % of the random-start agents pass the section."),
            ),
            (
                "action_change_sq, saturated_share",
                "Mean |a_t - a_(t-1)|^2 and share of |a| > 0.95 over the first four seconds \
                from the pad, all agents while they fly."
                    .into(),
            ),
            (
                "intervals",
                "95 % of the mean over the seeds, by Student's t, shares kept within 0 to 1; n is the number of runs \
                that have the metric."
                    .into(),
            ),
            ("ranking", ranking::METHOD.into()),
        ]
    }
}
