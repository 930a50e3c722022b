//! Learning curves of a study's runs, smoothed, and their bands over seeds: what its figures draw.

use super::folder::Folder;
use super::results::Results;
use crate::run::{evaluated, metrics};
use crate::stats;

/// Points of a curve and of a band.
const POINTS: usize = 120;

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

/// Median and quartiles over the runs of a setting.
#[derive(Clone, Debug)]
pub struct Band {
    pub setting: usize,
    pub runs: usize,
    /// x, and lower quartile, median and upper quartile there.
    pub points: Vec<(f64, [f64; 3])>,
    /// Where the median run first passes each section, and the median there; none where fewer than half of the runs do.
    pub sections: Vec<Option<(f64, f64)>>,
}

/// Reads the curves of everything that is finished. Returns can be compared only where all runs are paid alike; gates passed
/// in an episode always can.
pub fn read(folder: &Folder, results: &Results) -> anyhow::Result<Curves> {
    let (what, column) = match results.plan.same_reward {
        true => ("median episode reward", "episode/return_median"),
        false => ("gates an episode, training", "episode/gates"),
    };
    let mut runs = Vec::new();
    for (run, (planned, result)) in results.plan.runs.iter().zip(&results.runs).enumerate() {
        let Some(result) = result else { continue };
        let path = folder.run(&planned.name);
        let rows = metrics::read(&path.join("metrics.csv"), ["steps", "time/seconds", column])?;
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
fn interpolated(curve: &[At], over: Over, x: f64) -> f64 {
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

/// The band of a setting over what all its runs have; `of` says which of a run's curves. `None` without a finished run.
pub fn band(curves: &Curves, setting: usize, over: Over, of: fn(&Curve) -> &[At]) -> Option<Band> {
    let runs: Vec<&Curve> = curves.runs.iter().filter(|c| c.setting == setting && !of(c).is_empty()).collect();
    let ends = |end: fn(&[At]) -> Option<&At>| runs.iter().filter_map(move |run| end(of(run)).map(|at| over.x(at)));
    let (first, last) = (ends(|c| c.first()).reduce(f64::max)?, ends(|c| c.last()).reduce(f64::min)?);
    let quartiles = |x: f64| {
        let values: Vec<f64> = runs.iter().map(|run| interpolated(of(run), over, x)).collect();
        [0.25, 0.5, 0.75].map(|q| stats::quantile(&values, q))
    };
    let x = |i: usize| first + (last - first) * i as f64 / (POINTS - 1) as f64;
    let points = (0..POINTS).map(|i| (x(i), quartiles(x(i)))).collect();
    let section = |i: usize| {
        // Runs that never pass it do so later than all others.
        let never = f64::INFINITY;
        let passed: Vec<f64> = runs.iter().map(|run| run.sections[i].map_or(never, |at| over.x(&at))).collect();
        let x = stats::median(&passed);
        (x.is_finite() && x <= last).then(|| (x, quartiles(x)[1]))
    };
    let sections = runs.first().map_or(0, |run| run.sections.len());
    Some(Band { setting, runs: runs.len(), points, sections: (0..sections).map(section).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(values: &[(f64, f64)]) -> Curve {
        let learning: Vec<At> = values.iter().map(|&(x, value)| at(60.0 * x, 1e6 * x, value)).collect();
        let best = learning[0];
        Curve { run: 0, setting: 0, completion: Vec::new(), best, best_completion: 0.0, sections: vec![Some(best)], learning }
    }

    #[test]
    fn bands_are_quartiles_where_all_runs_are() {
        let runs = vec![curve(&[(0.0, 0.0), (2.0, 2.0)]), curve(&[(0.0, 4.0), (4.0, 4.0)]), curve(&[(0.0, 9.0), (3.0, 9.0)])];
        let curves = Curves { what: "", runs };
        let band = band(&curves, 0, Over::Minutes, |c| &c.learning).unwrap();
        let (x, [low, median, high]) = *band.points.last().unwrap();
        assert!((x - 2.0).abs() < 1e-9 && (low - 3.0).abs() < 1e-9 && (median - 4.0).abs() < 1e-9 && (high - 6.5).abs() < 1e-9);
        assert_eq!(band.sections, [Some((0.0, 4.0))]);
        assert!(super::band(&curves, 1, Over::Minutes, |c| &c.learning).is_none());
    }

    #[test]
    fn parts_without_an_episode_are_left_out() {
        let rows = [[Some(1e6), Some(60.0), None], [Some(2e6), Some(120.0), Some(5.0)]];
        assert_eq!(smoothed(&rows), [at(120.0, 2e6, 5.0)]);
    }
}
