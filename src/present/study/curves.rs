//! Learning curves of a study's runs, smoothed: what its figures draw.

use super::folder::Folder;
use super::results::Results;
use crate::base::error::Result;
use crate::base::stats;
use crate::present::run::{evaluated, metrics};

/// Most points of a curve, and those of a band.
pub const POINTS: usize = 120;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    pub minutes: f64,
    pub million_steps: f64,
    pub value: f64,
}

/// What a curve is drawn over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    Minutes,
    Steps,
}

impl Over {
    pub fn x(self, at: &At) -> f64 {
        match self {
            Over::Minutes => at.minutes,
            Over::Steps => at.million_steps,
        }
    }
}

/// One finished run.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Places in the plan.
    pub run: usize,
    pub setting: usize,
    /// What was gathered while training, smoothed.
    pub learning: Vec<At>,
    /// Fixed-start lap completion of the snapshots, %.
    pub completion: Vec<At>,
    /// The best snapshot, on the learning curve, and its completion, %.
    pub best: At,
    pub best_completion: f64,
    /// The first snapshot that passes each of the plan's sections, on the learning curve.
    pub sections: Vec<Option<At>>,
}

/// All finished runs.
#[derive(Clone, Debug)]
pub struct Curves {
    /// What the learning curves show.
    pub what: &'static str,
    pub runs: Vec<Curve>,
}

/// Reads the curves of everything that is finished. Returns can be compared only where all runs are paid alike; gates
/// passed in an episode always can.
pub fn read(folder: &Folder, results: &Results) -> Result<Curves> {
    let (what, column) = match results.plan.same_reward {
        true => ("median episode reward", "episode/return_median"),
        false => ("gates an episode, training", "episode/gates"),
    };
    let mut runs = Vec::new();
    for (run, (planned, result)) in results.plan.runs.iter().zip(&results.runs).enumerate() {
        let Some(result) = result else { continue };
        let path = folder.run(&planned.name);
        let rows = metrics::read(&path.join(metrics::METRICS), ["steps", "time/seconds", column])?;
        let learning = smoothed(&rows);
        let on = |seconds: f64, steps: u64| {
            let at = at(seconds, steps as f64, 0.0);
            At { value: interpolated(&learning, Over::Steps, at.million_steps), ..at }
        };
        let completion = evaluated::read(&path)?.into_iter();
        let completion = completion.map(|e| at(e.seconds, e.steps as f64, 100.0 * e.report.completion()));
        let first = |section: &String| {
            let passed = result.sections.iter().find(|passed| passed.section == *section)?;
            passed.first.map(|first| on(first.seconds, first.steps))
        };
        runs.push(Curve {
            run,
            setting: planned.setting,
            completion: std::iter::once(at(0.0, 0.0, 0.0)).chain(completion).collect(),
            best: on(result.best.seconds, result.best.steps),
            best_completion: 100.0 * result.fixed.lap_completion,
            sections: results.plan.sections.iter().map(first).collect(),
            learning,
        });
    }
    Ok(Curves { what, runs })
}

fn at(seconds: f64, steps: f64, value: f64) -> At {
    At { minutes: seconds / 60.0, million_steps: steps / 1e6, value }
}

/// Means over equal parts of the training; parts in which no episode ended are left out.
fn smoothed(rows: &[[Option<f64>; 3]]) -> Vec<At> {
    let part = rows.len().div_ceil(POINTS).max(1);
    let mean = |rows: &[[Option<f64>; 3]], i: usize| {
        let values: Vec<f64> = rows.iter().filter_map(|row| row[i]).collect();
        (!values.is_empty()).then(|| stats::mean(&values))
    };
    let point = |rows: &[[Option<f64>; 3]]| Some(at(mean(rows, 1)?, mean(rows, 0)?, mean(rows, 2)?));
    rows.chunks(part).filter_map(point).collect()
}

/// The value at `x`, between the points around it; the nearest beyond the ends, not a number of nothing.
pub fn interpolated(curve: &[At], over: Over, x: f64) -> f64 {
    let after = curve.iter().position(|at| over.x(at) >= x);
    match (after, curve.last()) {
        (Some(0), _) => curve[0].value,
        (Some(i), _) => {
            let (a, b) = (&curve[i - 1], &curve[i]);
            a.value + (b.value - a.value) * (x - over.x(a)) / (over.x(b) - over.x(a)).max(1e-12)
        }
        (None, Some(last)) => last.value,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_without_an_episode_are_left_out() {
        let rows = [[Some(1e6), Some(60.0), None], [Some(2e6), Some(120.0), Some(5.0)]];
        assert_eq!(smoothed(&rows), [at(120.0, 2e6, 5.0)]);
    }
}
