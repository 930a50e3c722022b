//! Sensors at the end of their range.

use super::{LogFinding, Severity};
use crate::flight::Log;
use crate::flight::spans::{Span, around};

const NAMES: [&str; 6] = ["rate x", "rate y", "rate z", "specific force x", "specific force y", "specific force z"];
/// So many equal samples in a row at a signal's largest size are clipping, not chance.
const RUN: usize = 5;
/// Below these sizes (rad/s, m/s2) nothing clips: a quiet quantised signal repeats itself too.
const LEAST: [f64; 2] = [8.0, 30.0];
const MARGIN_S: f64 = 0.1;

/// Times at which a rate or a specific force sits at its largest size.
pub fn find(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let imu = &log.imu;
    let mut holes = Vec::new();
    for (k, name) in NAMES.into_iter().enumerate() {
        let x = imu.column(k);
        for (sign, side) in [(1.0, "largest"), (-1.0, "smallest")] {
            let most = x.iter().map(|x| sign * x).fold(f64::NEG_INFINITY, f64::max);
            let at_end: Vec<bool> = x.iter().map(|x| sign * x == most).collect();
            let mut clipped = vec![false; x.len()];
            for end in RUN..=x.len() {
                if at_end[end - RUN..end].iter().all(|&at| at) {
                    clipped[end - RUN..end].fill(true);
                }
            }
            let spans = around(&imu.time_s, |i| clipped[i], MARGIN_S);
            if most < LEAST[k / 3] || spans.is_empty() {
                continue;
            }
            let what = format!("{name} stays at its {side} value, {:.1}, {} times", sign * most, spans.len());
            findings.push(LogFinding::new(Severity::Warning, "clipping", "imu", what, "these times are left out"));
            holes.extend(spans);
        }
    }
    holes
}
