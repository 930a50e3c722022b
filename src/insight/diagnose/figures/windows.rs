//! Where in the flight a channel is predicted worst, and how wrong it is over all of it.

use crate::flight::series::period;
use crate::insight::diagnose::prediction::problem::{Problem, ResidualRow};
use std::ops::Range;

/// Length of a stretch that is shown, s, and how many are.
pub const SHOWN_S: f64 = 2.0;
const MOST: usize = 3;
/// Errors over the flight are averaged over this, s.
const EVERY_S: f64 = 1.0;

/// Rows without a gap, with the time between them, s.
pub struct UnbrokenRows {
    pub rows: Range<usize>,
    pub period: f64,
}

/// A stretch of time.
pub struct Window {
    /// ModelNumber of the flight; none where there is only one.
    pub flight: Option<usize>,
    /// On the clock that runs through all flights, s.
    pub clock: [f64; 2],
    /// Seconds since the beginning of the flight, measured, predicted before and after.
    pub points: Vec<[f64; 4]>,
}

/// Root mean squares of the residual: pieces without a gap, of points of clock (s), before, after.
pub struct Errors {
    pub pieces: Vec<Vec<[f64; 3]>>,
    /// The stretches shown, on the same clock.
    pub marks: Vec<[f64; 2]>,
    pub end_s: f64,
}

/// Rows of channel `c` by runs.
pub fn runs(problem: &Problem, c: usize) -> Vec<UnbrokenRows> {
    let rows = &problem.rows[c];
    let time = |row: &ResidualRow| problem.records[row.flight as usize].time[row.sample as usize];
    let mut out = Vec::new();
    for flight in rows.chunk_by(|a, b| a.flight == b.flight) {
        let usual = period(&flight.iter().map(time).collect::<Vec<_>>());
        let neighbours = |a: &ResidualRow, b: &ResidualRow| b.follows && time(b) - time(a) < 1.7 * usual;
        for run in flight.chunk_by(neighbours) {
            let from = out.last().map_or(0, |last: &UnbrokenRows| last.rows.end);
            out.push(UnbrokenRows { rows: from..from + run.len(), period: usual });
        }
    }
    out
}

/// The worst stretches by the first of the `residuals`, that do not overlap.
pub fn worst(problem: &Problem, c: usize, runs: &[UnbrokenRows], residuals: [&[f64]; 2]) -> Vec<Window> {
    let mut scored: Vec<(f64, Range<usize>)> = Vec::new();
    for run in runs {
        let n = ((SHOWN_S / run.period).round() as usize).clamp(2, run.rows.len().max(2));
        let squares: Vec<f64> = residuals[0][run.rows.clone()].iter().map(|r| r * r).collect();
        let windows = squares.windows(n).enumerate();
        // Short runs count for less: what is shown should be a stretch of time, not a moment.
        scored.extend(windows.map(|(i, w)| {
            let from = run.rows.start + i;
            (w.iter().sum::<f64>() * run.period, from..from + n)
        }));
    }
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut taken: Vec<Range<usize>> = Vec::new();
    for (_, rows) in scored {
        if taken.len() < MOST && taken.iter().all(|t| t.end <= rows.start || rows.end <= t.start) {
            taken.push(rows);
        }
    }
    taken.into_iter().map(|rows| window(problem, c, rows, residuals)).collect()
}

fn window(problem: &Problem, c: usize, rows: Range<usize>, residuals: [&[f64]; 2]) -> Window {
    let flight = problem.rows[c][rows.start].flight as usize;
    let record = &problem.records[flight];
    let point = |i: usize| {
        let measured = problem.measured[c][i];
        let since = record.time[problem.rows[c][i].sample as usize] - record.time[0];
        [since, measured, measured - residuals[0][i], measured - residuals[1][i]]
    };
    let points: Vec<[f64; 4]> = rows.map(point).collect();
    let begin = problem.clocks()[flight];
    let clock = [begin + points[0][0], begin + points[points.len() - 1][0]];
    Window { flight: (problem.records.len() > 1).then_some(flight + 1), clock, points }
}

/// Both residuals of channel `c` over all flights, joined end to end.
pub fn errors(problem: &Problem, c: usize, windows: &[Window], residuals: [&[f64]; 2]) -> Errors {
    let begins = problem.clocks();
    let rows = &problem.rows[c];
    let clock = |i: usize| {
        let (flight, record) = (rows[i].flight as usize, &problem.records[rows[i].flight as usize]);
        begins[flight] + record.time[rows[i].sample as usize] - record.time[0]
    };
    let all: Vec<usize> = (0..rows.len()).collect();
    let second = |i: usize| (clock(i) / EVERY_S).floor();
    let points = all.chunk_by(|a, b| second(*a) == second(*b)).map(|chunk| {
        let rms = |r: &[f64]| (chunk.iter().map(|&i| r[i] * r[i]).sum::<f64>() / chunk.len() as f64).sqrt();
        [(second(chunk[0]) + 0.5) * EVERY_S, rms(residuals[0]), rms(residuals[1])]
    });
    let points: Vec<[f64; 3]> = points.collect();
    let pieces = points.chunk_by(|a, b| b[0] - a[0] < 1.5 * EVERY_S).map(<[_]>::to_vec).collect();
    let last = problem.records.last().and_then(|r| Some(r.time.last()? - r.time[0])).unwrap_or(0.0);
    let end_s = begins.last().map_or(0.0, |begin| begin + last);
    Errors { pieces, marks: windows.iter().map(|w| w.clock).collect(), end_s }
}
