//! `racer import`: a flight log of any kind as a canonical one.

use super::{CommandEnd, columns, tell};
use crate::base::fsio::Reserved;
use crate::flight::{self, Log, MOTORS, Options, Readable, Stream};
use std::path::PathBuf;

/// Convert a flight log to the canonical form: MCAP with ROS 2 messages
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Betaflight blackbox, PX4 ULog, CSV (also .csv.gz), or MCAP
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// New file
    #[arg(long, value_name = "LOG.mcap")]
    out: PathBuf,
    /// What the columns mean [default: as the format says, or the built-in one that fits a CSV file]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Which flight of a blackbox file, counted from 1 [default: the longest]
    #[arg(long, value_name = "N")]
    flight: Option<usize>,
}

const HELP: &str = "Examples:
  racer import btfl_002.bbl --out flight.mcap --flight 1
  racer import log.ulg --out flight.mcap
  racer import roma_f5_log3.csv.gz --out flight.mcap
  racer import mine.csv --out flight.mcap --mapping mine.toml
  racer import bag_0.mcap --out flight.mcap --mapping mine.toml

Built-in mappings: canonical, betaflight, px4, px4_ros2, mavros, betaflight_csv, crazyflie, agilicious, indiflight,
neurobem, nanobench.

A mapping names the columns of each stream; leave out what a log lacks:
  body = \"FLU\"                     # or FRD; of one stream where it stands below it
  world = \"ENU\"                    # or NED
  time = { field = \"t_us\", unit = \"us\" }
  [setpoint]
  source = \"/fcu/setpoint\"         # a topic; leave out for CSV
  rate = { fields = [\"p_sp\", \"-q_sp\", \"-r_sp\"], unit = \"deg/s\" }
  thrust = { field = \"throttle\", scale = 0.01 }   # 0..1; or mean = [\"u0\", \"u1\", \"u2\", \"u3\"]
  [imu]
  gyro = { fields = [\"p\", \"q\", \"r\"] }
  specific_force = { fields = [\"ax\", \"ay\", \"az\"], unit = \"g\" }
  rotation_deg = [0, 0, 0]         # roll, pitch, yaw of the mounting
  [odometry]
  position = { fields = [\"x\", \"y\", \"z\"] }
  attitude = { fields = [\"qw\", \"qx\", \"qy\", \"qz\"] }
  velocity = { fields = [\"vx\", \"vy\", \"vz\"] }
  velocity_frame = \"world\"         # or body
  [battery]
  voltage = { field = \"vbat\", unit = \"mV\" }
  current = { field = \"amps\" }
  [rotors]
  speed = { fields = [\"n0\", \"n1\", \"n2\", \"n3\"], unit = \"rpm\" }   # 1 to 8; \"n4?\": a file may lack it
  [motors]
  command = { fields = [\"m0\", \"m1\", \"m2\", \"m3\"], scale = [0.001], offset = [-1, -1, -1, -1] }   # 0..1
  [states]
  armed = { field = \"arming\", equals = [2] }   # leave equals out for any number but 0
  in_air = { field = \"landed\", equals = [0] }
  [vehicle]                        # for files that do not say
  mass_kg = 0.8
  max_rate_deg_s = [670, 670, 400]

Exit code 3: the file was damaged; what could be read of it was written.";

/// Reads, says what was found, writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let file = Reserved::new(&args.out, "--out")?;
    let options = Options { mapping: args.mapping.as_deref(), flight: args.flight };
    let opened = flight::open_with(&args.file, options)?;
    opened.remarks.iter().for_each(|remark| tell(remark));
    let log = &opened.log;
    let written = file.write(&flight::write::mcap(log)?)?;
    super::print(&format!("{}, mapping {}\n\n{}", log.name, opened.mapping, found(log)))?;
    tell(&format!("written to {}", written.display()));
    match &log.readable {
        Readable::Whole => Ok(CommandEnd::Done),
        Readable::Prefix { bytes, of, why } => {
            tell(&format!("damaged: {why}; read {bytes} of {of} bytes"));
            Ok(CommandEnd::Damaged)
        }
    }
}

/// A line a stream, and what is missing.
fn found(log: &Log) -> String {
    let rows = vec![
        row("setpoint", &log.setpoint, &[("rate", 0..3), ("thrust", 3..4)]),
        row("imu", &log.imu, &[("gyro", 0..3), ("specific force", 3..6)]),
        row("odometry", &log.odometry, &[("position", 0..3), ("attitude", 3..7), ("velocity", 7..10)]),
        row("battery", &log.battery, &[("voltage", 0..1), ("current", 1..2)]),
        row("rotors", &log.rotors, &[("speed", 0..MOTORS)]),
        row("motors", &log.motors, &[("command", 0..MOTORS)]),
        row("states", &log.states, &[("armed", 0..1), ("in the air", 1..2)]),
    ];
    let table = columns::table(&["stream", "rows", "rate, Hz", "from, s", "to, s", "lacks"], rows, 1..5);
    let show = |value: Option<String>| value.unwrap_or("unknown".into());
    let mass = show(log.vehicle.mass_kg.map(|mass| format!("{mass} kg")));
    let rates = show(log.vehicle.max_rate_rad_s.map(|rates| format!("{:.0?} deg/s", rates.map(f64::to_degrees))));
    let kind = show(log.vehicle.kind.map(|kind| kind.name().replace('_', " ")));
    let counts = [("rotors", log.rotors.count()), ("motors", log.motors.count())];
    let of = counts.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!(", {name} of {n}")).collect::<String>();
    format!("{table}\nmass {mass}, full-stick rates {rates}, vehicle {kind}{of}")
}

fn row<const N: usize>(name: &str, stream: &Stream<N>, parts: &[(&str, std::ops::Range<usize>)]) -> Vec<String> {
    let times = || stream.time_s.iter().copied();
    let (from, to) = (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
    if stream.is_empty() {
        return [name, "none", "", "", "", ""].map(String::from).into();
    }
    let rate = (stream.len() - 1) as f64 / (to - from);
    let rate = if rate.is_finite() { format!("{rate:.1}") } else { "-".into() };
    let lacks = |columns: &std::ops::Range<usize>| {
        stream.rows.iter().all(|row| row[columns.clone()].iter().all(|x| x.is_nan()))
    };
    let lacking: Vec<&str> = parts.iter().filter(|(_, columns)| lacks(columns)).map(|(part, _)| *part).collect();
    let numbers = [rate, format!("{from:.2}"), format!("{to:.2}"), lacking.join(", ")];
    [name.to_string(), stream.len().to_string()].into_iter().chain(numbers).collect()
}
