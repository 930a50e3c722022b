//! One flight of a file: its header, and the wanted columns of its frames.

use super::decoder::{Decoder, Frame};
use super::definition::{Definition, Definitions};
use super::fields::{Field, PLANE, Recorded, Rows, of_inav, standard};
use super::header::Header;
use super::plane::Plane;
use super::tally::Tally;
use crate::base::check::BadInput;
use crate::base::document::nearest;
use crate::flight::table::{LOG_TIME, Table, Tables};
use crate::flight::{Readable, VehicleRecord};
use std::collections::{BTreeMap, BTreeSet};

const EVENT: [&str; 3] = ["event", "first", "second"];

pub struct Flight {
    pub tables: Tables,
    pub span_s: f64,
    /// What was left out, or is uncertain.
    pub remarks: Vec<String>,
}

/// Reads the (table, column) pairs that are `wanted`. Standard fields that were not recorded are NaN.
pub fn read(bytes: &[u8], place: &str, wanted: &BTreeSet<(&str, &str)>) -> Result<Flight, BadInput> {
    let bad =
        |found: String| BadInput::new(place, found, "a flight whose header declares its frames", "is it damaged?");
    let header = Header::of(bytes);
    if let Some(version) = header.text("Data version").filter(|version| *version != "2") {
        return Err(bad(format!("data version {version}, where all firmware since 2015 writes 2")));
    }
    let definitions = Definitions::of(&header).map_err(bad)?;
    let decoder = Decoder::new(bytes, &header, &definitions).map_err(bad)?;
    let select = |table: &str, definition| select(table, definition, &header, place, wanted);
    let mut main = Recorded::new(&definitions.intra, select("main", &definitions.intra)?);
    let mut gps = Recorded::new(&definitions.gps, select("gps", &definitions.gps)?);
    let mut slow = Recorded::new(&definitions.slow, select("slow", &definitions.slow)?);
    let mut events = Rows::new(EVENT.len());
    let mut plane = Plane::new(&definitions.gps);
    let tally = decoder.run(header.end, |time_us, frame| match frame {
        Frame::Main(frame) => main.push(time_us, frame),
        Frame::Gps(frame) => {
            gps.push(time_us, frame);
            plane.push(&definitions.gps, frame);
        }
        Frame::Slow(frame) => slow.push(time_us, frame),
        Frame::Event(event) => events.push(time_us, [event.kind.into(), event.first, event.second]),
    });
    let span_s = main.rows.span_s();
    let mut tables: BTreeMap<String, Table> = BTreeMap::from([("main".into(), main.table())]);
    tables.insert("events".into(), events.table(EVENT.map(String::from)));
    for (name, definition, mut table) in
        [("gps", &definitions.gps, gps.table()), ("slow", &definitions.slow, slow.table())]
    {
        if name == "gps" {
            let of_plane = [std::mem::take(&mut plane.east), std::mem::take(&mut plane.north)];
            table.columns.extend(PLANE.map(String::from).into_iter().zip(of_plane));
        }
        if !definition.names.is_empty() {
            tables.insert(name.into(), table);
        }
    }
    let vehicle = VehicleRecord { max_rate_rad_s: header.max_rates_rad_s(), ..VehicleRecord::default() };
    let remarks = remarks(&header, &tally);
    Ok(Flight { tables: Tables { tables, vehicle, readable: readable(&tally) }, span_s, remarks })
}

/// The fields of a frame that are wanted.
fn select(
    table: &str,
    definition: &Definition,
    header: &Header,
    place: &str,
    wanted: &BTreeSet<(&str, &str)>,
) -> Result<Vec<Field>, BadInput> {
    let known = || definition.names.iter().map(String::as_str);
    let position = |name: &str| known().position(|known| known == name);
    let mut fields = Vec::new();
    for (_, column) in wanted.iter().filter(|(source, _)| *source == table && !definition.names.is_empty()) {
        if *column == LOG_TIME || PLANE.contains(column) {
            continue;
        }
        let alias = of_inav(column).filter(|_| header.inav());
        match position(column).or_else(|| position(alias?)) {
            Some(index) => fields.push(Field::new(column, index, header, place)?),
            None if standard().any(|name| name == *column) => fields.push(Field::absent(column)),
            None => {
                let advice = match nearest(column, known()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => known().collect::<Vec<_>>().join(", "),
                };
                let found = format!("no field `{column}` in its {table} frames");
                return Err(BadInput::new(place, found, "the fields that the mapping names", advice));
            }
        }
    }
    Ok(fields)
}

fn readable(tally: &Tally) -> Readable {
    let prefix = |why: &str| Readable::Prefix { bytes: tally.end as u64, of: tally.content as u64, why: why.into() };
    match tally {
        Tally { crowded: true, .. } => prefix("its frames are shorter than any firmware writes"),
        Tally { closed: true, .. } => Readable::Whole,
        // Switched off in the air, or out of room.
        _ => prefix("the recording breaks off without its end-of-log event"),
    }
}

fn remarks(header: &Header, tally: &Tally) -> Vec<String> {
    let mut remarks = Vec::new();
    if tally.lost_bytes > 0 {
        let Tally { lost, lost_bytes, frames, .. } = tally;
        remarks.push(format!("damaged within: {lost} frames ({lost_bytes} bytes) are left out, {frames} are read"));
    }
    if header.damaged > 0 {
        remarks.push(format!("{} damaged lines of the header are left out", header.damaged));
    }
    if tally.homeless > 0 {
        remarks.push(format!("{} GPS frames before the first home position are left out", tally.homeless));
    }
    match header.firmware() {
        "Betaflight" => {}
        "" => remarks.push("its header names no firmware: units and signs are taken for Betaflight's".into()),
        other => {
            let other: String = other.chars().take(40).collect();
            remarks.push(format!("written by {other}: units and signs are taken for Betaflight's"));
        }
    }
    remarks
}
