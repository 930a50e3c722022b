//! Velocities that no vehicle could have reached, such as a glitch of motion capture.

use super::{LogFinding, Severity};
use crate::base::stats::median;
use crate::flight::Log;
use crate::insight::criteria::usable::{VELOCITY_ACCELERATION, VELOCITY_JUMP_M_S};

/// Counts velocities far from the median of the five around them. Fits are robust against them.
pub fn count(log: &Log, findings: &mut Vec<LogFinding>) {
    let (times, rows) = (&log.odometry.time_s, &log.odometry.rows);
    let (jump, most) = (VELOCITY_JUMP_M_S.get(), VELOCITY_ACCELERATION.get());
    let off = |i: usize, k: usize| {
        let around: Vec<f64> = rows[i - 2..=i + 2].iter().map(|row| row[k]).collect();
        (rows[i][k] - median(&around)).abs() > jump + most * (times[i] - times[i - 1])
    };
    let jumps = (2..rows.len().saturating_sub(2)).filter(|&i| (7..10).any(|k| off(i, k))).count();
    if jumps > 0 {
        let what = format!("{jumps} velocity samples that no vehicle could reach from those around them");
        findings.push(LogFinding::new(
            Severity::Note,
            "outliers",
            "odometry",
            what,
            "they weigh little: fits are robust",
        ));
    }
}
