//! The columns of a study's tables, each defined here and nowhere else.

use super::result::{Passed, RunResult, TrainedFor};

type MetricOf = Box<dyn Fn(&RunResult) -> Option<f64> + Sync>;

/// One number of a run.
pub struct Metric {
    /// With its unit.
    pub name: String,
    /// Whether a clock measured it: such numbers differ from time to time even where the policies do not.
    pub clock: bool,
    /// Whether it lies in 0..1.
    pub share: bool,
    of: MetricOf,
}

impl Metric {
    /// Of `run`; none where there is none, such as the lap time of a policy that completes no lap.
    pub fn of(&self, run: &RunResult) -> Option<f64> {
        (self.of)(run)
    }
}

/// All metrics for tracks with these sections.
pub fn metrics(sections: &[String]) -> Vec<Metric> {
    let mut all = vec![
        share("fixed_completion", |r| Some(r.fixed.lap_completion)),
        share("random_completion", |r| Some(r.random.lap_completion)),
        // 1 where some snapshot is ready for deployment.
        share("ready", |r| Some(f64::from(u8::from(r.ready.is_some())))),
        number("lap_time_median_s", |r| r.fixed.lap_time_s.map(|time| time.median)),
        number("lap_time_best_s", |r| r.fixed.lap_time_s.map(|time| time.best)),
        number("gates_mean", |r| Some(r.fixed.gates_passed.mean)),
        number("top_speed_m_s", |r| Some(r.fixed.top_speed_m_s)),
        // Smoothness: mean |a_t - a_(t-1)|^2 and share of |a| > 0.95, first four seconds from the pad.
        number("action_change_sq", |r| Some(r.fixed.mean_action_change_sq)),
        share("saturated_share", |r| Some(r.fixed.saturated_share)),
        number("trained_steps", |r| Some(r.trained.steps as f64)),
        number("best_steps", |r| Some(r.best.steps as f64)),
        number("ready_steps", |r| r.ready.map(steps)),
    ];
    all.extend(sections.iter().map(|name| section(name, "steps", false, steps)));
    all.extend([
        clock("trained_s", |r| Some(r.trained.seconds)),
        clock("steps_per_s", |r| Some(r.trained.steps as f64 / r.trained.seconds.max(1e-9))),
        clock("best_s", |r| Some(r.best.seconds)),
        clock("ready_s", |r| r.ready.map(seconds)),
    ]);
    all.extend(sections.iter().map(|name| section(name, "s", true, seconds)));
    all
}

fn steps(moment: TrainedFor) -> f64 {
    moment.steps as f64
}

fn seconds(moment: TrainedFor) -> f64 {
    moment.seconds
}

fn number(name: &str, of: fn(&RunResult) -> Option<f64>) -> Metric {
    Metric { name: name.into(), clock: false, share: false, of: Box::new(of) }
}

fn share(name: &str, of: fn(&RunResult) -> Option<f64>) -> Metric {
    Metric { share: true, ..number(name, of) }
}

fn clock(name: &str, of: fn(&RunResult) -> Option<f64>) -> Metric {
    Metric { clock: true, ..number(name, of) }
}

/// When the section was first passed.
fn section(name: &str, unit: &str, clock: bool, of: fn(TrainedFor) -> f64) -> Metric {
    let section = name.to_string();
    let first = move |r: &RunResult| {
        let passed: Option<&Passed> = r.sections.iter().find(|passed| passed.section == section);
        passed.and_then(|passed| passed.first).map(of)
    };
    Metric { name: format!("{}_{unit}", name.replace(' ', "_")), clock, share: false, of: Box::new(first) }
}
