//! `racer eval --sensitivity`: which error of the model costs a policy most.

use super::{CommandEnd, columns, print, progress, tell};
use crate::base::fsio::Reserved;
use crate::base::lane::Level;
use crate::base::threads;
use crate::learn::nn::Network;
use crate::model::track::Track;
use crate::race::env::Race;
use crate::race::eval::EvalConfig;
use crate::race::eval::sensitivity::{Cell, Row, Sensitivity, sensitivity};
use serde::Serialize;

/// Agents in each cell unless asked otherwise.
pub const AGENTS: usize = 128;

/// What is written and, with `--json`, printed.
#[derive(Serialize)]
struct SensitivityDocument<'a> {
    snapshot: &'a str,
    track: &'a str,
    vehicle: &'a str,
    #[serde(flatten)]
    found: &'a Sensitivity,
}

/// Who flies where.
pub struct Case<'a> {
    pub race: &'a Race,
    pub track: &'a Track,
    pub network: &'a Network<f32>,
    pub config: &'a EvalConfig,
}

/// Flies, prints and writes.
pub fn run(
    snapshot: &str,
    flown: &Case,
    threads: Option<usize>,
    json: bool,
    out: Reserved,
) -> anyhow::Result<CommandEnd> {
    let Case { race, track, network, config } = *flown;
    let bar = progress::bar();
    let found = threads::on(threads, || {
        let mut observer = |share: f64| bar.set_position((100.0 * share) as u64);
        sensitivity(Level::best(), race, track, network, config, &mut observer)
    })?;
    bar.finish_and_clear();
    let document = SensitivityDocument { snapshot, track: &track.name, vehicle: &race.vehicle.name, found: &found };
    let content = serde_json::to_string_pretty(&document)?;
    let written = out.write(format!("{content}\n").as_bytes())?;
    print(&if json { content } else { text(&document) })?;
    tell(&format!("written to {}", written.display()));
    Ok(CommandEnd::Done)
}

fn text(document: &SensitivityDocument) -> String {
    let Sensitivity { agents, nominal, parameters } = document.found;
    let (charge, factors): (Vec<_>, Vec<_>) = parameters.iter().partition(|row| row.parameter == "charge");
    format!(
        "{} on {} in {}: {agents} flights a cell, with the training's noise; nominal {}\n\n\
         laps completed, %, and median lap, s, with this factor on one parameter alone; * outside of what was \
         trained\n{}\n\n\
         the same for the charge of the battery at the start, 0 empty, 1 full\n{}",
        document.snapshot,
        document.track,
        document.vehicle,
        cell(nominal).replace('\n', " %, lap ") + " s",
        table(&factors),
        table(&charge)
    )
}

fn table(rows: &[&Row]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let values: Vec<_> = first.cells.iter().map(|cell| format!("{:.1}", cell.value)).collect();
    let header: Vec<&str> = ["parameter", "mean loss, %", "slower by, s", "95 % holds"]
        .into_iter()
        .chain(values.iter().map(String::as_str))
        .collect();
    let lines = rows.iter().map(|row| {
        let holds = row.holds.map_or("nowhere".into(), |[low, high]| format!("{low:.1} - {high:.1}"));
        let slower = row.slower_s.map_or("-".into(), |slower| format!("{slower:.2}"));
        let mut line = vec![row.parameter.clone(), format!("{:.1}", 100.0 * row.loss), slower, holds];
        line.extend(row.cells.iter().map(|each| {
            let [low, high] = row.trained;
            let inside = (low - 1e-9..=high + 1e-9).contains(&each.value);
            if inside { cell(each) } else { cell(each).replace('\n', "*\n") }
        }));
        line
    });
    let count = header.len();
    columns::table(&header, lines.collect(), 1..count)
}

fn cell(cell: &Cell) -> String {
    let lap = cell.lap_s.map_or("-".into(), |lap| format!("{lap:.2}"));
    format!("{:.0}\n{lap}", 100.0 * cell.completion)
}
