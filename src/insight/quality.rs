//! What is wrong with a log, what that prevents, and what is left to work with.

mod clipping;
mod coverage;
mod ground;
mod impacts;
mod mounting;
mod offset;
mod outliers;
mod signs;
mod timing;
pub mod together;
mod tumbling;

pub use coverage::ParameterCoverage;

use crate::flight::spans::{self, Span};
use crate::flight::{Log, Readable, VehicleKind};
use crate::insight::criteria::usable::SHORTEST_FLIGHT_S;
use serde::Serialize;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Handled without loss.
    Note,
    /// Part of the log is not used.
    Warning,
    /// Results would be wrong or are impossible.
    Problem,
}

/// Something about a log that a user should know.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LogFinding {
    /// How bad it is.
    pub severity: Severity,
    /// What kind of finding, such as `gap`.
    pub kind: &'static str,
    /// Which stream, such as `imu`.
    pub stream: &'static str,
    /// When, s since the start of the log; none where it holds throughout.
    pub span_s: Option<Span>,
    /// What was found.
    pub what: String,
    /// What it prevents, and what is done about it.
    pub so: String,
}

/// One stream in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StreamSummary {
    /// Which stream, such as `imu`.
    pub stream: &'static str,
    /// How many there are.
    pub samples: usize,
    /// Mean rate, 1/s.
    pub rate_hz: Option<f64>,
    /// Share of the samples that differ from the one before.
    pub fresh: f64,
    /// First and last, s since the start of the log.
    pub span_s: Option<Span>,
}

/// A checked log.
#[derive(Clone, Debug)]
pub struct Quality {
    /// The log with time ascending in every stream, repeated rows gone and clocks aligned.
    pub log: Log,
    /// What each stream holds.
    pub streams: Vec<StreamSummary>,
    /// By how much the odometry's clock was moved to the IMU's, s.
    pub moved_s: f64,
    /// The worst first.
    pub findings: Vec<LogFinding>,
    /// When the vehicle flies, undamaged and within its sensors' ranges.
    pub usable: Vec<Span>,
    /// What the log can tell, in the order of the model's equations.
    pub parameters: Vec<ParameterCoverage>,
}

impl LogFinding {
    /// A finding that holds throughout.
    pub fn new(severity: Severity, kind: &'static str, stream: &'static str, what: String, so: &str) -> Self {
        Self { severity, kind, stream, span_s: None, what, so: so.into() }
    }

    /// The same, but only then.
    pub fn during(mut self, span: Span) -> Self {
        self.span_s = Some(span);
        self
    }
}

impl Quality {
    /// What stops identification: the worst that contradicts itself, or is no flight of a multirotor. Damage of the
    /// file does not.
    pub fn problem(&self) -> Option<&LogFinding> {
        self.findings.iter().find(|finding| finding.severity == Severity::Problem && finding.stream != "file")
    }
}

/// The finding where nothing is left to work with.
fn no_flight() -> LogFinding {
    let what = format!("no {} s of usable flight in one piece", SHORTEST_FLIGHT_S.get());
    LogFinding::new(Severity::Problem, "no_flight", "imu", what, "nothing can be identified")
}

/// A finding where the vehicle is none that the models are of.
fn of_another_kind(kind: VehicleKind) -> Option<LogFinding> {
    let what = format!("the vehicle is a {}", kind.name().replace('_', " "));
    let what = if kind == VehicleKind::Other { "the vehicle is no multirotor".into() } else { what };
    let so = "models here are of multirotors: nothing of it can be identified";
    (kind != VehicleKind::Multirotor).then(|| LogFinding::new(Severity::Problem, "vehicle_kind", "vehicle", what, so))
}

/// Checks, and repairs what can be repaired. Never fails: a log with nothing usable says so.
pub fn check(log: &Log) -> Quality {
    let mut findings = Vec::new();
    if let Readable::Prefix { bytes, of, why } = &log.readable {
        let share = 100.0 * *bytes as f64 / (*of).max(1) as f64;
        let last = log.imu.time_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let until = if last.is_finite() { format!(", {last:.1} s of flight time") } else { String::new() };
        let what = format!("readable up to byte {bytes} of {of} ({share:.0} %){until}: {why}");
        findings.push(LogFinding::new(Severity::Problem, "damaged_file", "file", what, "what comes after is lost"));
    }
    findings.extend(log.vehicle.kind.and_then(of_another_kind));
    let (mut log, streams) = timing::repair(log, &mut findings);
    if log.imu.is_empty() {
        findings.push(LogFinding::new(
            Severity::Problem,
            "no_imu",
            "imu",
            "no angular velocity and no specific force".into(),
            "nothing can be identified",
        ));
        let parameters = coverage::told(&log, &[]);
        return Quality { log, streams, moved_s: 0.0, findings, usable: Vec::new(), parameters };
    }
    let moved_s = offset::align(&mut log, &mut findings);
    let mut holes = timing::gaps(&log, &mut findings);
    holes.extend(impacts::find(&log, &mut findings));
    holes.extend(ground::find(&log, &mut findings));
    holes.extend(clipping::find(&log, &mut findings));
    holes.extend(tumbling::find(&log, &mut findings));
    let times = &log.imu.time_s;
    let mut usable = spans::without([times[0], times[times.len() - 1]], &holes);
    usable.retain(|span| span[1] - span[0] >= SHORTEST_FLIGHT_S.get());
    if usable.is_empty() {
        findings.push(no_flight());
    }
    signs::judge(&log, &usable, &mut findings);
    mounting::find(&log, &usable, &mut findings);
    outliers::count(&log, &mut findings);
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    let parameters = coverage::told(&log, &usable);
    Quality { log, streams, moved_s, findings, usable, parameters }
}
