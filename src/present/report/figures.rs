//! The figures and the traced flight of a run folder.

use crate::base::encode;
use crate::base::error::Result;
use crate::model::track::Track;
use crate::present::report::{lap, training};
use crate::present::run::Run;
use crate::present::run::evaluated::Evaluated;
use crate::race::eval::Report;
use crate::race::eval::fly::TraceStep;

/// Traced flight of the nominal vehicle from the pad.
pub const TRACE: &str = "lap.csv";
/// The same from above, and the learning curves.
pub const LAP: &str = "lap.svg";
pub const TRAINING: &str = "training.svg";

/// Writes `lap.csv` and `lap.svg`.
pub fn write_lap(run: &Run, track: &Track, trace: &[TraceStep], report: &Report) -> Result<()> {
    run.replace(TRACE, encode::csv("the flown lap", |csv| trace.iter().try_for_each(|moment| csv.serialize(moment)))?)?;
    run.replace(LAP, lap::svg(track, trace, &lap_title(track, report))?)?;
    Ok(())
}

/// What a lap is the lap of.
pub fn lap_title(track: &Track, report: &Report) -> String {
    let laps = report.fixed.as_ref().and_then(|f| Some((f.lap_time_s?.median, f.lap_completion)));
    match laps {
        Some((median, share)) => {
            format!("{}: median lap {median:.2} s, completed by {:.1} % of agents", track.name, 100.0 * share)
        }
        None => format!("{}: no lap completed", track.name),
    }
}

/// The learning curves: of each row minutes and gates an episode, of each snapshot its evaluation; `chosen` was kept.
pub fn training(title: &str, rows: &[[Option<f64>; 2]], snapshots: &[Evaluated], chosen: &str) -> Result<String> {
    let minutes = |seconds: f64| seconds / 60.0;
    let point =
        |row: &[Option<f64>; 2]| training::Point { minutes: minutes(row[0].unwrap_or_default()), gates: row[1] };
    let curve: Vec<_> = rows.iter().map(point).collect();
    let evaluated = |e: &Evaluated| training::SnapshotMark {
        minutes: minutes(e.seconds),
        fixed: e.report.completion(),
        random: e.report.random.as_ref().map_or(0.0, |random| random.lap_completion),
        chosen: e.snapshot == chosen,
    };
    training::svg(&curve, &snapshots.iter().map(evaluated).collect::<Vec<_>>(), title)
}
