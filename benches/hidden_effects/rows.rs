//! A run's cases as lines of CSV, written as each is done: a run that was stopped goes on where it was left.

use crate::args::Args;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

/// What is printed and written of a case.
pub trait Row {
    const COLUMNS: &'static [&'static str];
    fn fields(&self) -> Vec<String>;
    fn line(&self) -> String;
}

/// Which case a row is of.
const KEY: [&str; 4] = ["build", "seed", "flight_s", "log"];

/// The file of `--csv`, where there is one.
pub struct Rows {
    writer: Option<Mutex<csv::Writer<std::fs::File>>>,
    /// What the rows of this run begin with.
    run: [String; 3],
    done: BTreeSet<usize>,
}

impl Rows {
    /// Opens the file for rows of `T`; those of the same build, seed and length of flight are done.
    ///
    /// # Panics
    ///
    /// Where the file cannot be read and written, or has other columns.
    pub fn open<T: Row>(args: &Args) -> Self {
        let run = [args.build.clone().unwrap_or_else(commit), args.seed.to_string(), args.seconds.to_string()];
        let Some(path) = &args.csv else { return Rows { writer: None, run, done: BTreeSet::new() } };
        let columns: Vec<&str> = KEY.iter().chain(T::COLUMNS).copied().collect();
        let begun = std::fs::metadata(path).is_ok_and(|file| file.len() > 0);
        let done = if begun { done(path, &columns, &run) } else { BTreeSet::new() };
        let file = std::fs::OpenOptions::new().create(true).append(true).open(path).expect("the CSV can be written");
        let mut writer = csv::Writer::from_writer(file);
        if !begun {
            writer.write_record(&columns).expect("the columns");
        }
        Rows { writer: Some(Mutex::new(writer)), run, done }
    }

    pub fn has(&self, number: usize) -> bool {
        self.done.contains(&number)
    }

    /// Writes the row of case `number`.
    ///
    /// # Panics
    ///
    /// Where the file cannot be written.
    pub fn write(&self, number: usize, row: &impl Row) {
        let Some(writer) = &self.writer else { return };
        let mut writer = writer.lock().expect("no thread panics with it");
        let key = self.run.iter().cloned().chain([number.to_string()]);
        writer.write_record(key.chain(row.fields())).expect("a line");
        writer.flush().expect("a line on the disk");
    }
}

/// Numbers of the cases that the file has of this run.
fn done(path: &Path, columns: &[&str], run: &[String]) -> BTreeSet<usize> {
    let mut reader = csv::Reader::from_path(path).expect("the CSV can be read");
    assert_eq!(reader.headers().expect("a line of columns"), columns, "{} has other columns", path.display());
    let rows = reader.records().map(|row| row.expect("a row"));
    rows.filter(|row| row.iter().zip(run).all(|(field, wanted)| field == wanted))
        .map(|row| row[run.len()].parse().expect("the number of a case"))
        .collect()
}

/// The commit that this was built from, or nothing.
fn commit() -> String {
    let git = Command::new("git").args(["rev-parse", "--short", "HEAD"]).output();
    git.map_or(String::new(), |said| String::from_utf8_lossy(&said.stdout).trim().to_string())
}
