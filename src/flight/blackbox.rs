//! Betaflight blackbox files: a header in text, then packed frames; several flights may follow each other.
//!
//! The table "main" has the fields of main frames under their own names, in rad/s, m/s2, V, A and, for throttle and motors, 0..1;
//! other fields as they are. "gps" has those of GPS frames, and `east` and `north` of the first of them, in m.

mod fields;
mod header;

use super::format::{Content, File, Format};
use super::mapping::Mapping;
use super::table::{LOG_TIME, Tables};
use super::{Readable, VehicleRecord};
use crate::base::check::BadInput;
use crate::base::document::nearest;
use blackbox_log::frame::FrameDef;
use blackbox_log::headers::Firmware;
use blackbox_log::{Headers, ParserEvent};
use fields::{Field, PLANE, Plane, Rows, STANDARD};
use header::Header;
use std::collections::{BTreeMap, BTreeSet};

/// A frame of more fields is not Betaflight's.
const MOST_FIELDS: usize = 256;

/// First line of every flight.
const MARKER: &[u8] = b"H Product:Blackbox flight data recorder by Nicholas Sherlock\n";

/// One of the flights of a file, decoded.
struct Flight {
    tables: Tables,
    span_s: f64,
}

/// Blackbox logs.
pub struct Blackbox;

impl Format for Blackbox {
    fn name(&self) -> &'static str {
        "Betaflight blackbox"
    }

    fn recognises(&self, file: &File) -> bool {
        let begun = b"H Product:Blackbox";
        file.start().windows(begun.len()).any(|window| window == begun) || file.ends(&[".bbl", ".bfl"])
    }

    fn mapping(&self, _: &File) -> Result<(&'static str, Option<String>), BadInput> {
        Ok(("betaflight", None))
    }

    fn tables(&self, file: &File, mapping: &Mapping) -> Result<Content, BadInput> {
        let (tables, remarks) = tables(file.bytes, file.name, &mapping.columns(), file.flight)?;
        Ok(Content { tables, remarks })
    }

    fn has_flights(&self) -> bool {
        true
    }
}

/// Reads `flight`, counted from 1, or else the longest: the (table, column) pairs that are `wanted`. Standard fields that
/// were not recorded are NaN. Also remarks about what was chosen. Fails where there is no such flight, or no such field.
pub fn tables(
    bytes: &[u8],
    name: &str,
    wanted: &BTreeSet<(&str, &str)>,
    flight: Option<usize>,
) -> Result<(Tables, Vec<String>), BadInput> {
    let flights = split(bytes);
    let count = flights.len();
    if count == 0 {
        return Err(BadInput::new(name, "no flight", "a Betaflight blackbox file", "is it the right file?"));
    }
    if let Some(flight) = flight {
        if !(1..=count).contains(&flight) {
            return Err(BadInput::new("--flight", flight, &format!("1 to {count}, which {name} has"), ""));
        }
        return Ok((read(flights[flight - 1], &format!("{name}, flight {flight}"), wanted)?.tables, Vec::new()));
    }
    let mut best: Option<(usize, Flight)> = None;
    let (mut failed, mut spans) = (None, Vec::new());
    for (index, bytes) in flights.into_iter().enumerate() {
        match read(bytes, &format!("{name}, flight {}", index + 1), wanted) {
            Ok(flight) => {
                spans.push(format!("{:.1} s", flight.span_s));
                if best.as_ref().is_none_or(|(_, best)| flight.span_s > best.span_s) {
                    best = Some((index, flight));
                }
            }
            Err(error) => {
                spans.push("unreadable".into());
                failed = failed.or(Some(error));
            }
        }
    }
    match (best, failed) {
        (Some((_, flight)), _) if count == 1 => Ok((flight.tables, Vec::new())),
        (Some((index, flight)), _) => {
            let remark =
                format!("flight {} of {count} ({}), the longest; --flight chooses", index + 1, spans.join(", "));
            Ok((flight.tables, vec![remark]))
        }
        (None, Some(error)) => Err(error),
        (None, None) => unreachable!("each flight is read or fails"),
    }
}

/// The bytes of each flight.
fn split(bytes: &[u8]) -> Vec<&[u8]> {
    let windows = bytes.windows(MARKER.len()).enumerate();
    let mut starts: Vec<usize> = windows.filter(|(_, window)| *window == MARKER).map(|(start, _)| start).collect();
    starts.push(bytes.len());
    starts.windows(2).map(|ends| &bytes[ends[0]..ends[1]]).collect()
}

fn read(bytes: &[u8], place: &str, wanted: &BTreeSet<(&str, &str)>) -> Result<Flight, BadInput> {
    let bad = |found: String| BadInput::new(place, found, "a flight of Betaflight 4.2 to 4.5 or INAV 5 to 8", "");
    let headers = match blackbox_log::File::new(bytes).parse(0) {
        Some(Ok(headers)) => headers,
        Some(Err(error)) => return Err(bad(error.to_string())),
        None => return Err(bad("nothing".into())),
    };
    let inav = matches!(headers.firmware(), Firmware::Inav(_));
    let header = Header::of(bytes, inav);
    let main = select("main", headers.main_frame_def(), &header, place, wanted)?;
    let gps = match headers.gps_frame_def() {
        Some(def) => select("gps", def, &header, place, wanted)?,
        None => Vec::new(),
    };
    Ok(decode(&headers, &main, &gps, &header, bytes))
}

/// The fields of a frame that are wanted.
fn select<'data, D: FrameDef<'data>>(
    table: &str,
    def: &D,
    header: &Header,
    place: &str,
    wanted: &BTreeSet<(&str, &str)>,
) -> Result<Vec<Field>, BadInput> {
    if def.len() > MOST_FIELDS {
        let found = format!("{} fields in a frame", def.len());
        return Err(BadInput::new(place, found, &format!("{MOST_FIELDS} at the most"), "is the file damaged?"));
    }
    let known: Vec<(&str, bool)> = def.iter().map(|field| (field.name, field.signed)).collect();
    let mut fields = Vec::new();
    for (_, column) in wanted.iter().filter(|(source, _)| *source == table) {
        if *column == LOG_TIME || PLANE.contains(column) {
            continue;
        }
        match known.iter().position(|(name, _)| name == column) {
            Some(index) => fields.push(Field::new(column, index, known[index].1, header, place)?),
            None if STANDARD.contains(column) => fields.push(Field::absent(column)),
            None => {
                let advice = match nearest(column, known.iter().map(|(name, _)| *name)) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => known.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "),
                };
                let found = format!("no field `{column}` in its {table} frames");
                return Err(BadInput::new(place, found, "the fields that the mapping names", advice));
            }
        }
    }
    Ok(fields)
}

fn decode(headers: &Headers, main: &[Field], gps: &[Field], header: &Header, bytes: &[u8]) -> Flight {
    let mut rows = Rows::new(main);
    let mut fixes = Rows::new(gps);
    let mut plane = headers.gps_frame_def().map(Plane::new);
    let mut parser = headers.data_parser();
    while let Some(event) = parser.next() {
        match event {
            ParserEvent::Main(frame) => rows.push(frame.time_raw(), main, &frame),
            ParserEvent::Gps(frame) => {
                fixes.push(frame.time_raw(), gps, &frame);
                if let Some(plane) = &mut plane {
                    plane.push(&frame);
                }
            }
            ParserEvent::Event(_) | ParserEvent::Slow(_) => {}
        }
    }
    // A flight that was switched off in the air has no end-of-log event. The library misses the event before padding.
    let content = bytes.iter().rposition(|byte| ![0, 0xff].contains(byte)).map_or(0, |last| last + 1);
    let readable = if parser.is_done() || bytes[..content].ends_with(b"End of log") {
        Readable::Whole
    } else {
        let of = bytes.len() as u64;
        Readable::Prefix { bytes: of, of, why: "the recording breaks off without its end-of-log event".into() }
    };
    let span_s = rows.span_s();
    let mut tables = BTreeMap::from([("main".to_string(), rows.table(main))]);
    if let Some(Plane { east, north, .. }) = plane {
        let mut table = fixes.table(gps);
        table.columns.extend(PLANE.map(String::from).into_iter().zip([east, north]));
        tables.insert("gps".into(), table);
    }
    let vehicle = VehicleRecord { mass_kg: None, max_rate_rad_s: header.max_rates_rad_s() };
    Flight { tables: Tables { tables, vehicle, readable }, span_s }
}
