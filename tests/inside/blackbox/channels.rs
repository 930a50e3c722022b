//! Motors, rotor speeds, states, attitude and velocity of blackbox files.

use super::pack;
use racer::flight::{self, Log, Options};

const MAIN: &str = "loopIteration,time,motor[0],motor[1],motor[2],motor[3],motor[4],motor[5],eRPM[0],eRPM[1],\
                    imuQuaternion[0],imuQuaternion[1],imuQuaternion[2]";
const HOME: &str = "GPS_home[0],GPS_home[1]";
const GPS: &str = "time,GPS_coord[0],GPS_coord[1],GPS_altitude,GPS_speed,GPS_ground_course";

/// What a flight controller of this firmware declares, all fields as plain numbers.
fn header(firmware: &str, main: &str, more: &str) -> Vec<u8> {
    let mut text = "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n".to_string();
    for (kind, names) in [('I', main), ('P', main), ('G', GPS), ('H', HOME), ('S', "flightModeFlags")] {
        let all = |number: &str| vec![number; names.split(',').count()].join(",");
        let (name, signed) = (format!("H Field {kind} name:{names}\n"), all("1"));
        text += if kind == 'P' { "" } else { &name };
        text += &format!("H Field {kind} signed:{signed}\nH Field {kind} predictor:{}\n", all("0"));
        text += &format!("H Field {kind} encoding:{}\n", all("0"));
    }
    text += &format!("H Firmware revision:{firmware}\nH acc_1G:2048\nH gyro_scale:0x3f800000\n{more}");
    text.into_bytes()
}

fn frame(bytes: &mut Vec<u8>, letter: u8, numbers: &[i32]) {
    bytes.push(letter);
    numbers.iter().for_each(|&number| pack::signed(bytes, number));
}

/// Two seconds at 10 Hz: a hexarotor that faces west, level, and flies south-east while it climbs.
fn flight(header: Vec<u8>, with_attitude: bool) -> Vec<u8> {
    let mut bytes = header;
    for i in 0..21 {
        let time = 1_000_000 + 100_000 * i;
        // Facing west: a quarter turn left from north.
        let turn = (32767.0 * std::f64::consts::FRAC_1_SQRT_2) as i32;
        let main = [i, time, 48, 2047, 1047, 158, 0, 48, 100, 600, 0, 0, turn];
        frame(&mut bytes, b'I', if with_attitude { &main } else { &main[..10] });
        if i == 0 {
            frame(&mut bytes, b'S', &[1]);
            frame(&mut bytes, b'H', &[600_000_000, 100_000_000]);
        }
        // Five metres a second towards 135 degrees, half a metre a second up.
        let step = 5.0 * 0.1 * f64::from(i) * std::f64::consts::FRAC_1_SQRT_2 / 111_195.08;
        let [north, east] = [-step, step / 60f64.to_radians().cos()].map(|degrees| (1e7 * degrees).round() as i32);
        frame(&mut bytes, b'G', &[time, 600_000_000 + north, 100_000_000 + east, 1000 + i / 2, 500, 1350]);
    }
    frame(&mut bytes, b'S', &[0]);
    frame(&mut bytes, b'I', &[21, 3_100_000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0][..if with_attitude { 13 } else { 10 }]);
    bytes.extend(b"E\xffEnd of log\0");
    bytes
}

const SCALES: &str = "H motorOutput:158,2047\nH motor_poles:14\n";

fn read(bytes: &[u8]) -> (Log, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bbl");
    std::fs::write(&path, bytes).unwrap();
    let opened = flight::open_with(&path, Options::default()).unwrap();
    (opened.log, opened.remarks)
}

fn close(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() < within
}

#[test]
fn motors_are_shares_of_the_full_command_and_rotors_turn() {
    let (log, remarks) = read(&flight(header("Betaflight 2025.12.1 (abc) X", MAIN, SCALES), true));
    assert_eq!((log.motors.count(), log.rotors.count()), (6, 2), "a hexarotor that senses two speeds");
    let row = log.motors.rows[3];
    let idle = 110.0 / 1999.0;
    for (found, expected) in row.iter().zip([0.0, 1.0, 999.0 / 1999.0, idle, 0.0, 0.0]) {
        assert!(close(*found, expected, 1e-12), "{row:?}");
    }
    // 60 000 electrical revolutions a minute of 7 pairs of poles.
    assert!(close(log.rotors.rows[3][1], 60_000.0 / 7.0 * std::f64::consts::TAU / 60.0, 1e-9));
    assert!(remarks.iter().any(|remark| remark.contains("heading")), "{remarks:?}");

    let (log, remarks) = read(&flight(header("Betaflight 4.5.1 (abc) X", MAIN, ""), true));
    assert!(log.motors.is_empty() && log.rotors.is_empty(), "no scale, no number");
    for key in ["motorOutput", "motor_poles"] {
        assert!(remarks.iter().any(|remark| remark.contains(key)), "{remarks:?}");
    }
}

#[test]
fn armed_until_the_switch_or_an_event_says_so() {
    let newer = header("Betaflight 4.5.1 (abc) X", MAIN, SCALES);
    let (log, _) = read(&flight(newer, true));
    assert_eq!(log.states.rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 0.0]);
    assert!(close(log.states.time_s[1], 2.0, 1e-9), "{:?}", log.states.time_s);
    assert!(log.states.rows[0][1].is_nan(), "whether it was in the air it does not say");

    // What the first flight mode of older firmware is, is not known.
    let older = header("Betaflight 3.1.7 (abc) X", MAIN, SCALES);
    let mut bytes = flight(older.clone(), true);
    assert_eq!(read(&bytes).0.states.rows.len(), 1);
    bytes.truncate(bytes.len() - 13);
    bytes.extend(b"E\x0f\x01E\xffEnd of log\0");
    assert_eq!(read(&bytes).0.states.rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 0.0]);
}

#[test]
fn velocity_along_the_body_where_there_is_an_attitude() {
    let (log, _) = read(&flight(header("Betaflight 4.6.0 (abc) X", MAIN, SCALES), true));
    let row = log.odometry.rows[10];
    // Half a turn from east: it faces west.
    assert!(close(row[3].abs(), 0.0, 1e-4) && close(row[6].abs(), 1.0, 1e-4), "{row:?}");
    // South-east, seen by somebody who faces west: backwards and to the left.
    let along = 5.0 * std::f64::consts::FRAC_1_SQRT_2;
    for (found, expected) in row[7..].iter().zip([-along, along, 0.5]) {
        assert!(close(*found, expected, 0.1), "{row:?}");
    }
    assert!(close(row[0], along, 0.05) && close(row[1], -along, 0.05) && close(row[2], 100.5, 1e-6), "{row:?}");

    let without = MAIN.split(",imu").next().unwrap();
    let (log, remarks) = read(&flight(header("Betaflight 4.5.1 (abc) X", without, SCALES), false));
    assert!(log.odometry.len() == 21 && log.odometry.rows[5][7..].iter().all(|v| v.is_nan()));
    assert!(close(log.odometry.rows[10][0], along, 0.05));
    assert!(remarks.iter().any(|remark| remark.contains("no attitude")), "{remarks:?}");
}
