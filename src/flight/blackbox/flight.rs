//! One flight of a file: its header, and the wanted columns of its frames.

use super::armed::Armed;
use super::attitude::Attitude;
use super::decoder::{DecodedFrame, FrameDecoder};
use super::definition::{Definitions, FrameDefinition};
use super::fields::{GrowingRows, Recorded, ScaledField, further_motor, of_inav, standard};
use super::fixes::{DERIVED, Fixes, Places};
use super::header::Header;
use super::tally::ByteTally;
use crate::base::check::BadInput;
use crate::base::document::nearest;
use crate::flight::format::FlightSummary;
use crate::flight::table::{LOG_TIME, Table, Tables};
use crate::flight::{Readable, VehicleRecord};
use std::collections::{BTreeMap, BTreeSet};

const EVENT: [&str; 3] = ["event", "first", "second"];

pub struct BlackboxFlight {
    pub tables: Tables,
    pub span_s: f64,
    /// Time of its first main frame.
    start_s: Option<f64>,
    /// What ends it.
    end: &'static str,
    /// What was left out, or is uncertain.
    pub remarks: Vec<String>,
}

impl BlackboxFlight {
    /// In a line of a table of flights.
    pub fn summary(&self, number: usize) -> FlightSummary {
        FlightSummary { number, start_s: self.start_s, span_s: self.span_s, end: self.end.into() }
    }
}

/// Reads the (table, column) pairs that are `wanted`. Standard fields that were not recorded are NaN.
pub fn read(bytes: &[u8], place: &str, wanted: &BTreeSet<(&str, &str)>) -> Result<BlackboxFlight, BadInput> {
    let bad =
        |found: String| BadInput::new(place, found, "a flight whose header declares its frames", "is it damaged?");
    let header = Header::of(bytes);
    if let Some(version) = header.text("Data version").filter(|version| *version != "2") {
        return Err(bad(format!("data version {version}, where all firmware since 2015 writes 2")));
    }
    let definitions = Definitions::of(&header).map_err(bad)?;
    let decoder = FrameDecoder::new(bytes, &header, &definitions).map_err(bad)?;
    let select = |table: &str, definition| select(table, definition, &header, place, wanted);
    let mut main = Recorded::new(&definitions.intra, select("main", &definitions.intra)?);
    let mut gps = Recorded::new(&definitions.gps, select("gps", &definitions.gps)?);
    let mut slow = Recorded::new(&definitions.slow, select("slow", &definitions.slow)?);
    let mut events = GrowingRows::new(EVENT.len());
    let (places, mut fixes) = (Places::new(&definitions.gps, &header), Fixes::default());
    let mut armed = Armed::new(&definitions.slow, &header);
    let mut attitude = Attitude::new(&definitions.intra);
    let tally = decoder.run(header.end, |time_us, frame| match frame {
        DecodedFrame::Main(frame) => {
            main.push(time_us, frame);
            armed.begin(time_us);
            if let Some(attitude) = &mut attitude {
                attitude.push(time_us, &definitions.intra, frame);
            }
        }
        DecodedFrame::Gps(frame) => {
            gps.push(time_us, frame);
            fixes.push(time_us, &places, &definitions.gps, frame);
        }
        DecodedFrame::Slow(frame) => {
            slow.push(time_us, frame);
            armed.slow(time_us, frame);
        }
        DecodedFrame::Event(event) => {
            events.push(time_us, [event.kind.into(), event.first, event.second]);
            armed.event(time_us, event);
        }
    });
    let (span_s, start_s) = (main.rows.span_s(), main.rows.start_s());
    let end = match (&tally, armed.ended()) {
        (_, true) => "disarmed",
        (ByteTally { closed: true, .. }, _) => "the log was closed",
        _ => "the recording breaks off",
    };
    let mut remarks = remarks(&header, &tally);
    remarks.extend(heading(&definitions));
    let mut tables: BTreeMap<String, Table> = BTreeMap::from([("main".into(), main.table())]);
    tables.insert("events".into(), events.table(EVENT.map(String::from)));
    tables.insert("states".into(), armed.table());
    tables.extend(attitude.map(|attitude| ("attitude".to_string(), attitude.table())));
    let mut gps = gps.table();
    fixes.add_to(&mut gps);
    for (name, definition, table) in [("gps", &definitions.gps, gps), ("slow", &definitions.slow, slow.table())] {
        if !definition.names.is_empty() {
            tables.insert(name.into(), table);
        }
    }
    let vehicle = VehicleRecord { max_rate_rad_s: header.max_rates_rad_s(), ..VehicleRecord::default() };
    Ok(BlackboxFlight { tables: Tables { tables, vehicle, readable: readable(&tally) }, span_s, start_s, end, remarks })
}

/// The fields of a frame that are wanted.
fn select(
    table: &str,
    definition: &FrameDefinition,
    header: &Header,
    place: &str,
    wanted: &BTreeSet<(&str, &str)>,
) -> Result<Vec<ScaledField>, BadInput> {
    let known = || definition.names.iter().map(String::as_str);
    let position = |name: &str| known().position(|known| known == name);
    let mut fields = Vec::new();
    for (_, column) in wanted.iter().filter(|(source, _)| *source == table && !definition.names.is_empty()) {
        if *column == LOG_TIME || DERIVED.contains(column) {
            continue;
        }
        let alias = of_inav(column).filter(|_| header.inav());
        match position(column).or_else(|| position(alias?)) {
            Some(index) => fields.push(ScaledField::new(column, index, header, place)?),
            None if further_motor(column) => {}
            None if standard().any(|name| name == *column) => fields.push(ScaledField::absent(column)),
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

fn readable(tally: &ByteTally) -> Readable {
    let prefix = |why: &str| Readable::Prefix { bytes: tally.end as u64, of: tally.content as u64, why: why.into() };
    match tally {
        ByteTally { crowded: true, .. } => prefix("its frames are shorter than any firmware writes"),
        ByteTally { closed: true, .. } => Readable::Whole,
        // Switched off in the air, or out of room.
        _ => prefix("the recording breaks off without its end-of-log event"),
    }
}

/// What is uncertain about attitude and velocity.
fn heading(definitions: &Definitions) -> Option<String> {
    let [attitude, fixes] = [(&definitions.intra, "imuQuaternion[0]"), (&definitions.gps, "GPS_speed")]
        .map(|(definition, field)| definition.names.iter().any(|name| name == field));
    Some(
        match (attitude, fixes) {
            (true, true) => {
                "the heading is the flight controller's own: where neither compass nor GPS set it, velocity along the \
             body is wrong"
            }
            (false, true) => "it logs no attitude, so the GPS's velocity has no direction in the body and is left out",
            _ => return None,
        }
        .into(),
    )
}

fn remarks(header: &Header, tally: &ByteTally) -> Vec<String> {
    let mut remarks = Vec::new();
    if tally.lost_bytes > 0 {
        let ByteTally { lost, lost_bytes, frames, .. } = tally;
        remarks.push(format!("damaged within: {lost} frames ({lost_bytes} bytes) are left out, {frames} are read"));
    }
    if header.damaged > 0 {
        remarks.push(format!("{} damaged lines of the header are left out", header.damaged));
    }
    if tally.homeless > 0 {
        remarks.push(format!("{} GPS frames before the first home position are left out", tally.homeless));
    }
    let missing = [
        ("motor[0]", header.motor_range().is_none(), "motorOutput", "motor outputs"),
        ("eRPM[0]", header.rotor_speed_scale_rad_s().is_none(), "motor_poles", "rotor speeds"),
    ];
    let recorded = header.list("Field I name");
    for (field, lacks, key, what) in missing {
        if lacks && recorded.contains(&field) {
            remarks.push(format!("its header has no `{key}`: {what} are left out"));
        }
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
