//! What each criterion is worth: halved and doubled, on logs that are kept or drawn, and what changes.

use crate::answer::Answer;
use crate::args::Args;
use crate::case::Case;
use crate::run::{self, Folder, LOG, VEHICLE};
use crate::truth::hidden;
use racer::model::vehicle::Vehicle;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

const FACTORS: [&str; 2] = ["0.5", "2"];

/// A criterion, as the program lists it.
struct Listed {
    name: String,
    value: String,
    question: String,
}

/// What the program says of a log: its verdict, and the effects that it names.
#[derive(PartialEq)]
struct Said {
    verdict: String,
    names: BTreeSet<String>,
}

/// Prints a line for each criterion and factor, and writes them as CSV where that was asked for.
///
/// # Panics
///
/// Where the program fails, or a file cannot be read or written.
pub fn measure(args: &Args, wanted: &[String]) {
    let scratch = tempfile::tempdir().expect("a temporary folder");
    let logs = args.logs.as_ref().map_or_else(|| drawn(args, scratch.path()), |folder| kept(folder));
    let say = |log: &Path, scaled: &[&str]| said(args, scratch.path(), log, scaled);
    let before: Vec<Said> = logs.iter().map(|log| say(log, &[])).collect();
    println!("{} logs\n{:<26}{:>8}{:>7}{:>7}{:>9}", logs.len(), "criterion", "value", "factor", "names", "verdicts");
    let mut table = csv::Writer::from_writer(Vec::new());
    let header = ["criterion", "question", "value", "factor", "logs", "names_changed", "verdicts_changed", "what"];
    table.write_record(header).expect("a row");
    for Listed { name, value, question } in listed(args, wanted) {
        for factor in FACTORS {
            let option = format!("{name}={factor}");
            let after: Vec<Said> = logs.iter().map(|log| say(log, &["--scale-criterion", &option])).collect();
            let pairs = || before.iter().zip(&after);
            let names = pairs().filter(|(a, b)| a.names != b.names).count().to_string();
            let verdicts = pairs().filter(|(a, b)| a.verdict != b.verdict).count().to_string();
            let what: Vec<String> = pairs().zip(&logs).filter_map(|((a, b), log)| change(log, a, b)).collect();
            println!("{name:<26}{value:>8}{factor:>7}{names:>7}{verdicts:>9}  {}", what.join("; "));
            let of = logs.len().to_string();
            let row = [&name, &question, &value, factor, &of, &names, &verdicts, &what.join("; ")];
            table.write_record(row).expect("a row");
            if let Some(path) = &args.csv {
                table.flush().expect("rows");
                std::fs::write(path, table.get_ref()).expect("the table");
            }
        }
    }
}

/// What a log loses (-) and gains (+), if anything.
fn change(log: &Path, before: &Said, after: &Said) -> Option<String> {
    let lost = before.names.difference(&after.names).map(|name| format!("-{name}"));
    let gained = after.names.difference(&before.names).map(|name| format!("+{name}"));
    let verdict = (before.verdict != after.verdict).then(|| format!("{} > {}", before.verdict, after.verdict));
    let all: Vec<String> = lost.chain(gained).chain(verdict).collect();
    let name = log.file_name().unwrap_or_default().to_string_lossy();
    (!all.is_empty()).then(|| format!("{name}: {}", all.join(" ")))
}

/// Folders below `folder` that hold a log and the vehicle it is taken for, in the order of their names.
fn kept(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder of the logs");
    let mut all: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    all.retain(|path| path.join(LOG).is_file());
    all.sort();
    assert!(!all.is_empty(), "{} holds no folder with {LOG}", folder.display());
    all.iter().map(|path| std::path::absolute(path).expect("a path")).collect()
}

/// Draws `--n` logs.
fn drawn(args: &Args, scratch: &Path) -> Vec<PathBuf> {
    let one = |number: usize| {
        let case = Case::draw(number, args);
        let name = format!("{number:04}");
        let folder = if args.keep.is_some() { Folder::new(args, &name).path } else { scratch.join(name) };
        std::fs::create_dir_all(&folder).expect("a folder");
        run::write(&folder, &hidden::fly(&case.flown, &case.hidden, &case.setting));
        let base = Vehicle { name: "base".into(), ..case.base.in_racer() };
        std::fs::write(folder.join(VEHICLE), toml::to_string(&base).expect("a vehicle is TOML")).expect("the vehicle");
        std::path::absolute(folder).expect("a path")
    };
    (0..args.n).map(one).collect()
}

/// The program's criteria of the names `wanted`, or all.
fn listed(args: &Args, wanted: &[String]) -> Vec<Listed> {
    let program = std::path::absolute(&args.racer).expect("a path");
    let output = Command::new(program).args(["diagnose", "--criteria"]).output().expect("the program runs");
    let mut reader = csv::Reader::from_reader(&output.stdout[..]);
    let row = |row: csv::Result<csv::StringRecord>| {
        let row = row.expect("a row of the program's list");
        Listed { name: row[0].into(), value: row[1].into(), question: row[2].into() }
    };
    let all: Vec<Listed> = reader.records().map(row).collect();
    let unknown = wanted.iter().find(|name| all.iter().all(|listed| listed.name != **name));
    assert!(unknown.is_none(), "no criterion is called {}", unknown.map_or("", |name| name));
    all.into_iter().filter(|listed| wanted.is_empty() || wanted.contains(&listed.name)).collect()
}

fn said(args: &Args, scratch: &Path, log: &Path, scaled: &[&str]) -> Said {
    let out = scratch.join("said.json");
    let _ = std::fs::remove_file(&out);
    let (path, base) = (log.join(LOG), log.join(VEHICLE));
    let [path, base, json] = [&path, &base, &out].map(|path| path.to_str().expect("a path in UTF-8"));
    run::run(args, scratch, &[&["diagnose", path, "--vehicle", base, "--json", json], scaled].concat())
        .expect("an answer");
    let answer = Answer::read(&std::fs::read_to_string(&out).expect("the answer")).expect("an answer");
    Said { names: answer.named().map(|finding| finding.effect.clone()).collect(), verdict: answer.verdict }
}
