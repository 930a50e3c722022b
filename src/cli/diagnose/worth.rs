//! What an extension means for racing: policies flown with it and without.

use crate::base::error::Result;
use crate::base::threads::processors;
use crate::cli::columns;
use crate::cli::training::ShownTraining;
use crate::model::vehicle::Vehicle;
use crate::present::retrain::{fly, retrain};
use crate::present::run;
use crate::race::eval::score::Benchmark;
use crate::race::snapshot::Snapshot;
use std::path::Path;

/// A line of the table: how a policy was trained, what it flew in, and how that went.
type FlownLine = (String, &'static str, Benchmark);

/// The table of `policy` flown in the base and in the extended vehicle.
pub fn present(policy: &str, base: &Vehicle, extended: &Vehicle) -> Result<String> {
    let snapshot = Snapshot::read(&run::find(policy)?.snapshot)?;
    let flown = [("base", base), ("extended", extended)]
        .into_iter()
        .map(|(name, vehicle)| Ok((policy.into(), name, fly(&snapshot, vehicle)?)))
        .collect::<Result<Vec<_>>>()?;
    Ok(table(&flown))
}

/// The table of two policies, one trained in each vehicle for `minutes` in the folder `to`, flown in the extended one.
pub fn retrained(to: &Path, minutes: f64, base: &Vehicle, extended: &Vehicle) -> Result<String> {
    let vehicles = [("base", base), ("extended", extended)];
    let flown = retrain(to, minutes, vehicles, processors(), &mut ShownTraining::new())?;
    let line = |(name, result)| (format!("trained in the {name} vehicle"), "extended", result);
    Ok(table(&flown.into_iter().map(line).collect::<Vec<_>>()))
}

fn table(flown: &[FlownLine]) -> String {
    let rows = flown.iter().map(|(policy, vehicle, result)| {
        let lap = result.lap_time_s.map_or("-".into(), |t| format!("{:.2}", t.median));
        let laps = format!("{:.1} of {}", 100.0 * result.lap_completion, result.agents);
        vec![policy.clone(), vehicle.to_string(), laps, lap, format!("{:.1}", result.top_speed_m_s)]
    });
    columns::table(&["policy", "flown in", "laps, %", "median lap, s", "top speed, m/s"], rows.collect(), 2..5)
}
