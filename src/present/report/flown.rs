//! The report of a run: its policy flown again, and all that is drawn of it.

use super::commands::{self, Commands};
use super::figures::{lap_title, training};
use super::run::{StudyFigure, page};
use super::{Drawn, health, lap, spread as spreading};
use crate::base::error::Result;
use crate::base::lane::Level;
use crate::base::threads;
use crate::present::run::health::{BOUNDS, judge};
use crate::present::run::metrics::METRICS;
use crate::present::run::{evaluated, find, metrics};
use crate::race::env::Race;
use crate::race::eval::fly::TraceStep;
use crate::race::eval::spread::spread;
use crate::race::eval::{Report, both_starts};
use crate::race::snapshot::Snapshot;
use std::path::Path;

/// Randomised vehicles in the figure of the spread (the paper's Figure 7 has some hundreds on top of each other).
const SPREAD: usize = 128;

/// A policy, flown as `racer eval` does.
struct FlownRun {
    name: String,
    snapshot: Snapshot,
    race: Race,
    report: Report,
    trace: Vec<TraceStep>,
}

/// Page and figures of the run in `path`, with the commands of the one in `beside` next to its own.
pub fn draw(path: &Path, beside: Option<&Path>) -> Result<Drawn> {
    threads::on(None, || {
        let one = FlownRun::new(path)?;
        let other = beside.map(FlownRun::new).transpose()?;
        let all: Vec<&FlownRun> = [&one].into_iter().chain(&other).collect();
        let mut figures = figures(path, &all)?;
        let rows = healthy_or_not(path)?;
        let caption = "Numbers of the training; orange lines are the bounds of what is healthy.";
        figures.push(StudyFigure { name: "health", caption: caption.into(), svg: health::svg(&rows)? });
        let judged = judge(&rows.iter().map(|row| row.1).collect::<Vec<_>>());
        let flown: Vec<_> = all.iter().map(|f| (f.name.as_str(), &f.report)).collect();
        let title = format!("Run {}", one.name);
        let page = page(&title, &one.snapshot.about, &flown, &health::table(&judged), &figures);
        let named = figures.into_iter().map(|figure| (format!("{}.svg", figure.name), figure.svg));
        Ok(Drawn { page, figures: named.collect() })
    })?
}

/// The numbers of the log that say how healthy the training in `path` was; none where an older racer did not keep one.
fn healthy_or_not(path: &Path) -> Result<Vec<health::HealthRow>> {
    let mut names = ["steps"; BOUNDS.len() + 1];
    names[1..].iter_mut().zip(BOUNDS).for_each(|(name, bound)| *name = bound.column);
    let rows = metrics::read_known(&path.join(METRICS), names)?;
    let row =
        |row: &[Option<f64>; BOUNDS.len() + 1]| (row[0].unwrap_or_default() / 1e6, std::array::from_fn(|i| row[i + 1]));
    Ok(rows.iter().map(row).collect())
}

/// The figures of the first of `all`, which is the run in `path`; the others' commands stand beside its own.
fn figures(path: &Path, all: &[&FlownRun]) -> Result<Vec<StudyFigure>> {
    let one = all[0];
    let about = &one.snapshot.about;
    let mut figures = Vec::new();
    let mut add = |name, caption: &str, svg| figures.push(StudyFigure { name, caption: caption.into(), svg });
    // A run that was ended early has no evaluations.
    if let Ok(snapshots) = evaluated::read(path) {
        let rows = metrics::read(&path.join(METRICS), ["time/seconds", "episode/gates"])?;
        let kept = snapshots.iter().find(|e| e.steps == about.steps).map_or("", |e| &e.snapshot);
        let title = format!("{}, seed {}", about.track.name, about.seed);
        let caption = "Lap completion of the snapshots, and gates an episode while training.";
        add("training", caption, training(&title, &rows, &snapshots, kept)?);
    }
    let caption = "The nominal vehicle's flight from the pad, from above; colour is speed, dots are the reset spline.";
    add("lap", caption, lap::svg(&about.track, &one.trace, &lap_title(&about.track, &one.report))?);
    let columns: Vec<_> = all.iter().map(|f| Commands { title: &f.name, trace: &f.trace }).collect();
    let caption =
        "Commands of the nominal vehicle over the first four seconds from the pad; orange lines mark saturation.";
    add("commands", caption, commands::svg(&columns)?);
    let network = &one.snapshot.network;
    let spread = spread(Level::best(), &one.race, &about.track, network, SPREAD, about.eval.max_steps);
    let title = format!("{}: {SPREAD} randomised vehicles and the nominal one", about.track.name);
    let caption = "Flights from the pad, and how far they pass from where the nominal vehicle flew.";
    add("spread", caption, spreading::svg(&about.track, &spread, &title)?);
    Ok(figures)
}

impl FlownRun {
    fn new(path: &Path) -> Result<Self> {
        let snapshot = Snapshot::read(&find(&path.display().to_string())?.snapshot)?;
        let (about, race) = (&snapshot.about, snapshot.race(None));
        let (report, trace) = both_starts(Level::best(), &race, &about.track, &snapshot.network, &about.eval);
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(FlownRun { name, race, report, trace, snapshot })
    }
}
