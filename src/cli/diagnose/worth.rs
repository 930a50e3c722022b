//! What an extension means for racing: policies flown with it and without.

use crate::base::check::BadInput;
use crate::base::fsio::{new_folder, write_new};
use crate::base::lane::Level;
use crate::cli::pool::{pool, threads};
use crate::cli::{columns, tell, train};
use crate::model::vehicle::Vehicle;
use crate::present::run;
use crate::race::env::Race;
use crate::race::env::reset::Place;
use crate::race::eval::benchmark;
use crate::race::eval::score::Benchmark;
use crate::race::snapshot::Snapshot;
use std::path::{Path, PathBuf};

/// A policy in a vehicle: how it was trained, what it flew in, and how that went.
struct Flown {
    policy: String,
    vehicle: &'static str,
    result: Benchmark,
}

/// From the pad, with the random numbers of the policy's own seed, whatever the vehicle.
fn fly(policy: &str, vehicle: &Vehicle) -> anyhow::Result<Benchmark> {
    let found = run::find(policy)?;
    let Snapshot { network, about } = Snapshot::read(&found.snapshot)?;
    let race = Race::new(&about.env, &about.track, vehicle, about.seed).seen_as(&about.vehicle);
    let fly = || benchmark(Level::best(), &race, &about.track, &network, Place::Pad, &about.eval).0;
    Ok(pool(threads(None))?.install(fly))
}

/// The table of `policy` flown in the base and in the extended vehicle.
pub fn present(policy: &str, base: &Vehicle, extended: &Vehicle) -> anyhow::Result<String> {
    let flown = [("base", base), ("extended", extended)]
        .into_iter()
        .map(|(name, vehicle)| Ok(Flown { policy: policy.into(), vehicle: name, result: fly(policy, vehicle)? }))
        .collect::<anyhow::Result<Vec<_>>>()?;
    Ok(table(&flown))
}

/// Trains one policy in each vehicle for `minutes` in the new folder `to`, and flies both in the extended one.
pub fn retrain(to: &Path, minutes: f64, base: &Vehicle, extended: &Vehicle) -> anyhow::Result<String> {
    let mut flown = Vec::new();
    for (name, vehicle) in [("base", base), ("extended", extended)] {
        let file = to.join(format!("{name}.toml"));
        write_new(&file, toml::to_string(vehicle)?.as_bytes())?;
        let folder = to.join(name);
        tell(&format!("training {minutes} minutes in the {name} vehicle"));
        train::run(&train::Args::in_vehicle(&file, minutes, &folder))?;
        let policy = folder.display().to_string();
        let result = fly(&policy, extended)?;
        flown.push(Flown { policy: format!("trained in the {name} vehicle"), vehicle: "extended", result });
    }
    Ok(table(&flown))
}

/// A folder that can be trained into.
pub fn folder(path: &Path) -> Result<PathBuf, BadInput> {
    new_folder(path)?;
    Ok(path.into())
}

fn table(flown: &[Flown]) -> String {
    let rows = flown.iter().map(|f| {
        let lap = f.result.lap_time_s.map_or("-".into(), |t| format!("{:.2}", t.median));
        let laps = format!("{:.1} of {}", 100.0 * f.result.lap_completion, f.result.agents);
        vec![f.policy.clone(), f.vehicle.to_string(), laps, lap, format!("{:.1}", f.result.top_speed_m_s)]
    });
    columns::table(&["policy", "flown in", "laps, %", "median lap, s", "top speed, m/s"], rows.collect(), 2..5)
}
