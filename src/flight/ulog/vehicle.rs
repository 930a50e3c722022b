//! What a PX4 log says of the vehicle, its motors and its rotors.
//!
//! The table "motors" has `command[0]` and on, 0..1; "rotors" has `speed[0]` and on, rad/s.

use crate::flight::table::{LOG_TIME, Table, Tables};
use crate::flight::{MOTORS, VehicleKind, VehicleRecord};
use std::collections::HashMap;

/// Parameters by name.
pub type Px4Parameters = HashMap<String, f64>;

/// Topics that the tables and the record are made of.
pub const SOURCES: [&str; 4] = ["actuator_motors", "actuator_outputs", "esc_status", "vehicle_status"];

/// Longest name of a parameter, with its type.
const MOST_NAME_BYTES: usize = 64;

/// Takes in a parameter: the length of its type and name, these, four bytes. Of one that is set twice the first counts.
pub fn parameter(parameters: &mut Px4Parameters, payload: &[u8]) {
    let Some((&length, rest)) = payload.split_first() else { return };
    let Some((name, value)) = rest.split_at_checked(length.into()) else { return };
    let (Ok(name), Ok(value)) = (std::str::from_utf8(name), <[u8; 4]>::try_from(value)) else { return };
    let value = match name.split_once(' ') {
        Some(("float", name)) => (name, f32::from_le_bytes(value).into()),
        Some(("int32_t", name)) => (name, i32::from_le_bytes(value).into()),
        _ => return,
    };
    if name.len() <= MOST_NAME_BYTES {
        parameters.entry(value.0.into()).or_insert(value.1);
    }
}

/// Adds what is known of the vehicle; a remark where something that was logged is left out.
pub fn complete(tables: &mut Tables, parameters: &Px4Parameters) -> Option<String> {
    tables.vehicle = record(tables, parameters);
    let count = tables.vehicle.rotors.map_or(MOTORS, usize::from);
    let rotors = rotors(tables, count);
    tables.tables.extend(rotors.map(|table| ("rotors".to_string(), table)));
    let (motors, remark) = match motors(tables, count, parameters) {
        Ok(motors) => (motors, None),
        Err(remark) => (None, Some(remark)),
    };
    tables.tables.extend(motors.map(|table| ("motors".to_string(), table)));
    remark
}

/// The last number of a column.
fn last(tables: &Tables, topic: &str, column: &str) -> Option<f64> {
    tables.tables.get(topic)?.columns.get(column)?.last().copied()
}

fn record(tables: &Tables, parameters: &Px4Parameters) -> VehicleRecord {
    let status = |column: &str| last(tables, "vehicle_status", column);
    let of_type = parameters.get("MAV_TYPE").copied().or_else(|| status("system_type")).map(|number| number as i64);
    let kind = match of_type {
        _ if status("is_vtol") == Some(1.0) => Some(VehicleKind::Vtol),
        Some(2 | 3 | 13..=15 | 29) => Some(VehicleKind::Multirotor),
        Some(1) => Some(VehicleKind::FixedWing),
        Some(4) => Some(VehicleKind::Helicopter),
        Some(10 | 11) => Some(VehicleKind::Rover),
        Some(19..=25) => Some(VehicleKind::Vtol),
        Some(0) | None => match (status("vehicle_type"), status("is_rotary_wing")) {
            (Some(1.0), _) | (None, Some(1.0)) => Some(VehicleKind::Multirotor),
            (Some(2.0), _) | (None, Some(0.0)) => Some(VehicleKind::FixedWing),
            (Some(3.0), _) => Some(VehicleKind::Rover),
            _ => None,
        },
        Some(_) => Some(VehicleKind::Other),
    };
    let counted = match of_type {
        Some(2) => Some(4),
        Some(13) => Some(6),
        Some(14) => Some(8),
        Some(15) => Some(3),
        _ => None,
    };
    let allocated = parameters.get("CA_ROTOR_COUNT").map(|count| *count as u8);
    let rotors = allocated.filter(|count| (1..=MOTORS).contains(&usize::from(*count))).or(counted);
    VehicleRecord { kind, rotors, ..VehicleRecord::default() }
}

/// The columns of a topic that are numbered so, by what makes them those of `name`.
fn numbered(table: &Table, column: impl Fn(usize) -> String, name: &str, value: impl Fn(usize, f64) -> f64) -> Table {
    let mut out = Table::default();
    for k in 0..MOTORS {
        let Some(values) = table.columns.get(&column(k)) else { continue };
        out.columns.insert(format!("{name}[{k}]"), values.iter().map(|&x| value(k, x)).collect());
    }
    out.columns.extend(table.columns.get(LOG_TIME).map(|times| (LOG_TIME.to_string(), times.clone())));
    out
}

/// Speeds that the speed controllers sense; none where they sense nothing but zeros.
fn rotors(tables: &Tables, count: usize) -> Option<Table> {
    let status = tables.tables.get("esc_status").filter(|table| table.rows() > 0)?;
    let senses = |k: usize| {
        let column = status.columns.get(&format!("esc[{k}].esc_rpm"));
        k < count && column.is_some_and(|values| values.iter().any(|rpm| *rpm != 0.0))
    };
    let known: Vec<bool> = (0..MOTORS).map(senses).collect();
    let rad_s = |k: usize, rpm: f64| if known[k] { rpm.abs() * std::f64::consts::TAU / 60.0 } else { f64::NAN };
    known.contains(&true).then(|| numbered(status, |k| format!("esc[{k}].esc_rpm"), "speed", rad_s))
}

/// What the motors were sent: since PX4 1.13 as such, before as the lengths of pulses.
fn motors(tables: &Tables, count: usize, parameters: &Px4Parameters) -> Result<Option<Table>, String> {
    let logged = |topic: &str| tables.tables.get(topic).filter(|table| table.rows() > 0);
    let of = |k: usize, x: f64| if k < count { x } else { f64::NAN };
    if let Some(table) = logged("actuator_motors") {
        return Ok(Some(numbered(table, |k| format!("control[{k}]"), "command", of)));
    }
    let Some(table) = logged("actuator_outputs") else { return Ok(None) };
    let find = |names: [&str; 2]| names.into_iter().find_map(|name| parameters.get(name)).copied();
    let range = find(["PWM_MAIN_MIN", "PWM_MIN"]).zip(find(["PWM_MAIN_MAX", "PWM_MAX"]));
    let Some((low, high)) = range.filter(|(low, high)| high > low) else {
        return Err(
            "actuator_outputs are left out: no parameters PWM_MAIN_MIN and PWM_MAIN_MAX say what they mean".into()
        );
    };
    // Below the least pulse a motor stands still.
    let share = |k: usize, pulse: f64| of(k, ((pulse - low) / (high - low)).max(0.0));
    Ok(Some(numbered(table, |k| format!("output[{k}]"), "command", share)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables(topics: &[(&str, &[(&str, f64)])]) -> Tables {
        let mut tables = Tables::default();
        for (topic, columns) in topics {
            let columns = columns.iter().map(|(name, value)| (name.to_string(), vec![*value]));
            tables.tables.insert(topic.to_string(), Table { columns: columns.collect() });
        }
        tables
    }

    fn parameters(values: &[(&str, f64)]) -> Px4Parameters {
        values.iter().map(|(name, value)| (name.to_string(), *value)).collect()
    }

    #[test]
    fn kinds_of_vehicles() {
        let kind = |topics, values: &[(&str, f64)]| record(&tables(topics), &parameters(values)).kind;
        assert_eq!(kind(&[], &[("MAV_TYPE", 2.0)]), Some(VehicleKind::Multirotor));
        assert_eq!(kind(&[], &[("MAV_TYPE", 1.0)]), Some(VehicleKind::FixedWing));
        assert_eq!(kind(&[("vehicle_status", &[("is_vtol", 1.0)])], &[("MAV_TYPE", 2.0)]), Some(VehicleKind::Vtol));
        assert_eq!(kind(&[("vehicle_status", &[("vehicle_type", 3.0)])], &[]), Some(VehicleKind::Rover));
        assert_eq!(kind(&[("vehicle_status", &[("is_rotary_wing", 0.0)])], &[]), Some(VehicleKind::FixedWing));
        assert_eq!((kind(&[], &[]), kind(&[], &[("MAV_TYPE", 12.0)])), (None, Some(VehicleKind::Other)));
    }

    #[test]
    fn motors_by_share_or_by_pulse() {
        let outputs: &[(&str, &[(&str, f64)])] = &[(
            "actuator_outputs",
            &[(LOG_TIME, 1.0), ("output[0]", 1500.0), ("output[1]", 900.0), ("output[4]", 1500.0)],
        )];
        let mut old = tables(outputs);
        let quad = [("MAV_TYPE", 2.0), ("PWM_MIN", 1000.0), ("PWM_MAX", 2000.0)];
        assert_eq!(complete(&mut old, &parameters(&quad)), None);
        let motors = &old.tables["motors"].columns;
        assert_eq!((motors["command[0]"][0], motors["command[1]"][0], old.vehicle.rotors), (0.5, 0.0, Some(4)));
        assert!(motors["command[4]"][0].is_nan(), "no motor but a servo, or nothing");
        let mut unknown = tables(outputs);
        assert!(complete(&mut unknown, &parameters(&quad[..1])).unwrap().contains("PWM_MAIN_MIN"));
        assert!(!unknown.tables.contains_key("motors"));
        let mut new = tables(&[
            ("actuator_motors", &[(LOG_TIME, 1.0), ("control[0]", 0.25)]),
            ("esc_status", &[(LOG_TIME, 1.0), ("esc[0].esc_rpm", -600.0), ("esc[1].esc_rpm", 0.0)]),
        ]);
        assert_eq!(complete(&mut new, &parameters(&[("CA_ROTOR_COUNT", 6.0)])), None);
        assert_eq!(new.tables["motors"].columns["command[0]"], [0.25]);
        let speeds = &new.tables["rotors"].columns;
        assert!((speeds["speed[0]"][0] - 62.83).abs() < 0.01 && speeds["speed[1]"][0].is_nan());
    }

    #[test]
    fn parameters_and_damaged_ones() {
        let mut read = Px4Parameters::new();
        parameter(&mut read, &[&[15u8][..], b"float PWM_SCALE", &1.5f32.to_le_bytes()].concat());
        parameter(&mut read, &[&[16u8][..], b"int32_t MAV_TYPE", &2i32.to_le_bytes()].concat());
        parameter(&mut read, &[&[16u8][..], b"int32_t MAV_TYPE", &7i32.to_le_bytes()].concat());
        for bad in [&b""[..], &[200, 1, 2], &[3, b'a', b' ', b'b', 1], &[1, 0xff, 0, 0, 0, 0]] {
            parameter(&mut read, bad);
        }
        assert_eq!(read, parameters(&[("PWM_SCALE", 1.5), ("MAV_TYPE", 2.0)]));
    }
}
