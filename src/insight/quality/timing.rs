//! Time stamps: order, repetition, gaps; and rows that only repeat the one before.

use super::{LogFinding, Severity, StreamSummary};
use crate::flight::series::period;
use crate::flight::spans::{Span, joined};
use crate::flight::{Log, Stream};
use crate::insight::criteria::usable::{BRIDGED_S, GAP_PERIODS, HELD_ROWS};

/// Rows beyond this number of gaps are told as one.
const GAPS_TOLD: usize = 5;

/// Every stream in ascending time; of rows that repeat the one before in a stream that mostly does, the first.
pub fn repair(log: &Log, findings: &mut Vec<LogFinding>) -> (Log, Vec<StreamSummary>) {
    let mut out = log.clone();
    let mut summaries = Vec::new();
    let mut each = |stream: Option<StreamSummary>| summaries.extend(stream);
    each(mend("setpoint", &mut out.setpoint, false, findings));
    each(mend("imu", &mut out.imu, false, findings));
    each(mend("odometry", &mut out.odometry, true, findings));
    each(mend("battery", &mut out.battery, false, findings));
    each(mend("rotors", &mut out.rotors, false, findings));
    each(mend("motors", &mut out.motors, false, findings));
    each(mend("states", &mut out.states, false, findings));
    (out, summaries)
}

fn mend<const N: usize>(
    name: &'static str,
    stream: &mut Stream<N>,
    thin: bool,
    findings: &mut Vec<LogFinding>,
) -> Option<StreamSummary> {
    let samples = stream.len();
    let mut last = f64::NEG_INFINITY;
    let (mut kept, mut backward, mut repeated, mut unreadable) = (Stream::default(), 0, 0, 0);
    for (&t, row) in stream.time_s.iter().zip(&stream.rows) {
        match t {
            t if !t.is_finite() => unreadable += 1,
            t if t == last => repeated += 1,
            t if t < last => backward += 1,
            t => {
                last = t;
                kept.push(t, *row);
            }
        }
    }
    for (count, what) in [
        (unreadable, "without a time"),
        (repeated, "with the time of the one before"),
        (backward, "that go back in time"),
    ] {
        if count > 0 {
            let what = format!("{count} of {samples} rows {what}");
            findings.push(LogFinding::new(Severity::Warning, "time_stamps", name, what, "these rows are left out"));
        }
    }
    let same = |a: &[f64; N], b: &[f64; N]| a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan());
    let fresh = |i: usize| i == 0 || !same(&kept.rows[i], &kept.rows[i - 1]);
    let fresh_rows: Vec<usize> = (0..kept.len()).filter(|&i| fresh(i)).collect();
    let share = fresh_rows.len() as f64 / kept.len().max(1) as f64;
    let summary = StreamSummary {
        stream: name,
        samples,
        rate_hz: kept
            .time_s
            .first()
            .zip(kept.time_s.last())
            .filter(|(first, last)| last > first)
            .map(|(first, last)| (kept.len() - 1) as f64 / (last - first)),
        fresh: share,
        span_s: kept.time_s.first().zip(kept.time_s.last()).map(|(&first, &last)| [first, last]),
    };
    if thin && !kept.is_empty() && share < HELD_ROWS.get() {
        let what = format!("only {:.0} % of the rows are fresh, the others repeat the one before", 100.0 * share);
        findings.push(LogFinding::new(Severity::Note, "held_samples", name, what, "only fresh rows are used"));
        kept = Stream {
            time_s: fresh_rows.iter().map(|&i| kept.time_s[i]).collect(),
            rows: fresh_rows.iter().map(|&i| kept.rows[i]).collect(),
        };
    }
    *stream = kept;
    (samples > 0).then_some(summary)
}

/// Times without IMU or, where there are commands, without them.
pub fn gaps(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let mut holes = of("imu", &log.imu.time_s, findings);
    if let (Some(&first), Some(&last)) = (log.setpoint.time_s.first(), log.setpoint.time_s.last()) {
        holes.extend(of("setpoint", &log.setpoint.time_s, findings));
        holes.extend([[f64::NEG_INFINITY, first], [last + BRIDGED_S.get(), f64::INFINITY]]);
    }
    joined(holes)
}

fn of(name: &'static str, times: &[f64], findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let longest = (GAP_PERIODS.get() * period(times)).max(BRIDGED_S.get());
    let gaps: Vec<Span> = times.windows(2).filter(|pair| pair[1] - pair[0] > longest).map(|p| [p[0], p[1]]).collect();
    let so = "this time is left out";
    for gap in gaps.iter().take(GAPS_TOLD) {
        let what = format!("no sample for {:.2} s", gap[1] - gap[0]);
        findings.push(LogFinding::new(Severity::Warning, "gap", name, what, so).during(*gap));
    }
    if let Some(rest) = gaps.get(GAPS_TOLD..).filter(|rest| !rest.is_empty()) {
        let total: f64 = rest.iter().map(|gap| gap[1] - gap[0]).sum();
        let what = format!("{} more gaps, {total:.1} s in all", rest.len());
        findings.push(LogFinding::new(Severity::Warning, "gap", name, what, so));
    }
    gaps
}
