//! The figures and the traced flight of a run folder.

use super::Run;
use super::metrics::Row;
use crate::eval::Report;
use crate::eval::fly::Moment;
use crate::report::{lap, training};
use crate::track::Track;

/// Traced flight of the nominal vehicle from the pad.
pub const TRACE: &str = "lap.csv";
/// The same from above, and the learning curves.
pub const LAP: &str = "lap.svg";
pub const TRAINING: &str = "training.svg";

/// Writes `lap.csv` and `lap.svg`.
pub fn write_lap(run: &Run, track: &Track, trace: &[Moment], report: &Report) -> anyhow::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    trace.iter().try_for_each(|moment| csv.serialize(moment))?;
    run.write(TRACE, csv.into_inner()?)?;
    let fixed = report.fixed.as_ref();
    let laps = fixed.and_then(|f| Some((f.lap_time_s?.median, f.lap_completion)));
    let title = match laps {
        Some((median, share)) => {
            format!("{}: median lap {median:.2} s, completed by {:.1} % of agents", track.name, 100.0 * share)
        }
        None => format!("{}: no lap completed", track.name),
    };
    run.write(LAP, lap::svg(track, trace, &title)?)?;
    Ok(())
}

/// Writes `training.svg`: `reports` of the snapshots taken at `seconds`, of which `chosen` was kept.
pub fn write_training(
    run: &Run,
    title: &str,
    rows: &[Row],
    seconds: &[f64],
    reports: &[Report],
    chosen: usize,
) -> anyhow::Result<()> {
    let minutes = |seconds: f64| seconds / 60.0;
    let curve: Vec<_> = rows
        .iter()
        .map(|row| training::Point {
            minutes: minutes(row.get("time/seconds").unwrap_or_default()),
            gates: row.get("episode/gates"),
        })
        .collect();
    let snapshots: Vec<_> = reports
        .iter()
        .zip(seconds)
        .enumerate()
        .map(|(i, (report, &seconds))| training::Evaluated {
            minutes: minutes(seconds),
            fixed: report.completion(),
            random: report.random.as_ref().map_or(0.0, |random| random.lap_completion),
            chosen: i == chosen,
        })
        .collect();
    run.write(TRAINING, training::svg(&curve, &snapshots, title)?)?;
    Ok(())
}
