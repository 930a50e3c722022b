//! The report of a run.

use super::Drawn;
use crate::base::lane::Level;
use crate::cli::pool::{pool, threads};
use crate::present::report::commands::{self, Commands};
use crate::present::report::figures::{lap_title, training};
use crate::present::report::{lap, run as page, spread as spreading};
use crate::present::run::metrics::METRICS;
use crate::present::run::{evaluated, find, metrics};
use crate::race::env::Race;
use crate::race::env::reset::Place;
use crate::race::eval::Report;
use crate::race::eval::benchmark;
use crate::race::eval::fly::Moment;
use crate::race::eval::spread::spread;
use crate::race::snapshot::Snapshot;
use std::path::Path;

/// Randomised vehicles in the figure of the spread (the paper's Figure 7 has some hundreds on top of each other).
const SPREAD: usize = 128;

/// A policy, flown as `racer eval` does.
struct Flown {
    name: String,
    snapshot: Snapshot,
    race: Race,
    report: Report,
    trace: Vec<Moment>,
}

/// Page and figures of the run in `path`, with the commands of the one in `beside` next to its own.
pub fn draw(path: &Path, beside: Option<&Path>) -> anyhow::Result<Drawn> {
    pool(threads(None))?.install(|| {
        let one = Flown::new(path)?;
        let other = beside.map(Flown::new).transpose()?;
        let about = &one.snapshot.about;
        let mut figures = Vec::new();
        let mut add = |name, caption: String, svg| figures.push(page::Figure { name, caption, svg });
        // A run that was ended early has no evaluations.
        if let Ok(snapshots) = evaluated::read(path) {
            let rows = metrics::read(&path.join(METRICS), ["time/seconds", "episode/gates"])?;
            let kept = snapshots.iter().find(|e| e.steps == about.steps).map_or("", |e| &e.snapshot);
            let title = format!("{}, seed {}", about.track.name, about.seed);
            let caption = "Lap completion of the snapshots, and gates an episode while training.".into();
            add("training", caption, training(&title, &rows, &snapshots, kept)?);
        }
        let caption =
            "The nominal vehicle's flight from the pad, from above; colour is speed, dots are the reset spline.".into();
        add("lap", caption, lap::svg(&about.track, &one.trace, &lap_title(&about.track, &one.report))?);
        let all: Vec<&Flown> = [&one].into_iter().chain(&other).collect();
        let columns: Vec<_> = all.iter().map(|f| Commands { title: &f.name, trace: &f.trace }).collect();
        let caption =
            "Commands of the nominal vehicle over the first four seconds from the pad; orange lines mark saturation."
                .into();
        add("commands", caption, commands::svg(&columns)?);
        let (race, network) = (&one.race, &one.snapshot.network);
        let spread = spread(Level::best(), race, &about.track, network, SPREAD, about.eval.max_steps);
        let title = format!("{}: {SPREAD} randomised vehicles and the nominal one", about.track.name);
        let caption = "Flights from the pad, and how far they pass from where the nominal vehicle flew.".into();
        add("spread", caption, spreading::svg(&about.track, &spread, &title)?);
        let rows: Vec<_> = all.iter().map(|f| (f.name.as_str(), &f.report)).collect();
        let page = page::page(&format!("Run {}", one.name), about, &rows, &figures);
        let named = figures.into_iter().map(|figure| (format!("{}.svg", figure.name), figure.svg));
        Ok(Drawn { page, figures: named.collect() })
    })
}

impl Flown {
    fn new(path: &Path) -> anyhow::Result<Self> {
        let snapshot = Snapshot::read(&find(&path.display().to_string())?.snapshot)?;
        let about = &snapshot.about;
        let race = Race::new(&about.env, &about.track, &about.vehicle, about.seed);
        let fly = |place| benchmark(Level::best(), &race, &about.track, &snapshot.network, place, &about.eval);
        let (fixed, flights) = fly(Place::Pad);
        let report = Report { fixed: Some(fixed), random: Some(fly(Place::Spline).0) };
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Flown { name, race, report, trace: flights.trace, snapshot })
    }
}
