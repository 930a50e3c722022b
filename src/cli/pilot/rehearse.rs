//! `racer pilot --rehearse`: a flight on the ground, through a flight controller's own firmware.

mod start;

use super::super::{CommandEnd, interrupt, outputs, print, tell};
use crate::base::lane::Level;
use crate::base::stats::mean;
use crate::flight::fly;
use crate::flight::live::phase::Reason;
use crate::flight::live::{Live, Mission};
use crate::flight::open::open_bytes;
use crate::flight::pilot::{Pilot, PilotLimits};
use crate::flight::rehearse::firmware::Firmware;
use crate::flight::rehearse::{Rehearsal, flown};
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, Options, write};
use crate::model::vehicle::Vehicle;
use crate::race::onboard::Surroundings;
use crate::race::snapshot::Snapshot;
use anyhow::Context;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Options of a rehearsal.
#[derive(Debug, clap::Args)]
#[group(skip)]
#[command(next_help_heading = "Rehearsal")]
pub struct Args {
    /// Fly a simulated vehicle through the real firmware of a flight controller
    #[arg(long, value_name = "FIRMWARE", requires = "firmware", conflicts_with_all = ["input", "output"])]
    pub rehearse: Option<Kind>,
    /// The firmware's own simulator build
    #[arg(long, value_name = "PATH", requires = "rehearse")]
    firmware: Option<PathBuf>,
    /// Your own settings of the firmware: command lines, such as Betaflight's `diff all`, or a parameter file of
    /// ArduPilot; racer sets rates, arming and log over them
    #[arg(long, value_name = "FILE", requires = "rehearse")]
    settings: Option<PathBuf>,
    /// The vehicle that is flown: a name or a file [default: the policy's own; seed_class for the pilot]
    #[arg(long, value_name = "NAME|FILE", requires = "rehearse")]
    vehicle: Option<String>,
    /// Its inertia about x, y, z, kg m2 [default: of an even ellipsoid with the drag's semi-axes]
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', requires = "rehearse")]
    inertia: Option<Vec<f64>>,
    /// From its centre of mass to a rotor, m [default: the drag's longer horizontal semi-axis]
    #[arg(long, value_name = "M", requires = "rehearse")]
    arm_length: Option<f64>,
    /// Torque of a rotor over its thrust, m [default: 0.016]
    #[arg(long, value_name = "M", requires = "rehearse")]
    torque: Option<f64>,
    /// Sensors of firmware and log: a name or a file, as in `racer fly`
    #[arg(long, value_name = "NAME|FILE", default_value = "typical", requires = "rehearse")]
    sensors: String,
    /// Fly the manoeuvres that identification needs instead of a policy, for so many seconds
    #[arg(long, value_name = "SECONDS", requires = "rehearse", conflicts_with_all = ["policy", "laps"])]
    pub excite: Option<f64>,
    /// Where the random numbers of sensors and manoeuvres start
    #[arg(long, default_value_t = 1, requires = "rehearse")]
    seed: u64,
    /// Whose time it goes by: `lockstep` gives the firmware racer's (Betaflight: on Linux, with `cc`), `wall` is real
    /// time (Betaflight alone)
    #[arg(long, value_name = "CLOCK", default_value = "lockstep", requires = "rehearse")]
    clock: ClockKind,
    /// New file for the firmware's own log: Betaflight's blackbox, ArduPilot's .BIN
    #[arg(long, value_name = "FILE", requires = "rehearse")]
    blackbox: Option<PathBuf>,
}

/// Firmwares that can be rehearsed with.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Kind {
    Betaflight,
    #[value(name = "ardupilot")]
    ArduPilot,
}

/// See [`SharedClock`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum ClockKind {
    Lockstep,
    Wall,
}

/// What `racer pilot` itself was asked for.
pub struct Asked<'a> {
    pub policy: Option<Snapshot>,
    pub laps: Option<u32>,
    pub seconds: f64,
    pub log: Option<&'a Path>,
}

const LAPS: u32 = 3;
/// How much a firmware's clock may go wrong before the user is told.
const DRIFT: f64 = 0.01;

/// Sets up, flies, reports.
pub fn run(args: &Args, asked: Asked) -> anyhow::Result<CommandEnd> {
    let sensors = SensorConfig::load(&args.sensors)?;
    let own = asked.policy.as_ref().map_or("seed_class".to_string(), |p| p.about.vehicle.name.clone());
    let vehicle = match (&args.vehicle, &asked.policy) {
        (Some(name), _) => Vehicle::load(name)?,
        (None, Some(policy)) => policy.about.vehicle.clone(),
        (None, None) => Vehicle::load(&own)?,
    };
    let [log, blackbox] = outputs::reserve([("--log", asked.log), ("--blackbox", args.blackbox.as_deref())])?;
    interrupt::watch("ending the flight; Ctrl-C again ends at once");
    let full_rate = match &asked.policy {
        Some(policy) => Surroundings::of(&policy.about.track, &policy.about.vehicle).full_rate,
        None => vehicle.max_rates_rad_s(),
    };
    let flight = Flight { args, vehicle: &vehicle, sensors: &sensors, full_rate };
    let (rehearsal, firmware, end) = match &asked.policy {
        Some(policy) => flight.by_policy(policy, &asked)?,
        None => flight.by_pilot(args.excite.unwrap_or(asked.seconds))?,
    };
    remarks(&rehearsal, &firmware);
    for (file, bytes) in [(log, Some(write::mcap(&rehearsal.log)?)), (blackbox, firmware.blackbox())] {
        match (file, bytes) {
            (Some(file), Some(bytes)) => tell(&format!("written to {}", file.write(&bytes)?.display())),
            (Some(_), None) => tell("the firmware wrote no log of its own"),
            (None, _) => {}
        }
    }
    Ok(end)
}

/// A flight that is set up.
struct Flight<'a> {
    args: &'a Args,
    vehicle: &'a Vehicle,
    sensors: &'a SensorConfig,
    full_rate: [f64; 3],
}

impl<'a> Flight<'a> {
    fn by_policy(&self, policy: &Snapshot, asked: &Asked) -> anyhow::Result<(Rehearsal<'a>, Firmware, CommandEnd)> {
        let about = &policy.about;
        let laps = asked.laps.unwrap_or(LAPS);
        let forecast = forecast(policy, laps as usize);
        let (track, network) = (about.track.clone(), policy.network.clone());
        let own = about.vehicle.clone();
        let mission = Mission { network, range: policy.ranges(), track, vehicle: own, laps: Some(laps), lead: 0 };
        let around = Surroundings::of(&mission.track, &mission.vehicle);
        let mut live = Live::new(&mission, &around);
        let start = &mission.track.start;
        let (mut rehearsal, firmware) = self.begin(start.position_m, start.heading_rad())?;
        tell(&format!("{} trained in {}, flown in {}", about.track.name, about.vehicle.name, self.vehicle.name));
        flown::by_policy(&mut rehearsal, &mut live, self.full_rate, asked.seconds, &interrupt::asked)
            .with_context(|| firmware.last_words())?;
        let crossings: Vec<f64> = live.passes.iter().step_by(mission.track.gates.len()).copied().collect();
        let flown: Vec<f64> = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
        print(&summary(&forecast, &flown, live.gates, live.machine.reason))?;
        let done = live.machine.reason == Some(Reason::LapsDone);
        Ok((rehearsal, firmware, if done { CommandEnd::Done } else { CommandEnd::NotMet }))
    }

    fn by_pilot(&self, seconds: f64) -> anyhow::Result<(Rehearsal<'a>, Firmware, CommandEnd)> {
        fly::check_pilot("--excite", seconds)?;
        let battery = &self.vehicle.battery;
        let limits = PilotLimits {
            max_rate_rad_s: self.full_rate,
            hover_command: self.vehicle.hover_command(0.5 * (battery.full_v + battery.empty_v)),
            seconds,
            empty_v: battery.empty_v,
        };
        let mut pilot = Pilot::new(self.args.seed, limits);
        let (mut rehearsal, firmware) = self.begin([0.0; 3], 0.0)?;
        flown::by_pilot(&mut rehearsal, &mut pilot, self.full_rate, seconds, &interrupt::asked)
            .with_context(|| firmware.last_words())?;
        let end = if rehearsal.plant.resting { CommandEnd::Done } else { CommandEnd::NotMet };
        let landed = if rehearsal.plant.resting { "landed" } else { "not landed" };
        print(&format!("flown      {:.1} s, {landed}", rehearsal.time_s()))?;
        Ok((rehearsal, firmware, end))
    }
}

/// Lap times of the policy in its own vehicle, s.
fn forecast(policy: &Snapshot, laps: usize) -> Vec<f64> {
    let sensors = SensorConfig::load("ideal").ok();
    let seconds = policy.about.eval.max_steps as f64 * 0.01 * (laps + 1) as f64;
    let race = policy.race(None);
    let flight = sensors.map(|s| fly::by_policy(Level::best(), &race, &policy.network, &s, 1, seconds.min(3600.0)));
    flight.map_or(Vec::new(), |flight| flight.laps.into_iter().take(laps).collect())
}

fn summary(forecast: &[f64], flown: &[f64], gates: u32, end: Option<Reason>) -> String {
    let mut text = String::from("lap   forecast      flown\n");
    for lap in 0..forecast.len().max(flown.len()) {
        let cell = |times: &[f64]| times.get(lap).map_or("-".to_string(), |time| format!("{time:.3} s"));
        let _ = writeln!(text, "{:<5}{:>9}{:>11}", lap + 1, cell(forecast), cell(flown));
    }
    let both = forecast.len().min(flown.len());
    if both > 0 {
        let [expected, found] = [forecast, flown].map(|times| mean(&times[..both]));
        let share = 100.0 * (found / expected - 1.0);
        let _ = writeln!(text, "mean {expected:>9.3} s{found:>9.3} s  ({share:+.1} % of the forecast)");
    }
    let _ = write!(text, "gates {gates} passed; ended: {}", end.map_or("", Reason::text));
    text
}

/// What the user should know of clocks and settings.
fn remarks(rehearsal: &Rehearsal, firmware: &Firmware) {
    if let Some([late, all]) = rehearsal.late()
        && late > 0
    {
        tell(&format!("{late} of {all} steps were late: real time was not kept, and lap times mean less"));
    }
    let span = |log: &Log| log.imu.time_s.last().zip(log.imu.time_s.first()).map_or(0.0, |(last, first)| last - first);
    let blackbox = firmware.blackbox();
    let logged = blackbox.and_then(|bytes| open_bytes(Path::new("blackbox.bfl"), &bytes, Options::default()).ok());
    let spans = logged.map(|logged| (span(&logged.log), span(&rehearsal.log)));
    // It logs from when it is armed, and has first to write a header.
    if let Some((logged, flown)) = spans.filter(|(logged, flown)| (logged - flown).abs() > 2.0 + DRIFT * flown) {
        let off = "its filters and lags are off by as much";
        tell(&format!("the firmware's clock shows {logged:.1} s in {flown:.1} s of flight: {off}"));
    }
}
