//! Which policy of a training is kept: every one flown, the best written with its figures.

use super::{Ended, Finished, TrainingWatch, file_of};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::lane::Level;
use crate::present::report::figures::{self, TRAINING};
use crate::present::run::checkpoints::Taken;
use crate::present::run::evaluated::{self, EVALUATED, Evaluated};
use crate::present::run::metrics::{self, METRICS};
use crate::present::run::{POLICY, Run};
use crate::race::config::Setup;
use crate::race::eval::both_starts;
use crate::race::eval::fly::TraceStep;
use crate::race::snapshot::Snapshot;

/// Evaluates all policies, in their order, each trained for so many seconds, with the nominal vehicle's flight from the
/// pad; none where `stop` says so in between.
pub fn evaluate(
    level: Level,
    setup: &Setup,
    policies: &[(Snapshot, f64)],
    stop: &mut dyn FnMut() -> bool,
) -> Option<Vec<(Evaluated, Vec<TraceStep>)>> {
    let Setup { config, track, .. } = setup;
    let mut all = Vec::new();
    for (policy, seconds) in policies {
        if stop() {
            return None;
        }
        let (report, trace) = both_starts(level, &policy.race(None), track, &policy.network, &config.eval);
        let (steps, seconds) = (policy.about.steps, *seconds);
        let penalty = config.ppo.penalty(config.budget.share(steps, seconds));
        all.push((Evaluated { snapshot: file_of(steps), steps, seconds, penalty, report }, trace));
    }
    Some(all)
}

/// Evaluates the policies that were taken, and writes the best: first itself, last the figures, without which it is
/// whole.
pub fn choose(
    run: &Run,
    setup: &Setup,
    level: Level,
    taken: &[Taken],
    trained: Taken,
    watch: &mut dyn TrainingWatch,
) -> Result<Ended> {
    watch.evaluating(taken.len());
    let read = |taken: &Taken| Ok((Snapshot::read(&run.folder.join(file_of(taken.steps)))?, taken.seconds));
    let policies = taken.iter().map(read).collect::<Result<Vec<_>>>()?;
    let Some(flown) = evaluate(level, setup, &policies, &mut || watch.stop()) else {
        return Ok(Ended::Stopped { steps: trained.steps });
    };
    let (all, traces): (Vec<_>, Vec<_>) = flown.into_iter().unzip();
    let best = evaluated::best(&all).map(|best| &best.snapshot);
    let Some(chosen) = all.iter().position(|e| Some(&e.snapshot) == best) else {
        return Err(Error::Failed("the training took no snapshot".into()));
    };
    run.replace(POLICY, policies[chosen].0.checked_bytes()?)?;
    run.replace(EVALUATED, encode::json("the evaluations", &all)?)?;
    run.replace("evaluation.json", encode::json("the evaluation", &all[chosen])?)?;
    let finished = Finished {
        run: run.clone(),
        steps: trained.steps,
        seconds: trained.seconds,
        snapshots: all.len(),
        policy: policies[chosen].0.clone(),
        evaluated: all[chosen].clone(),
    };
    let drawn = draw(run, setup, &traces[chosen], &all, chosen);
    watch.finished(&finished)?;
    drawn?;
    Ok(Ended::Finished(Box::new(finished)))
}

fn draw(run: &Run, setup: &Setup, trace: &[TraceStep], all: &[Evaluated], chosen: usize) -> Result<()> {
    figures::write_lap(run, &setup.track, trace, &all[chosen].report)?;
    let title = format!("{}, seed {}", setup.track.name, setup.config.seed);
    let curve = metrics::read(&run.folder.join(METRICS), ["time/seconds", "episode/gates"])?;
    run.replace(TRAINING, figures::training(&title, &curve, all, &all[chosen].snapshot)?)?;
    Ok(())
}
