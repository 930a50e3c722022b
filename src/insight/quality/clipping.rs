//! Sensors at the end of their range.

use super::{LogFinding, Severity};
use crate::flight::Log;
use crate::flight::spans::{Span, around};
use crate::insight::criteria::usable::{CLIPPED_FORCE, CLIPPED_RATE, CLIPPED_RUN, CLIPPING_MARGIN_S};

const NAMES: [&str; 6] = ["rate x", "rate y", "rate z", "specific force x", "specific force y", "specific force z"];

/// Times at which a rate or a specific force sits at its largest size.
pub fn find(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
    let imu = &log.imu;
    let run = CLIPPED_RUN.count();
    let least = [CLIPPED_RATE.get(), CLIPPED_FORCE.get()];
    let mut holes = Vec::new();
    for (k, name) in NAMES.into_iter().enumerate() {
        let x = imu.column(k);
        for (sign, side) in [(1.0, "largest"), (-1.0, "smallest")] {
            let most = x.iter().map(|x| sign * x).fold(f64::NEG_INFINITY, f64::max);
            let at_end: Vec<bool> = x.iter().map(|x| sign * x == most).collect();
            let mut clipped = vec![false; x.len()];
            for end in run..=x.len() {
                if at_end[end - run..end].iter().all(|&at| at) {
                    clipped[end - run..end].fill(true);
                }
            }
            let spans = around(&imu.time_s, |i| clipped[i], CLIPPING_MARGIN_S.get());
            if most < least[k / 3] || spans.is_empty() {
                continue;
            }
            let what = format!("{name} stays at its {side} value, {:.1}, {} times", sign * most, spans.len());
            findings.push(LogFinding::new(Severity::Warning, "clipping", "imu", what, "these times are left out"));
            holes.extend(spans);
        }
    }
    holes
}
