//! When the vehicle flies: not on the ground, not hitting anything.

use super::{LogFinding, Severity};
use crate::base::stats::{mean, median};
use crate::flight::Log;
use crate::flight::series::held;
use crate::flight::spans::{Span, around, joined, length, without};
use crate::insight::criteria::usable::{
    CRASH_TAIL_S, END_MARGIN_S, IDLE_EFFORT, IMPACT_FORCE, IMPACT_MARGIN_S, LANDING_S, LOG_END_S, RESTING_S,
    STILL_FORCE, STILL_RATE, TAKE_OFF_MARGIN_S, TOUCH_DOWN_MARGIN_S,
};
use crate::model::constants::GRAVITY_M_S2;

/// Length over which standing still is judged, s.
const BIN_S: f64 = 0.1;

/// Times around impacts; from the last ones to the end of the log where it ends soon after.
pub fn impacts(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let imu = &log.imu;
    let most = IMPACT_FORCE.get();
    let hit = |i: usize| {
        let [.., x, y, z] = imu.rows[i];
        x.hypot(y) > most || z < -most
    };
    let mut holes = around(&imu.time_s, hit, IMPACT_MARGIN_S.get());
    let end = imu.time_s[imu.len() - 1];
    let crashed = holes.last_mut().filter(|last| end - last[1] < CRASH_TAIL_S.get());
    if let Some(last) = crashed {
        last[1] = end;
        let what = format!("impacts until the log ends at {end:.1} s");
        let so = "taken for a crash; nothing after it is used";
        findings.push(LogFinding::new(Severity::Warning, "crash", "imu", what, so).during(*last));
    }
    for hole in holes.iter().filter(|hole| hole[1] < end) {
        let what = format!("specific force beyond {most} m/s2 across the thrust");
        findings.push(LogFinding::new(Severity::Warning, "impact", "imu", what, "this time is left out").during(*hole));
    }
    holes
}

/// How hard the rotors work, any unit: their speed where it was measured, else the thrust command.
fn effort(log: &Log) -> Option<Vec<f64>> {
    let turning = log.rotors.rows.iter().any(|row| row.iter().any(|w| *w > 0.0));
    let (times, values) =
        if turning { (&log.rotors.time_s, log.rotors.means()) } else { (&log.setpoint.time_s, log.setpoint.column(3)) };
    let known = values.iter().any(|x: &f64| x.is_finite());
    known.then(|| held(times, &values, &log.imu.time_s))
}

/// Times at which the rotors do far less than carry the vehicle and yet it neither turns nor falls.
pub fn ground(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let imu = &log.imu;
    let Some(effort) = effort(log) else {
        let what = "no thrust command and no rotor speed: time on the ground cannot be told".into();
        findings.push(LogFinding::new(Severity::Note, "ground", "imu", what, "all of the log is taken for flight"));
        return Vec::new();
    };
    let mut bins: Vec<(Span, f64, bool)> = Vec::new();
    let mut first = 0;
    while first < imu.len() {
        let from = imu.time_s[first];
        let n = imu.time_s[first..].partition_point(|&t| t < from + BIN_S);
        let rows = &imu.rows[first..first + n];
        let norm = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turning = mean(&rows.iter().map(|row| norm(&row[..3])).collect::<Vec<_>>());
        let force = mean(&rows.iter().map(|row| norm(&row[3..])).collect::<Vec<_>>());
        let still = turning < STILL_RATE.get() && (force - GRAVITY_M_S2).abs() < STILL_FORCE.get();
        bins.push(([from, from + BIN_S], mean(&effort[first..first + n]), still));
        first += n;
    }
    let working: Vec<f64> = bins.iter().map(|bin| bin.1).filter(|x| *x > 0.0).collect();
    let usual = median(&working);
    let idle = |bin: &&(Span, f64, bool)| bin.2 && (bin.1.is_nan() || bin.1 < IDLE_EFFORT.get() * usual);
    // A knock or two while being placed does not make a flight.
    let bridged = |spans: Vec<Span>| {
        let wide = spans.iter().map(|s| [s[0] - BIN_S, s[1] + BIN_S]).collect();
        joined(wide).iter().map(|s| [s[0] + BIN_S, s[1] - BIN_S]).collect::<Vec<_>>()
    };
    let still = bridged(bins.iter().filter(idle).map(|bin| bin.0).collect());
    let (start, end) = (imu.time_s[0], imu.time_s[imu.len() - 1]);
    let near = LOG_END_S.get();
    let at_an_end = |s: &Span| s[0] <= start + near || s[1] >= end - near;
    let landed = |s: &Span| s[1] - s[0] >= if at_an_end(s) { RESTING_S.get() } else { LANDING_S.get() };
    let mut holes: Vec<Span> = still.into_iter().filter(landed).collect();
    for hole in &mut holes {
        *hole = [hole[0] - TOUCH_DOWN_MARGIN_S.get(), hole[1] + TAKE_OFF_MARGIN_S.get()];
        if hole[0] <= start + near {
            hole[0] = start;
        }
        if hole[1] >= end - near {
            hole[1] = end + BIN_S;
        }
    }
    let mut holes = joined(holes);
    for hole in &holes {
        let what = format!("{:.1} s on the ground", hole[1] - hole[0]);
        findings.push(LogFinding::new(Severity::Note, "ground", "imu", what, "this time is left out").during(*hole));
    }
    if length(&without([start, end], &holes)) == 0.0 {
        let what = "the vehicle never flies".into();
        findings.push(LogFinding::new(Severity::Problem, "ground", "imu", what, "nothing can be identified"));
    }
    holes.push([end - END_MARGIN_S.get(), end + BIN_S]);
    joined(holes)
}
