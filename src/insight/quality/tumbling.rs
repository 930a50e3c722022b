//! Turning that nobody asked for: a vehicle thrown into the air, bumped or out of control. No model of its response
//! describes that.

use super::{LogFinding, Severity};
use crate::flight::Log;
use crate::flight::series::held;
use crate::flight::spans::{Span, around, length};
use crate::insight::criteria::usable::{
    COMMAND_MEMORY_S, TUMBLING_MARGIN_S, TUMBLING_SHARE, TUMBLING_TIMES, UNASKED_RATE, UNASKED_SHARE,
};

/// Times at which a body rate is far outside the range of its recent commands.
pub fn find(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let times = &log.imu.time_s;
    let (beyond, share) = (UNASKED_RATE.get(), UNASKED_SHARE.get());
    let mut loose = vec![false; times.len()];
    for axis in 0..3 {
        let asked = held(&log.setpoint.time_s, &log.setpoint.column(axis), times);
        let [low, high] = [-1.0, 1.0].map(|sign| largest(times, &asked.iter().map(|x| sign * x).collect::<Vec<_>>()));
        for i in 0..times.len() {
            let (low, high, rate) = (-low[i], high[i], log.imu.rows[i][axis]);
            let far = (share * (high - low)).max(beyond);
            loose[i] |= rate > high.max(0.0) + far || rate < low.min(0.0) - far;
        }
    }
    let holes = around(times, |i| loose[i], TUMBLING_MARGIN_S.get());
    if length(&holes) > TUMBLING_SHARE.get() * (times[times.len() - 1] - times[0])
        || holes.len() > TUMBLING_TIMES.count()
    {
        let what =
            format!("it turns {} times as no command of the {} s before asked", holes.len(), COMMAND_MEMORY_S.get());
        let did = "nothing is left out; their clocks may run apart, or the mapping may be wrong";
        findings.push(LogFinding::new(Severity::Note, "tumbling", "setpoint", what, did));
        return Vec::new();
    }
    for hole in &holes {
        let what = "it turns as no command asked: thrown, bumped or out of control".into();
        findings.push(LogFinding::new(Severity::Note, "tumbling", "imu", what, "this time is left out").during(*hole));
    }
    holes
}

/// Largest of `x` over the last [`COMMAND_MEMORY_S`]; NaN counts as nothing, and where there is nothing else no rate is
/// too large.
fn largest(times: &[f64], x: &[f64]) -> Vec<f64> {
    let memory_s = COMMAND_MEMORY_S.get();
    let mut queue = std::collections::VecDeque::<usize>::new();
    let mut out = Vec::with_capacity(x.len());
    for i in 0..x.len() {
        while queue.front().is_some_and(|&old| times[old] < times[i] - memory_s) {
            queue.pop_front();
        }
        if x[i].is_finite() {
            while queue.back().is_some_and(|&last| x[last] <= x[i]) {
                queue.pop_back();
            }
            queue.push_back(i);
        }
        out.push(queue.front().map_or(f64::INFINITY, |&most| x[most]));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten seconds at 100 Hz: a late, overshooting answer is a response; a turn against the stick is not.
    #[test]
    fn a_late_response_is_none_of_it() {
        let mut log = Log::default();
        for i in 0..1000 {
            let t = 0.01 * i as f64;
            let asked = if (2.0..2.5).contains(&t) { 10.0 } else { 0.0 };
            let mut rate = if (2.1..2.7).contains(&t) { 13.0 } else { 0.0 };
            if (6.0..6.2).contains(&t) {
                rate = -9.0;
            }
            log.setpoint.push(t, [asked, 0.0, 0.0, 0.5]);
            log.imu.push(t, [rate, 0.0, 0.0, 0.0, 0.0, crate::model::constants::GRAVITY_M_S2]);
        }
        let mut findings = Vec::new();
        let holes = find(&log, &mut findings);
        assert_eq!(holes.len(), 1, "{holes:?}");
        assert!((holes[0][0] - 5.7).abs() < 0.02 && (holes[0][1] - 6.49).abs() < 0.02, "{holes:?}");
        assert_eq!(findings.len(), 1);
        log.setpoint = Default::default();
        assert!(find(&log, &mut findings).is_empty(), "no command, no contradiction");
    }
}
