//! A log's check as text.

use super::columns::table;
use crate::flight::spans::length;
use crate::flight::{FlightSummary, Log};
use crate::insight::quality::{LogFinding, ParameterCoverage, Quality, Severity, StreamSummary};

/// What the log holds, stream by stream.
pub fn streams(streams: &[StreamSummary]) -> String {
    let number = |value: Option<f64>, digits: usize| value.map_or("-".into(), |v| format!("{v:.digits$}"));
    let row = |s: &StreamSummary| {
        vec![
            s.stream.to_string(),
            s.samples.to_string(),
            number(s.rate_hz, 0),
            format!("{:.0} %", 100.0 * s.fresh),
            number(s.span_s.map(|s| s[0]), 1),
            number(s.span_s.map(|s| s[1]), 1),
        ]
    };
    let header = ["stream", "samples", "rate, Hz", "fresh", "from, s", "to, s"];
    table(&header, streams.iter().map(row).collect(), 1..6)
}

/// A line for each of several flights; nothing where there is one.
pub fn flights(flights: &[FlightSummary]) -> String {
    let row = |flight: &FlightSummary| {
        let start = flight.start_s.map_or("-".into(), |start| format!("{start:.1}"));
        vec![flight.number.to_string(), start, format!("{:.1}", flight.span_s), flight.end.clone()]
    };
    let header = ["--flight", "starts, s", "length, s", "ended by"];
    if flights.is_empty() { String::new() } else { table(&header, flights.iter().map(row).collect(), 0..3) + "\n\n" }
}

/// The findings, the worst first.
pub fn findings(findings: &[LogFinding]) -> String {
    if findings.is_empty() {
        return "nothing wrong was found".into();
    }
    let line = |f: &LogFinding| {
        let severity = match f.severity {
            Severity::Problem => "PROBLEM",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let when = f.span_s.map_or(String::new(), |[from, to]| format!(" at {from:.1} to {to:.1} s"));
        format!("{severity:<8} {}{when}: {}; {}", f.stream, f.what, f.so)
    };
    findings.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What the log can and cannot tell.
pub fn told(parameters: &[ParameterCoverage]) -> String {
    let row = |p: &ParameterCoverage| {
        vec![p.name.to_string(), p.why_not.clone().map_or("yes".into(), |why| format!("no: {why}"))]
    };
    table(&["parameter", "can be told"], parameters.iter().map(row).collect(), 0..0)
}

/// Usable time out of all time, as a sentence.
pub fn usable(log: &Log, quality: &Quality) -> String {
    let times = &log.imu.time_s;
    let whole = times.first().zip(times.last()).map_or(0.0, |(first, last)| last - first);
    format!("{:.1} of {whole:.1} s are usable flight", length(&quality.usable))
}
