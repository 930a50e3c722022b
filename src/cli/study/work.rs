//! The runs that a study still lacks, several at a time.

use super::child::{self, ChildEnd, ChildTraining};
use super::display::Display;
use crate::base::claim::Claim;
use crate::base::fsio;
use crate::cli::interrupt;
use crate::present::run::DIVERGED;
use crate::present::study::folder::{Folder, RunState, same};
use crate::present::study::plan::Planned;
use crate::present::study::result::{self, RESULT, RunLabel, RunResult};
use crate::present::study::shard::Shard;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is to be done, where, by how many.
pub struct Work<'a> {
    pub planned: &'a Planned,
    pub folder: &'a Folder,
    pub shard: Shard,
    pub jobs: usize,
    /// Of each run.
    pub threads: usize,
}

/// How the work ended.
#[derive(Default)]
pub struct WorkEnd {
    pub interrupted: bool,
    /// Runs that another process was making.
    pub elsewhere: Vec<String>,
    /// Runs that failed, and why.
    pub failed: Vec<(String, String)>,
}

/// How a run ended.
enum Made {
    Done(Box<RunResult>),
    /// Its numbers were not finite on the way.
    Diverged,
    /// Finished by another process in the meantime.
    Before,
    Elsewhere,
    Stopped,
    Failed(String),
}

/// Makes all runs of the part that are not finished.
pub fn work(work: &Work) -> anyhow::Result<WorkEnd> {
    let runs = work.planned.plan.runs.iter().enumerate();
    let missing = runs.filter(|(i, run)| work.shard.has(*i) && is_open(work.folder, &run.name)).map(|(i, _)| i);
    let missing: Vec<usize> = missing.collect();
    if missing.is_empty() {
        return Ok(WorkEnd::default());
    }
    let display = Display::new(missing.len());
    let (next, done, ended) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(WorkEnd::default()));
    std::thread::scope(|scope| {
        for _ in 0..work.jobs.min(missing.len()) {
            scope.spawn(|| {
                while let Some(&run) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let name = &work.planned.plan.runs[run].name;
                    let line = display.begin(name);
                    let made =
                        make(work, run, &|text| line.show(text)).unwrap_or_else(|e| Made::Failed(format!("{e:#}")));
                    let remark = format!("{name} {}", remark(&made));
                    display.end(line, done.fetch_add(1, Ordering::Relaxed) + 1, &remark);
                    if let Ok(mut ended) = ended.lock() {
                        match made {
                            Made::Done(_) | Made::Diverged | Made::Before => {}
                            Made::Elsewhere => ended.elsewhere.push(name.clone()),
                            Made::Stopped => ended.interrupted = true,
                            Made::Failed(why) => ended.failed.push((name.clone(), why)),
                        }
                        if ended.interrupted {
                            return;
                        }
                    }
                }
            });
        }
    });
    display.finish();
    Ok(ended.into_inner().unwrap_or_default())
}

fn remark(made: &Made) -> String {
    match made {
        Made::Done(result) => format!(
            "done: {:.1} M steps in {:.0} s, {:.1} % of fixed starts lap",
            result.trained.steps as f64 / 1e6,
            result.trained.seconds,
            100.0 * result.fixed.lap_completion
        ),
        Made::Diverged => "diverged: its numbers were not finite on the way; it is not ranked".into(),
        Made::Before => "was finished by another process".into(),
        Made::Elsewhere => "is being made by another process".into(),
        Made::Stopped => "stopped".into(),
        Made::Failed(why) => format!("failed: {}", why.lines().next().unwrap_or_default()),
    }
}

/// Whether there is a run to be made.
pub fn is_open(folder: &Folder, name: &str) -> bool {
    matches!(folder.state(name), RunState::Missing | RunState::Damaged(_))
}

/// Trains a run and makes its folder appear, all at once.
fn make(work: &Work, run: usize, heard: &(dyn Fn(&str) + Sync)) -> anyhow::Result<Made> {
    let Work { planned, folder, threads, .. } = work;
    let (about, (settings, setup)) = (&planned.plan.runs[run], &planned.runs[run]);
    if interrupt::asked() {
        return Ok(Made::Stopped);
    }
    let Some(claim) = Claim::take(&folder.work(), &about.name)? else { return Ok(Made::Elsewhere) };
    if !is_open(folder, &about.name) {
        return Ok(Made::Before);
    }
    let training = ChildTraining { config: &planned.config, settings, threads: *threads, out: claim.work() };
    let diverged = match child::train(&training, heard)? {
        ChildEnd::Stopped => return Ok(Made::Stopped),
        ChildEnd::Failed(why) if !claim.work().join(DIVERGED).is_file() => return Ok(Made::Failed(why)),
        ChildEnd::Trained | ChildEnd::Failed(_) => claim.work().join(DIVERGED).is_file(),
    };
    // A file that the configuration names may have changed since it was planned.
    same(claim.work(), setup)?;
    let setting = &planned.plan.settings[about.setting].name;
    let about = RunLabel { run: &about.name, setting, seed: about.seed, threads: *threads };
    if let RunState::Damaged(why) = folder.state(about.run) {
        let aside = folder.set_aside(about.run)?;
        crate::cli::tell(&format!("{} was damaged ({why}); it is in {} now", about.run, aside.display()));
    }
    if diverged {
        claim.publish(&folder.run(about.run))?;
        return Ok(Made::Diverged);
    }
    let result = result::of(claim.work(), &about, planned.plan.section_share)?;
    let text = serde_json::to_string_pretty(&result)? + "\n";
    fsio::replace(&claim.work().join(RESULT), text.as_bytes())?;
    claim.publish(&folder.run(about.run))?;
    Ok(Made::Done(Box::new(result)))
}
