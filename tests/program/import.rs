//! Log files as `flight::open` and `racer import` meet them: whole, broken off, wrong, hostile.

use crate::support::ulog::ulog;
use crate::support::{flight_data, racer};
use flate2::{Compression, write::GzEncoder};
use proptest::prelude::*;
use racer::flight::open::Opened;
use racer::flight::{self, Log, Options, Readable};
use std::io::Write;
use tempfile::TempDir;

const MAPPING: &str = "time = { field = 't', unit = 'ms' }\n\
                       [imu]\ngyro = { fields = ['p', '-q', 'r'], unit = 'deg/s' }\n\
                       [battery]\nvoltage = { field = 'v', scale = 2.0, offset = 1.0, unit = 'mV' }\n";

fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// Reads `bytes` as a file `name` with the mapping `mapping`.
fn read(name: &str, bytes: &[u8], mapping: &str) -> Result<Log, String> {
    let folder = folder(&[(name, bytes), ("m.toml", mapping.as_bytes())]);
    let mapping = folder.path().join("m.toml");
    flight::open(&folder.path().join(name), mapping.to_str()).map_err(|error| error.to_string())
}

fn packed(text: &str) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn units_signs_offsets_and_time() {
    let log = read("a.csv", b"t,p,q,r,v,mode\n1000,180,90,,500,ACRO\n1500,0,0,0,,ACRO\n", MAPPING).unwrap();
    assert_eq!((log.start_ns, &log.imu.time_s[..]), (1_000_000_000, &[0.0, 0.5][..]));
    let [p, q, r, ..] = log.imu.rows[0];
    assert!((p - std::f64::consts::PI).abs() < 1e-12 && (q + std::f64::consts::FRAC_PI_2).abs() < 1e-12 && r.is_nan());
    // The row without a voltage has nothing for the battery.
    assert_eq!(log.battery.rows.len(), 1);
    assert!((log.battery.rows[0][0] - 1.001).abs() < 1e-12 && log.battery.rows[0][1].is_nan());
}

#[test]
fn frames_are_turned() {
    let mapping = "world = 'NED'\nbody = 'FRD'\ntime = { field = 't' }\n\
                   [odometry]\nposition = { fields = ['n', 'e', 'd'] }\n\
                   attitude = { fields = ['w', 'x', 'y', 'z'] }\n\
                   velocity = { fields = ['u', 'v', 's'] }\nvelocity_frame = 'world'\n";
    // Level, heading east, flying north-east and climbing: to the left and forward.
    let log =
        read("a.csv", b"t,n,e,d,w,x,y,z,u,v,s\n0,1,2,-3,0.7071067811865476,0,0,0.7071067811865476,4,5,-6\n", mapping)
            .unwrap();
    let row = log.odometry.rows[0];
    let expected = [2.0, 1.0, 3.0, 1.0, 0.0, 0.0, 0.0, 5.0, 4.0, 6.0];
    let sign = row[3].signum();
    for (k, (value, expected)) in row.iter().zip(expected).enumerate() {
        let value = if (3..7).contains(&k) { sign * value } else { *value };
        assert!((value - expected).abs() < 1e-12, "{row:?}");
    }
    let without = mapping.replace("attitude = { fields = ['w', 'x', 'y', 'z'] }\n", "");
    let log = read("a.csv", b"t,n,e,d,u,v,s\n0,1,2,-3,4,5,-6\n", &without).unwrap();
    assert!(log.odometry.rows[0][0] == 2.0 && log.odometry.rows[0][7].is_nan());
}

#[test]
fn what_is_wrong_is_named() {
    let rows = b"t,pp,q,r,v\n0,1,2,3,4\n";
    for (bytes, mapping, parts) in [
        (&rows[..], MAPPING, ["no column `p`", "imu.gyro", "did you mean"]),
        (b"t,p,q,r,v\n0,1,2,3,4\n1,x1,2,3,4\n", MAPPING, ["a.csv:3", "`x1`", "column `p`"]),
        (b"t,p,q,r,v\n0,1,2,3\n0,1,2,3,4\n", MAPPING, ["a.csv:2", "4 cells", "5"]),
        (b"t,p,p,r,v\n", MAPPING, ["`p` twice", "names the columns", "CSV"]),
        (b"t,p,q,r,v\n,1,2,3,4\n", MAPPING, ["row 1 of `imu`", "NaN", "time"]),
        (b"t,p,q,r,v\n", MAPPING, ["no row below them", "a row for each time", "to do"]),
        (rows, "[imu]\ngyro = { fields = ['p', 'q'] }", ["imu.gyro.fields", "2 of them", "3 columns"]),
        (rows, "[imu]\ngyro = { fields = ['p', 'q', 'r'], unit = 'deg' }", ["imu.gyro.unit", "deg", "deg/s"]),
        (rows, "[imu]\ngiro = { fields = ['p', 'q', 'r'] }", ["imu.giro", "unknown", "gyro"]),
        (rows, "[battery]\nvoltage = { field = 'v', mean = ['v'] }", ["battery.voltage", "both", "either"]),
        (rows, "[battery]\nvoltage = { field = 'v' }", ["no column `time`", "battery.time", "mapping"]),
        (rows, "[imu]\nsource = '/imu'\ngyro = { fields = ['p', 'q', 'r'] }", ["no `/imu`", "imu", "mapping"]),
        (b"\x7fELF\x02\x01\0\0\n\xff", MAPPING, ["no text", "names the columns", "CSV"]),
    ] {
        let error = read("a.csv", bytes, mapping).unwrap_err();
        assert!(parts.iter().all(|part| error.contains(part)), "{parts:?} in {error}");
    }
}

#[test]
fn csv_of_other_kinds() {
    for text in
        ["t;p;q;r;v\n0;1;2;3;4\n", "\u{feff}t\tp\tq\tr\tv\r\n0\t1\t2\t3\t4\r\n", "t, p, q, r, v,\n0, 1, 2, 3, 4,\n"]
    {
        assert_eq!(read("a.csv", text.as_bytes(), MAPPING).unwrap().imu.len(), 1, "{text}");
    }
    assert_eq!(read("a.csv.gz", &packed("t,p,q,r,v\n0,1,2,3,4\n"), MAPPING).unwrap().imu.len(), 1);
}

#[test]
fn a_file_that_breaks_off_gives_what_came_before() {
    let rows: String = (0..5000).map(|i| format!("{i},{},2,3,{}\n", i % 97, i % 89)).collect();
    let bytes = packed(&format!("t,p,q,r,v\n{rows}"));
    let log = read("a.csv.gz", &bytes[..bytes.len() / 2], MAPPING).unwrap();
    let Readable::Prefix { bytes: at, of, .. } = log.readable else { panic!("not whole") };
    assert!(
        log.imu.len() > 1000 && log.imu.len() < 4000 && at <= of && of == bytes.len() as u64 / 2,
        "{}",
        log.imu.len()
    );
    let log = read("a.csv", b"t,p,q,r,v\n0,1,2,3,4\n1,2,", MAPPING).unwrap();
    assert!(log.imu.len() == 1 && log.readable != Readable::Whole);
}

#[test]
fn a_file_beside_is_a_source() {
    let mapping = "time = { field = 't' }\n[imu]\ngyro = { fields = ['p', 'q', 'r'] }\n\
                   [odometry]\nsource = '_gps'\nposition = { fields = ['x', 'y', 'z'], scale = [1.0, 1.0, 0.1] }\n";
    let files: [(&str, &[u8]); 3] =
        [("a.csv", b"t,p,q,r\n2,1,2,3\n"), ("a_gps.csv", b"t,x,y,z\n1,1,2,30\n"), ("m.toml", mapping.as_bytes())];
    let open = |folder: &TempDir| {
        let mapping = folder.path().join("m.toml");
        flight::open(&folder.path().join("a.csv"), mapping.to_str())
    };
    let log = open(&folder(&files)).unwrap();
    assert_eq!((log.odometry.rows[0][..3].to_vec(), log.imu.time_s[0]), (vec![1.0, 2.0, 3.0], 1.0));
    assert!(open(&folder(&[files[0], files[2]])).unwrap_err().to_string().contains("no `_gps`"));
}

#[test]
fn columns_choose_the_mapping_or_what_there_is_is_said() {
    let header = "t_s,angvel_x,angvel_y,angvel_z,qx,qy,qz,qw,acc_x,acc_y,acc_z,velbody_x,velbody_y,velbody_z,\
                  pos_x,pos_y,pos_z,mot1_radps,mot2_radps,mot3_radps,mot4_radps,vbat_V\n\
                  0,0,0,0,0,0,0,1,0,0,9.8,1,0,0,0,0,0,1250,1250,1250,1250,16\n";
    let folder = folder(&[("a.csv", header.as_bytes()), ("b.csv", b"t_s,x\n0,1\n")]);
    let Opened { log, mapping, remarks, .. } =
        flight::open_with(&folder.path().join("a.csv"), Options::default()).unwrap();
    assert_eq!((mapping.as_str(), log.setpoint.rows[0][3]), ("neurobem", 0.5));
    assert!(remarks[0].contains("neurobem"));
    let error = flight::open(&folder.path().join("b.csv"), None).unwrap_err().to_string();
    for part in ["indiflight (1 of", "betaflight_csv", "t_s, x", "--mapping"] {
        assert!(error.contains(part), "{error}");
    }
}

/// A blackbox file with a few frames written by hand.
fn blackbox(frames: &[u8]) -> Vec<u8> {
    let fields = "loopIteration,time,setpoint[0],setpoint[3],vbatLatest";
    let header = format!(
        "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\nH Field I name:{fields}\n\
         H Field I signed:0,0,1,1,0\nH Field I predictor:0,0,0,0,0\nH Field I encoding:1,1,0,1,1\n\
         H Field P predictor:6,2,1,1,1\nH Field P encoding:9,0,0,0,0\n\
         H Field S name:flightModeFlags\nH Field S signed:0\nH Field S predictor:0\nH Field S encoding:1\n\
         H Firmware revision:Betaflight 4.3.1 (8d4f005) STM32F7X2\nH motor_pwm_protocol:7\n\
         H rates_type:3\nH rc_rates:10,10,10\nH rates:70,70,50\n"
    );
    [header.as_bytes(), frames].concat()
}

/// An intra frame at 100 us with 90 deg/s, half throttle and 16 V; an inter frame 100 us later with one deg/s more; the
/// end.
const FRAMES: &[u8] = &[
    b'I', 0, 100, 0xb4, 1, 0xf4, 3, 0xc0, 0x0c, b'P', 0xc8, 1, 2, 0, 0, b'E', 255, b'E', b'n', b'd', b' ', b'o', b'f',
    b' ', b'l', b'o', b'g', 0,
];

fn open_bytes(name: &str, bytes: &[u8], options: Options) -> Result<Opened, String> {
    let folder = folder(&[(name, bytes)]);
    flight::open_with(&folder.path().join(name), options).map_err(|error| error.to_string())
}

#[test]
fn blackbox_frames_flights_and_rates() {
    // Flash memory beyond the end of a flight is padding.
    let one = [&blackbox(FRAMES)[..], &[0xff; 100]].concat();
    let log = open_bytes("a.bbl", &one, Options::default()).unwrap().log;
    assert_eq!(log.readable, Readable::Whole);
    assert_eq!((log.setpoint.len(), log.imu.len()), (2, 0), "{log:?}");
    assert!((log.setpoint.rows[1][0] - 91f64.to_radians()).abs() < 1e-12 && log.setpoint.rows[0][3] == 0.5);
    assert!(log.setpoint.rows[0][1].is_nan(), "not recorded");
    assert!((log.setpoint.time_s[1] - 1e-4).abs() < 1e-9 && log.start_ns == 100_000);
    assert_eq!(log.battery.rows[0][0], 16.0);
    assert_eq!(
        log.vehicle.max_rate_rad_s.map(|rates| rates.map(|rate| rate.to_degrees().round())),
        Some([700.0, 700.0, 500.0])
    );

    let cut = [&blackbox(&FRAMES[..9])[..], &one].concat();
    let opened = open_bytes("a.bbl", &cut, Options::default()).unwrap();
    assert_eq!(opened.log.setpoint.len(), 2);
    assert!(opened.remarks[0].contains("flight 2 of 2"), "{:?}", opened.remarks);
    let ends: Vec<_> = opened.flights.iter().map(|flight| (flight.number, flight.end.as_str())).collect();
    assert_eq!(ends, [(1, "the recording breaks off"), (2, "the log was closed")]);
    let near = |found: f64| (found - 1e-4).abs() < 1e-9;
    assert!(near(opened.flights[1].span_s) && opened.flights[1].start_s.is_some_and(near));
    let first = open_bytes("a.bbl", &cut, Options { flight: Some(1), mapping: None }).unwrap().log;
    assert!(first.setpoint.len() == 1 && first.readable != Readable::Whole);
    assert!(open_bytes("a.bbl", &cut, Options { flight: Some(3), mapping: None }).unwrap_err().contains("1 to 2"));
    assert!(
        open_bytes("a.csv", b"a,b\n", Options { flight: Some(1), mapping: None }).unwrap_err().contains("--flight")
    );
}

#[test]
fn ulog_is_turned_and_attitude_joined() {
    let bytes = ulog();
    let Opened { log, mapping, .. } = open_bytes("a.ulg", &bytes, Options::default()).unwrap();
    assert_eq!((mapping.as_str(), &log.readable, log.start_ns), ("px4", &Readable::Whole, 5_000_000_000));
    let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
    let expected = [0.1, -0.2, -0.3, 0.4];
    assert!(log.setpoint.rows[7].iter().zip(expected).all(|(a, b)| close(*a, b)), "{:?}", log.setpoint.rows[7]);
    assert_eq!((log.setpoint.len(), log.odometry.len(), log.imu.len()), (100, 10, 0));
    assert!(log.odometry.rows[0][3].is_nan(), "before the first attitude");
    let expected = [2.0, 1.0, 3.0, 0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt(), 4.0, -5.0, 6.0];
    let row = log.odometry.rows[5];
    let sign = row[3].signum();
    let turned = |k: usize| if (3..7).contains(&k) { sign * row[k] } else { row[k] };
    assert!((0..10).all(|k| close(turned(k), expected[k])), "{row:?}");

    let cut = open_bytes("a.ulg", &bytes[..bytes.len() - 200], Options::default()).unwrap().log;
    assert!(matches!(cut.readable, Readable::Prefix { .. }) && cut.setpoint.len() > 90);
    let error = open_bytes("a.ulg", &bytes, Options { mapping: Some("canonical"), flight: None }).unwrap_err();
    assert!(error.contains("vehicle_attitude"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    /// No bytes make a reader panic, and what it allocates stays in proportion.
    #[test]
    fn hostile_bytes(
        kind in 0usize..4,
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        tail in prop::collection::vec(any::<u8>(), 0..400),
        keep in any::<prop::sample::Index>(),
    ) {
        let (name, mut bytes) = match kind {
            0 => ("a.bbl", blackbox(FRAMES)),
            1 => ("a.ulg", ulog()),
            2 => ("a.csv", b"t,p,q,r,v\n0,1,2,3,4\n1,2,3,4,5\n".to_vec()),
            _ => ("a.csv.gz", packed("t,p,q,r,v\n0,1,2,3,4\n1,2,3,4,5\n")),
        };
        for (at, byte) in cuts {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate(1 + keep.index(bytes.len()));
        bytes.extend(tail);
        if kind < 2 {
            let _ = open_bytes(name, &bytes, Options::default());
        } else {
            let _ = read(name, &bytes, MAPPING);
        }
    }

    #[test]
    fn hostile_frames(
        frames in prop::collection::vec(prop_oneof![Just(b'I'), Just(b'P'), Just(0xff), any::<u8>()], 0..2000)
    ) {
        let _ = open_bytes("a.bbl", &blackbox(&frames), Options::default());
    }
}

/// Commands and voltages. The CSV is of a decoder that predicted averages, gyro and acceleration,
/// from the wrong frames; blackbox_decode is what those are compared with.
#[test]
fn raw_blackbox_decodes_to_the_commands_and_voltages_of_its_csv() {
    let (Some(raw), Some(csv)) =
        (flight_data("betaflight/gecko_btfl_002.bbl"), flight_data("betaflight/gecko_btfl_002_log1.csv.gz"))
    else {
        return;
    };
    let raw = flight::open_with(&raw, Options { flight: Some(1), mapping: None }).unwrap().log;
    assert_eq!(raw.readable, Readable::Whole);
    let csv = flight::open(&csv, None).unwrap();

    fn same<const N: usize>(name: &str, raw: &flight::Stream<N>, csv: &flight::Stream<N>, within: [f64; N]) {
        assert_eq!(raw.len(), csv.len(), "{name}");
        for (i, (a, b)) in raw.rows.iter().zip(&csv.rows).enumerate() {
            let same = |k: usize| (a[k] - b[k]).abs() <= within[k] || a[k].is_nan() && b[k].is_nan();
            assert!((0..N).all(same) && (raw.time_s[i] - csv.time_s[i]).abs() < 1e-6, "{name} {i}: {a:?} {b:?}");
        }
        println!("{name}: {} rows are the same", raw.len());
    }
    // Half of the last digit that the CSV has.
    let rate = 0.05f64.to_radians() + 1e-9;
    same("setpoint", &raw.setpoint, &csv.setpoint, [rate, rate, rate, 5.1e-4]);
    same("battery", &raw.battery, &csv.battery, [5.1e-3, 5.1e-3]);
}

#[test]
fn import_writes_a_new_file_or_nothing() {
    let files: [(&str, &[u8]); 3] =
        [("a.csv", b"t,p,q,r,v\n0,1,2,3,4\n1,2,3,4,5\n"), ("m.toml", MAPPING.as_bytes()), ("there.mcap", b"mine")];
    let folder = folder(&files);
    let ran = racer(folder.path(), &["import", "a.csv", "--out", "there.mcap", "--mapping", "m.toml"]);
    assert!(ran.code == 2 && ran.err.contains("nothing existing is overwritten"), "{}", ran.err);
    assert_eq!(std::fs::read(folder.path().join("there.mcap")).unwrap(), b"mine");
    let ran = racer(folder.path(), &["import", "a.csv", "--out", "b.mcap"]);
    assert!(ran.code == 2 && ran.err.contains("--mapping") && !folder.path().join("b.mcap").exists(), "{}", ran.err);

    let ran = racer(folder.path(), &["import", "a.csv", "--out", "b.mcap", "--mapping", "m.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("imu") && ran.out.contains("specific force") && ran.out.contains("none"), "{}", ran.out);
    let again = flight::open(&folder.path().join("b.mcap"), None).unwrap();
    let log = flight::open(&folder.path().join("a.csv"), folder.path().join("m.toml").to_str()).unwrap();
    assert_eq!(again.imu.rows[1][..3], log.imu.rows[1][..3]);
    assert_eq!(again.imu.time_s, log.imu.time_s);

    std::fs::write(folder.path().join("cut.ulg"), &ulog()[..2000]).unwrap();
    let ran = racer(folder.path(), &["import", "cut.ulg", "--out", "c.mcap"]);
    assert!(ran.code == 3 && ran.err.contains("damaged") && folder.path().join("c.mcap").exists(), "{}", ran.err);
}

/// What blackbox_decode makes of a blackbox is known by its columns; what it leaves open is said.
#[test]
fn csv_of_blackbox_decode_needs_no_mapping() {
    let header = "loopIteration, time (us), setpoint[0], setpoint[1], setpoint[2], setpoint[3], vbatLatest (V), \
                  gyroADC[0], gyroADC[1], gyroADC[2], accSmooth[0], accSmooth[1], accSmooth[2], motor[0], \
                  flightModeFlags (flags)\n";
    let rows = "0, 1000000,  90,   0,   0, 500, 16.5, 180,   0,   0,   0,   0, 2048, 158, ANGLE_MODE|X\n\
                1, 1002000,  91,   0,   0, 510, 16.4, 180,   0,   0,   0,   0, 2048, 158, 0\n";
    let opened = open_bytes("a.01.csv", [header, rows].concat().as_bytes(), Options::default()).unwrap();
    let log = opened.log;
    assert_eq!((opened.mapping.as_str(), log.imu.len(), log.start_ns), ("betaflight", 2, 1_000_000_000));
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(close(log.setpoint.rows[0][0], 90f64.to_radians()) && close(log.setpoint.rows[1][3], 0.51));
    assert!(close(log.imu.rows[0][0], std::f64::consts::PI) && close(log.imu.rows[0][5], 9.80665));
    assert!(close(log.battery.rows[0][0], 16.5) && log.battery.rows[0][1].is_nan(), "no current was logged");
    for part in ["blackbox_decode", "2048 counts", "vbatLatest (V)", "deg/s"] {
        assert!(opened.remarks.iter().any(|remark| remark.contains(part)), "{part}: {:?}", opened.remarks);
    }
}

/// Other firmware is read by what its header declares, damage within is counted, and both are said.
#[test]
fn blackbox_of_other_firmware_and_with_damage() {
    let file = |firmware: &str, frames: &[u8]| {
        let text = String::from_utf8_lossy(&blackbox(b"")).replace("Betaflight 4.3.1", firmware);
        [text.as_bytes(), frames].concat()
    };
    let opened = open_bytes("a.bbl", &file("EmuFlight 0.4.1", FRAMES), Options::default()).unwrap();
    assert!(opened.log.setpoint.len() == 2 && opened.remarks[0].contains("EmuFlight"), "{:?}", opened.remarks);
    let newest = open_bytes("a.bbl", &file("Betaflight 2026.6.0", FRAMES), Options::default()).unwrap();
    assert!(newest.log.setpoint.len() == 2 && newest.remarks.is_empty(), "{:?}", newest.remarks);

    // Two bytes that are no frame between the first frame and the end.
    let damaged = [&FRAMES[..9], &[1, 2], &FRAMES[..9], &FRAMES[FRAMES.len() - 13..]].concat();
    let opened = open_bytes("a.bbl", &file("Betaflight 4.3.1", &damaged), Options::default()).unwrap();
    assert_eq!(opened.log.readable, Readable::Whole);
    assert!(opened.remarks[0].contains("11 bytes") && opened.remarks[0].contains("1 frames"), "{:?}", opened.remarks);
}

#[test]
fn names_of_columns_alone_are_no_flight() {
    let mapping =
        format!("{MAPPING}[odometry]\nsource = '_gps'\noptional = true\nposition = {{ fields = ['n', 'e', 'u'] }}\n");
    let error = read("a.csv", b"t,p,q,r,v,mode\n", &mapping).unwrap_err();
    assert!(error.contains("no row below them") && error.contains("to do") && !error.contains("``"), "{error}");
    let error = read("a.csv", b"t,p,q,r,v,mode\n1,,,,,\n", &mapping).unwrap_err();
    assert!(error.contains("values in its own columns or `_gps`"), "{error}");
}

#[test]
fn what_is_no_flight_log_is_called_what_it_is() {
    let vehicle = std::fs::read("configs/vehicles/seed_class.toml").unwrap();
    let track = std::fs::read("tracks/square.toml").unwrap();
    let readme = std::fs::read("README.md").unwrap();
    for (name, bytes, said) in [
        ("v.toml", &vehicle[..], "a vehicle file, no flight log"),
        ("v", &vehicle[..], "--vehicle"),
        ("track.toml", &track[..], "a TOML file, no flight log"),
        ("page.html", b"<!DOCTYPE html><html></html>", "a page, no flight log"),
        ("page.csv", b"\n<html><body>a,b</body></html>", "a page, no flight log"),
        ("README.md", &readme[..], "no flight log"),
        ("a.json", b"{\"a\": [1, 2]}", "a JSON file, no flight log"),
    ] {
        let folder = folder(&[(name, bytes)]);
        let ran = racer(folder.path(), &["check", name]);
        assert!(ran.code == 2 && ran.err.contains(said) && ran.err.contains("to do"), "{name}: {}", ran.err);
        assert!(!ran.err.contains("--mapping"), "{name}: {}", ran.err);
    }
    let error = flight::open("nowhere.csv".as_ref(), None).unwrap_err().to_string();
    assert!(error.contains("nowhere.csv") && error.contains("spelled right"), "{error}");
}
