//! The command line: arguments in, text and exit code out. Nothing else prints.

mod bench;
mod check;
mod columns;
mod diagnose;
mod eval;
mod export;
mod extend;
mod findings;
mod fly;
mod identify;
mod import;
mod interrupt;
mod logs;
mod outputs;
mod pilot;
mod predict;
mod progress;
mod replay;
mod report;
mod sensitivity;
mod study;
mod table;
mod track;
mod train;
mod training;
mod values;

use crate::base::check::BadInput;
use crate::base::error::Error;
use clap::{Parser, Subcommand};
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

/// Train drone-racing policies in minutes on an ordinary CPU.
#[derive(Debug, Parser)]
#[command(name = "racer", version, max_term_width = 100, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Train(train::Args),
    Eval(eval::Args),
    Fly(fly::Args),
    Replay(replay::Args),
    Export(export::Args),
    Pilot(pilot::Args),
    Track(track::Args),
    Import(import::Args),
    Check(check::Args),
    Identify(identify::Args),
    Predict(predict::Args),
    Diagnose(diagnose::Args),
    Extend(extend::Args),
    Study(study::Args),
    Report(report::Args),
    Bench(bench::Args),
}

const EXIT_CODES: &str = "Results go to standard output, everything else to standard error.

Exit codes:
  0    done
  1    something failed on the way, such as a full disk
  2    bad input: nothing was started
  3    a flight log is damaged; its readable part was used
  4    `--require` was not met, or a rehearsal did not complete its laps
  5    `--fail-on-effect` found an effect, or `--fail-on-change` a change
  6    `racer check` found what stops identification and diagnosis
  130  stopped by Ctrl-C";

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CommandEnd {
    Done,
    Failed,
    Refused,
    Damaged,
    NotMet,
    Effect,
    Problem,
    Interrupted,
}

impl CommandEnd {
    fn code(self) -> u8 {
        match self {
            CommandEnd::Done => 0,
            CommandEnd::Failed => 1,
            CommandEnd::Refused => 2,
            CommandEnd::Damaged => 3,
            CommandEnd::NotMet => 4,
            CommandEnd::Effect => 5,
            CommandEnd::Problem => 6,
            CommandEnd::Interrupted => 130,
        }
    }
}

/// Runs the command that this process was started with.
pub fn main() -> ExitCode {
    interrupt::install();
    // Usage errors end here, with clap's own message and exit code 2.
    let result = match Cli::parse().command {
        Command::Train(args) => train::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Fly(args) => fly::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Pilot(args) => pilot::run(&args),
        Command::Track(args) => track::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Identify(args) => identify::run(&args),
        Command::Predict(args) => predict::run(&args),
        Command::Diagnose(args) => diagnose::run(&args),
        Command::Extend(args) => extend::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Study(args) => study::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    let code = result.map(CommandEnd::code).unwrap_or_else(|error| {
        let outcome = ended(&error);
        tell(&if outcome == CommandEnd::Interrupted { error.to_string() } else { format!("error: {error:#}") });
        outcome.code()
    });
    ExitCode::from(code)
}

/// How a command ended that failed.
fn ended(error: &anyhow::Error) -> CommandEnd {
    match error.downcast_ref::<Error>() {
        Some(Error::Interrupted(_)) => CommandEnd::Interrupted,
        Some(Error::BadInput(_)) => CommandEnd::Refused,
        _ if error.is::<BadInput>() => CommandEnd::Refused,
        _ => CommandEnd::Failed,
    }
}

/// Prints a result. A reader that has gone away is no error: it has what it wanted.
fn print(text: &str) -> io::Result<()> {
    match writeln!(io::stdout(), "{text}") {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Prints a remark.
fn tell(text: &str) {
    // Where even that fails there is nobody left to tell.
    let _ = writeln!(io::stderr(), "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_declared_without_contradiction() {
        Cli::command().debug_assert();
    }
}
