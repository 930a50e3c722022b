//! `racer study`: a grid of settings times seeds, run, resumed, shared among machines, and told in tables.

mod child;
mod display;
mod slurm;
mod text;
mod work;

use super::{CommandEnd, columns, interrupt, tell};
use crate::base::check::BadInput;
use crate::base::fsio::Reserved;
use crate::base::threads::processors;
use crate::present::run::RUNS;
use crate::present::study::folder::{Folder, RunState};
use crate::present::study::plan::{Planned, StudyBudget, plan};
use crate::present::study::shard::Shard;
use crate::present::study::{Study, tables};
use slurm::{SlurmArgs, Tasks};
use std::path::{Path, PathBuf};
use work::{Work, WorkEnd};

/// Train a grid of settings times seeds under one budget, and rank the settings
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Study: a name or a file, looked for here, in configs/studies/ and among the built-in ones
    #[arg(value_name = "NAME|FILE")]
    file: String,
    /// Folder of the study; one that exists is gone on with [default: runs/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make only part K of N: machines that share the folder make a part each
    #[arg(long, value_name = "K/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Runs at a time, each with its share of the processors [default: as the file says, else 1]
    #[arg(long, value_parser = super::values::parse_threads)]
    jobs: Option<usize>,
    /// Processors to share among the runs [default: all]
    #[arg(long, value_parser = super::values::parse_threads)]
    threads: Option<usize>,
    /// Train each run for so many minutes, whatever the file says
    #[arg(long, allow_negative_numbers = true, conflicts_with = "steps")]
    minutes: Option<f64>,
    /// Train each run for so many environment steps, whatever the file says
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=i64::MAX as u64))]
    steps: Option<u64>,
    /// Check the study and list its runs; train nothing
    #[arg(long, conflicts_with_all = ["table", "json"])]
    list: bool,
    /// Make the tables of what is finished; train nothing
    #[arg(long)]
    table: bool,
    /// New file for all tables as JSON; the study's folder has the same
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    slurm: SlurmArgs,
}

const HELP: &str = "A study is a file with a grid. This one makes six runs:

  minutes = 1
  seeds = 3
  [grid]
  ppo.minibatches = [16, 64]

Further keys: config (base configuration), steps in place of minutes, agents, section_share, jobs; [set] for keys that \
are the same in all runs; [cases.GROUP] for named values of several keys together. Built in are paper_configurations, \
cpu_configurations, seeds_paper, seeds, regularisation, regularisation_factorial and entropy.

Every setting is checked before the first run begins. After any interruption the same command goes on, without \
repeating a finished run; with --steps it ends in the same tables. Ctrl-C ends the runs under way, which are repeated \
then. --slurm submits the runs that are still to do as an array job; called again when that is over, those that \
failed. --table says how far it is.

Examples:
  racer study mine.toml
  racer study cpu_configurations --minutes 2 --jobs 2 --out runs/cpu
  racer study seeds --shard 2/4 --out /shared/seeds
  racer study seeds --out /shared/seeds --slurm --partition long --threads 8
  racer report runs/cpu";

/// Plans, trains what is missing, writes and prints the tables.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let (document, study) = Study::open(&args.file)?;
    let budget = StudyBudget { minutes: args.minutes, steps: args.steps };
    let planned = plan(&args.file, &document, &study, budget)?;
    let (jobs, threads) = share(args, &study)?;
    let out = args.out.clone().unwrap_or_else(|| Path::new(RUNS).join(&planned.plan.study));
    let folder = Folder::open(&out, &planned)?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    if args.list {
        super::print(&list(&planned, &folder, shard))?;
        return Ok(CommandEnd::Done);
    }
    let json = args.json.as_deref().map(|path| Reserved::new(path, "--json")).transpose()?;
    folder.begin(&planned.plan, document.text())?;
    if args.slurm.asked() {
        return submit(args, &out, &planned, &folder, threads);
    }
    let ended = if args.table {
        WorkEnd::default()
    } else {
        interrupt::watch("Ending the runs under way; Ctrl-C again ends at once.");
        work::work(&Work { planned: &planned, folder: &folder, shard, jobs, threads })?
    };

    let results = folder.write_tables()?;
    if let Some(json) = json {
        json.write(tables::json(&results)?.as_bytes())?;
    }
    if results.finished() + results.diverged.len() > 0 {
        super::print(&text::results(&results))?;
    }
    conclude(args, &out, &ended, results.finished(), results.runs.len())
}

/// Leaves the runs that are to do to Slurm.
fn submit(args: &Args, out: &Path, planned: &Planned, folder: &Folder, threads: usize) -> anyhow::Result<CommandEnd> {
    let of = planned.plan.runs.len();
    let open = |run: &usize| work::is_open(folder, &planned.plan.runs[run - 1].name);
    let runs: Vec<usize> = (1..=of).filter(open).collect();
    if runs.is_empty() {
        tell(&format!("nothing to submit: {of} of {of} runs are made; tables: racer study {} --table", args.file));
        return Ok(CommandEnd::Done);
    }
    let job = slurm::submit(out, &args.slurm, &Tasks { runs: &runs, of, threads, command: args.again(out)? })?;
    tell(&format!("job {job}: {} of {of} runs are to do, {threads} processors each", runs.len()));
    tell(&format!("what they print: {}", slurm::prints(out).display()));
    tell(&format!("how far it is: racer study {} --out {} --table", args.file, out.display()));
    Ok(CommandEnd::Done)
}

impl Args {
    /// The same study into the same folder, as a command's words.
    fn again(&self, out: &Path) -> std::io::Result<Vec<String>> {
        let out = std::path::absolute(out)?.display().to_string();
        let mut words = vec!["study".to_string(), self.file.clone(), "--out".into(), out];
        for (option, value) in
            [("--minutes", self.minutes.map(|x| x.to_string())), ("--steps", self.steps.map(|x| x.to_string()))]
        {
            words.extend(value.into_iter().flat_map(|value| [option.to_string(), value]));
        }
        Ok(words)
    }
}

/// Runs at a time and threads of each.
fn share(args: &Args, study: &Study) -> Result<(usize, usize), BadInput> {
    let (all, jobs) = (args.threads.unwrap_or_else(processors), args.jobs.unwrap_or(study.jobs));
    if jobs > all {
        let advice =
            "give --jobs; a run that shares its processor with another one would be trained less than they say";
        return Err(BadInput::new("jobs", jobs, &format!("at most {all}, the processors there are"), advice));
    }
    Ok((jobs, all / jobs))
}

fn list(planned: &Planned, folder: &Folder, shard: Shard) -> String {
    let runs = planned.plan.runs.iter().enumerate().filter(|(i, _)| shard.has(*i)).map(|(i, run)| {
        let state = match folder.state(&run.name) {
            RunState::Missing => "to do",
            RunState::Finished(_) => "finished",
            RunState::Diverged => "diverged",
            RunState::Damaged(_) => "damaged, to do again",
        };
        vec![(i + 1).to_string(), run.name.clone(), state.to_string()]
    });
    let runs: Vec<_> = runs.collect();
    let text = format!("{} of {} runs", runs.len(), planned.plan.runs.len());
    format!("{}\n\n{text}", columns::table(&["", "run", "state"], runs, 0..1))
}

/// What is left to say, and how it ended.
fn conclude(args: &Args, out: &Path, ended: &WorkEnd, finished: usize, planned: usize) -> anyhow::Result<CommandEnd> {
    tell(&format!("{finished} of {planned} runs are finished; tables in {}", out.display()));
    if let Some((job, states)) = slurm::under_way(out) {
        tell(&format!("job {job} of Slurm: {states}"));
    }
    for name in &ended.elsewhere {
        tell(&format!("{name} is being made by another process"));
    }
    if ended.interrupted {
        let shard = args.shard.map_or(String::new(), |shard| format!(" --shard {shard}"));
        tell(&format!(
            "Stopped. The same command goes on: racer study {} --out {}{shard}, with the other options as they were.",
            args.file,
            out.display()
        ));
        return Ok(CommandEnd::Interrupted);
    }
    for (name, why) in &ended.failed {
        tell(&format!("{name} failed: {why}"));
    }
    match ended.failed.len() {
        0 => {
            tell(&format!("figures: racer report {}", out.display()));
            Ok(CommandEnd::Done)
        }
        failed => anyhow::bail!("{failed} of the runs failed, as said above; the same command tries them again"),
    }
}
