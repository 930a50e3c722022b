//! `racer fly`: a flight in the simulator, recorded.

use super::{CommandEnd, tell};
use crate::base::check::BadInput;
use crate::base::document::nearest;
use crate::base::fsio::Reserved;
use crate::base::lane::Level;
use crate::flight::fly::{Flown, LONGEST_S, by_pilot, by_policy, check_pilot, in_order};
use crate::flight::pilot::Manoeuvre;
use crate::flight::planned::FlightPlan;
use crate::flight::sensors::SensorConfig;
use crate::flight::{Log, Stream, write};
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::present::run;
use crate::race::env::Race;
use crate::race::snapshot::{About, Snapshot};
use std::fmt::Write;
use std::path::PathBuf;

/// Fly a policy, or the excitation pilot, in the simulator and record a log
#[derive(Debug, clap::Args)]
#[command(after_help = help())]
pub struct Args {
    /// A run folder (its best policy), a snapshot file, or `latest` for the youngest run below runs/
    #[arg(value_name = "RUN|SNAPSHOT|latest", conflicts_with = "pilot")]
    policy: Option<String>,
    /// Fly the manoeuvres that identification needs, from the ground to the landing
    #[arg(long)]
    pilot: bool,
    /// Only these manoeuvres of the pilot, separated by commas
    #[arg(long, value_name = "NAME", value_delimiter = ',', requires = "pilot")]
    manoeuvres: Vec<String>,
    /// Exactly the manoeuvres of this plan, which `racer diagnose --plan-out` writes, and then land
    #[arg(long, value_name = "FILE", requires = "pilot", conflicts_with = "manoeuvres")]
    plan: Option<PathBuf>,
    /// Vehicle: a name or a file [default: the policy's own; seed_class for the pilot]
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Track: a name or a file [default: the policy's own]
    #[arg(long, value_name = "NAME|FILE", conflicts_with = "pilot")]
    track: Option<String>,
    /// Longest flight, s [default: 60; 300 for the pilot; what a plan needs]
    #[arg(long, allow_negative_numbers = true, value_parser = super::values::parse_seconds)]
    seconds: Option<f64>,
    /// Sensors: a name or a file, looked for here, in configs/sensors/ and among the built-in ones
    #[arg(long, value_name = "NAME|FILE", default_value = "typical")]
    sensors: String,
    /// Where all random numbers start: manoeuvres and the errors of the sensors
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// New file for the log (MCAP)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

const HELP: &str =
    "A policy races from the pad, lap after lap, until it fails. The pilot lands when the time is up or the \
battery empty. Built-in sensors: ideal, typical.

Examples:
  racer fly --pilot --out pilot.mcap
  racer fly --pilot --manoeuvres punch,chop --seconds 60 --vehicle mine.toml --out thrust.mcap
  racer fly --pilot --plan plan.toml --vehicle mine.toml --out next.mcap
  racer fly latest --seconds 30 --sensors ideal --out laps.mcap";

/// The help with the names of all manoeuvres.
fn help() -> String {
    let names: Vec<_> = Manoeuvre::ALL.into_iter().map(Manoeuvre::name).collect();
    format!("{HELP}\n\nManoeuvres: {}", names.join(", "))
}

/// Thrust over weight of the vehicles that the pilot is made for.
const PILOT_THRUST: [f64; 2] = [2.5, 8.0];

/// Flies, records and writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    if args.policy.is_none() && !args.pilot {
        let advice = "name a run or a snapshot, or give --pilot";
        return Err(BadInput::new("racer fly", "nothing to fly", "a policy, or the pilot", advice).into());
    }
    let sensors = SensorConfig::load(&args.sensors)?;
    let file = Reserved::new(&args.out, "--out")?;
    let flown = match &args.policy {
        Some(policy) => fly_policy(args, policy, &sensors)?,
        None => fly_pilot(args, &sensors)?,
    };
    let written = file.write(&write::mcap(&flown.log)?)?;
    super::print(&summary(&flown))?;
    tell(&format!("written to {}", written.display()));
    Ok(CommandEnd::Done)
}

fn fly_policy(args: &Args, policy: &str, sensors: &SensorConfig) -> anyhow::Result<Flown> {
    let Snapshot { network, about } = Snapshot::read(&run::find(policy)?.snapshot)?;
    let About { track, vehicle, env, .. } = about;
    let track = args.track.as_deref().map_or(Ok(track), Track::load)?;
    let other = args.vehicle.as_deref().map(Vehicle::load).transpose()?;
    let race = Race::new(&env, &track, other.as_ref().unwrap_or(&vehicle), args.seed).seen_as(&vehicle).scored(&track);
    Ok(by_policy(Level::best(), &race, &network, sensors, args.seed, args.seconds.unwrap_or(60.0)))
}

fn fly_pilot(args: &Args, sensors: &SensorConfig) -> anyhow::Result<Flown> {
    let kinds = args.manoeuvres.iter().map(|name| named(name)).collect::<Result<Vec<_>, _>>()?;
    let plan = args.plan.as_deref().map(FlightPlan::read).transpose()?;
    let needed = plan.as_ref().map_or(300.0, FlightPlan::enough_s);
    let seconds = args.seconds.unwrap_or(needed.min(LONGEST_S));
    check_pilot("--seconds", seconds)?;
    let vehicle = Vehicle::load(args.vehicle.as_deref().unwrap_or("seed_class"))?;
    let ratio = vehicle.thrust_to_weight();
    let [low, high] = PILOT_THRUST;
    if !(low..=high).contains(&ratio) {
        tell(&format!("the pilot is made for {low} to {high} times the weight in thrust; this vehicle has {ratio:.1}"));
    }
    if let Some(plan) = plan {
        return Ok(fly_plan(&plan, &vehicle, sensors, args.seed, seconds));
    }
    let flown = by_pilot(&vehicle, sensors, &kinds, args.seed, seconds);
    if flown.seconds < seconds - 20.0 {
        tell(&format!("landed after {:.0} s: the battery was empty", flown.seconds));
    }
    Ok(flown)
}

fn fly_plan(plan: &FlightPlan, vehicle: &Vehicle, sensors: &SensorConfig, seed: u64, seconds: f64) -> Flown {
    let order = plan.order();
    let (flown, manoeuvres) = in_order(vehicle, sensors, &order, seed, seconds);
    if manoeuvres.len() < order.len() {
        let (done, all) = (manoeuvres.len(), order.len());
        tell(&format!("landed after {done} of {all} manoeuvres: the time was up, or the battery empty"));
    }
    flown
}

fn named(name: &str) -> Result<Manoeuvre, BadInput> {
    Manoeuvre::named(name).ok_or_else(|| {
        let advice = match nearest(name, Manoeuvre::ALL.into_iter().map(Manoeuvre::name)) {
            Some(near) => format!("did you mean `{near}`? `racer fly --help` lists them"),
            None => "`racer fly --help` lists them".into(),
        };
        BadInput::new(format!("--manoeuvres {name}"), "no such manoeuvre", "a manoeuvre of the pilot", advice)
    })
}

/// The flight and what each stream holds.
fn summary(flown: &Flown) -> String {
    let mut text = format!("flown      {:.1} s, top speed {:.1} m/s\n", flown.seconds, flown.top_speed);
    if let Some(failure) = flown.failure {
        let _ = writeln!(text, "ended by   {}", failure.replace('_', " "));
    }
    if !flown.laps.is_empty() {
        let times: Vec<_> = flown.laps.iter().map(|lap| format!("{lap:.2}")).collect();
        let _ = writeln!(text, "laps       {} s", times.join(", "));
    }
    let Log { setpoint, imu, odometry, battery, .. } = &flown.log;
    for (name, (samples, rate)) in
        [("setpoint", size(setpoint)), ("imu", size(imu)), ("odometry", size(odometry)), ("battery", size(battery))]
    {
        let _ = writeln!(text, "{name:<10} {samples} samples at {rate:.0} Hz");
    }
    text.trim_end().into()
}

/// Samples of a stream, and how many a second.
fn size<const N: usize>(stream: &Stream<N>) -> (usize, f64) {
    let span = stream.time_s.last().zip(stream.time_s.first()).map_or(0.0, |(last, first)| last - first);
    let rate = if span > 0.0 { (stream.len() - 1) as f64 / span } else { 0.0 };
    (stream.len(), rate)
}
