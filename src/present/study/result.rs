//! What a finished run reached: `result.json` in its folder.

use crate::base::check::BadInput;
use crate::present::run::evaluated::{self, Evaluated};
use crate::race::eval::choose::DEPLOYABLE;
use crate::race::eval::score::Benchmark;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the file.
pub const RESULT: &str = "result.json";

/// A snapshot's place in the training.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainedFor {
    /// Environment steps, and training time in seconds.
    pub steps: u64,
    pub seconds: f64,
}

/// A section, and the first snapshot that could fly it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Passed {
    pub section: String,
    /// None where no snapshot could.
    pub first: Option<TrainedFor>,
}

/// The run's numbers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunResult {
    pub run: String,
    pub setting: String,
    pub seed: u64,
    /// Threads it was trained on; changes the speed only.
    pub threads: usize,
    pub snapshots: usize,
    /// The whole training.
    pub trained: TrainedFor,
    /// The best snapshot: highest fixed-start lap completion, of equals the fastest.
    pub best: TrainedFor,
    pub fixed: Benchmark,
    pub random: Benchmark,
    /// The first snapshot ready for deployment: 95 % of fixed-start agents complete a lap.
    pub ready: Option<TrainedFor>,
    pub sections: Vec<Passed>,
}

/// Which run it is.
pub struct RunLabel<'a> {
    pub run: &'a str,
    pub setting: &'a str,
    pub seed: u64,
    pub threads: usize,
}

/// Reads the evaluations in the run folder `folder`. A section is passed from `section_share` of the random-start
/// agents on.
pub fn of(folder: &Path, about: &RunLabel, section_share: f64) -> Result<RunResult, BadInput> {
    let evaluated = evaluated::read(folder)?;
    summarised(&evaluated, about, section_share).ok_or_else(|| {
        let expected = "snapshots, each evaluated from both starts";
        BadInput::new(folder.display(), "a run without them", expected, "remove the folder to train it again")
    })
}

fn summarised(evaluated: &[Evaluated], about: &RunLabel, section_share: f64) -> Option<RunResult> {
    let moment = |e: &Evaluated| TrainedFor { steps: e.steps, seconds: e.seconds };
    let best = evaluated::best(evaluated)?;
    let ready = evaluated::counting(evaluated).iter().find(|e| e.report.completion() >= DEPLOYABLE);
    let (fixed, random) = (best.report.fixed.clone()?, best.report.random.clone()?);
    let passes = |e: &&Evaluated, section: &str| {
        let share = e.report.random.as_ref().and_then(|random| random.sections.get(section));
        share.is_some_and(|&share| share >= section_share)
    };
    let first = |section: &String| Passed {
        section: section.clone(),
        first: evaluated.iter().find(|e| passes(e, section)).map(moment),
    };
    Some(RunResult {
        run: about.run.into(),
        setting: about.setting.into(),
        seed: about.seed,
        threads: about.threads,
        snapshots: evaluated.len(),
        trained: moment(evaluated.last()?),
        best: moment(best),
        ready: ready.map(moment),
        sections: random.sections.keys().map(first).collect(),
        fixed,
        random,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn evaluated(steps: u64, fixed: f64, ladder: f64) -> Evaluated {
        let benchmark = |completion: f64, ladder: f64| {
            json!({"agents": 10, "lap_completion": completion, "lap_time_s": null, "top_speed_m_s": 0,
                "saturated_share": 0,
                "gates_passed": {"median": 0, "mean": 0}, "mean_action_change_sq": 0, "failures_by_gate": {},
                "sections": {"ladder": ladder}})
        };
        let (fixed, random) = (benchmark(fixed, 1.0), benchmark(0.0, ladder));
        let seconds = steps as f64;
        serde_json::from_value(
            json!({"snapshot": "", "steps": steps, "seconds": seconds, "fixed": fixed, "random": random}),
        )
        .unwrap()
    }

    #[test]
    fn firsts_and_the_best() {
        let about = RunLabel { run: "a,seed=1", setting: "a", seed: 1, threads: 2 };
        let run =
            [(10, 0.2, 0.05), (20, 0.95, 0.1), (30, 1.0, 0.4), (40, 0.9, 0.0)].map(|(s, f, l)| evaluated(s, f, l));
        let result = summarised(&run, &about, 0.1).unwrap();
        assert_eq!((result.ready.unwrap().steps, result.best.steps, result.trained.steps), (20, 30, 40));
        assert_eq!((result.fixed.lap_completion, result.sections[0].first.unwrap().steps), (1.0, 20));
        let none = summarised(&run[..1], &about, 0.1).unwrap();
        assert!(none.ready.is_none() && none.sections[0].first.is_none());
        assert!(summarised(&[], &about, 0.1).is_none());
        // Of those that were trained under whole penalties.
        let mut growing = run;
        growing[1].penalty = 0.5;
        growing[2].penalty = 0.9;
        growing[0].penalty = 0.2;
        let result = summarised(&growing, &about, 0.1).unwrap();
        assert!(result.ready.is_none() && result.best.steps == 40);
    }
}
