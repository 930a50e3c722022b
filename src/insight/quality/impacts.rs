//! When the vehicle hits something.

use super::{LogFinding, Severity};
use crate::flight::Log;
use crate::flight::spans::{Span, around};
use crate::insight::criteria::usable::{CRASH_TAIL_S, IMPACT_FORCE, IMPACT_MARGIN_S};

/// Times around impacts; from the last ones to the end of the log where it ends soon after.
pub fn find(log: &Log, findings: &mut Vec<LogFinding>) -> Vec<Span> {
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
