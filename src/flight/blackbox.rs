//! Blackbox files of Betaflight and its relatives: a header in text, then packed frames; several flights may follow
//! each other. Everything is read by what the header declares, whatever firmware it names.
//!
//! The table "main" has the fields of main frames under their own names, in rad/s, m/s2, V, A and, for throttle and
//! motors, 0..1 from stop to full, eRPM of the rotor in rad/s; other fields as they are. "gps" has those of GPS frames,
//! `east` and `north` of the first of them in m, and `velocity_east`, `velocity_north` and `velocity_up` in m/s.
//! "attitude" has `qw` to `qz`, front-left-up to east-north-up, where it was logged. "states" has `armed`, "slow" has
//! flight modes and the like, "events" the number of each [`event::Event`] and what it says.

mod armed;
mod attitude;
mod bytes;
pub mod decoded;
pub mod decoder;
pub mod definition;
mod encoding;
pub mod event;
mod fields;
mod fixes;
mod flight;
pub mod header;
mod predictor;
mod scales;
mod sequence;
pub mod tally;

use super::format::{Content, FlightSummary, Format, LogFile};
use super::mapping::Mapping;
use crate::base::check::BadInput;
use flight::BlackboxFlight;
use std::collections::BTreeSet;

/// How every flight begins.
const MARKER: &[u8] = b"H Product:Blackbox";

/// Blackbox logs.
pub struct Blackbox;

impl Format for Blackbox {
    fn name(&self) -> &'static str {
        "Betaflight blackbox"
    }

    fn recognises(&self, file: &LogFile) -> bool {
        file.start().windows(MARKER.len()).any(|window| window == MARKER) || file.ends(&[".bbl", ".bfl"])
    }

    fn mapping(&self, _: &LogFile) -> Result<(&'static str, Option<String>), BadInput> {
        Ok(("betaflight", None))
    }

    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput> {
        content(file.bytes, file.name, &mapping.columns(), file.flight)
    }

    fn has_flights(&self) -> bool {
        true
    }
}

/// Reads `flight`, counted from 1, or else the longest: the (table, column) pairs that are `wanted`. Standard fields
/// that were not recorded are NaN. Also remarks about what was chosen, left out or is uncertain. Fails where there is
/// no such flight, or no such field.
fn content(
    bytes: &[u8],
    name: &str,
    wanted: &BTreeSet<(&str, &str)>,
    flight: Option<usize>,
) -> Result<Content, BadInput> {
    let flights = split(bytes);
    let count = flights.len();
    let place = |index: usize| format!("{name}, flight {}", index + 1);
    match flight {
        _ if count == 0 => Err(BadInput::new(name, "no flight", "a Betaflight blackbox file", "is it the right file?")),
        None => longest(&flights, |index, bytes| flight::read(bytes, &place(index), wanted)),
        Some(number) => match number.checked_sub(1).and_then(|index| Some((index, flights.get(index)?))) {
            Some((index, bytes)) => {
                let flight = flight::read(bytes, &place(index), wanted)?;
                Ok(Content { tables: flight.tables, remarks: flight.remarks, flights: Vec::new() })
            }
            None => Err(BadInput::new("--flight", number, &format!("1 to {count}, which {name} has"), "")),
        },
    }
}

/// The longest flight that can be read, and what was chosen from.
fn longest(
    flights: &[&[u8]],
    read: impl Fn(usize, &[u8]) -> Result<BlackboxFlight, BadInput>,
) -> Result<Content, BadInput> {
    /// More would only hide the rest of the message.
    const MOST: usize = 20;
    let mut best: Option<(usize, BlackboxFlight)> = None;
    let (mut failed, mut spans, mut found) = (None, Vec::new(), Vec::new());
    for (index, bytes) in flights.iter().enumerate() {
        match read(index, bytes) {
            Ok(flight) => {
                found.push(flight.summary(index + 1));
                spans.push(format!("{:.1} s", flight.span_s));
                if best.as_ref().is_none_or(|(_, best)| flight.span_s > best.span_s) {
                    best = Some((index, flight));
                }
            }
            Err(error) => {
                spans.push("unreadable".into());
                let end = format!("cannot be read: {}", error.found);
                found.push(FlightSummary { number: index + 1, start_s: None, span_s: 0.0, end });
                failed = failed.or(Some(error));
            }
        }
    }
    let Some((index, flight)) = best else { return Err(failed.expect("each flight is read or fails")) };
    let mut remarks = flight.remarks;
    if flights.len() > 1 {
        let more = if spans.len() > MOST { format!(", and {} more", spans.len() - MOST) } else { String::new() };
        spans.truncate(MOST);
        let (number, count) = (index + 1, flights.len());
        let chosen = format!("flight {number} of {count} ({}{more}), the longest; --flight chooses", spans.join(", "));
        remarks.insert(0, chosen);
    }
    let flights = if flights.len() > 1 { found } else { Vec::new() };
    Ok(Content { tables: flight.tables, remarks, flights })
}

/// The bytes of each flight.
pub fn split(bytes: &[u8]) -> Vec<&[u8]> {
    let windows = bytes.windows(MARKER.len()).enumerate();
    let mut starts: Vec<usize> = windows.filter(|(_, window)| *window == MARKER).map(|(start, _)| start).collect();
    starts.push(bytes.len());
    starts.windows(2).map(|ends| &bytes[ends[0]..ends[1]]).collect()
}
