//! What came of it, a line for each policy and world.

use crate::program::Simulated;
use crate::race::Raced;
use crate::share::Share;
use racer::base::stats::quantile;
use std::collections::BTreeMap;

pub const HEADER: &str = "effect                     size  seed  trained in  laps completed in truth, 95 % interval    \
                          median lap  in racer's simulator  failures in truth";

/// A policy in a world.
pub struct Row {
    pub effect: String,
    pub size: f64,
    pub seed: u64,
    pub trained: &'static str,
    pub flights: Vec<Raced>,
    /// In racer's own simulator of the extended vehicle.
    pub simulated: Option<Simulated>,
}

impl Row {
    pub fn line(&self) -> String {
        let completed = Share::count(self.flights.iter().map(|flight| flight.lap_s.is_some()));
        let laps: Vec<f64> = self.flights.iter().filter_map(|flight| flight.lap_s).collect();
        let lap = (!laps.is_empty()).then(|| quantile(&laps, 0.5));
        let simulated = self.simulated.map_or("-".into(), |simulated| {
            format!("{:.1} %  {} s", 100.0 * simulated.completion, time(simulated.lap_s))
        });
        let mut failures = BTreeMap::new();
        for failure in self.flights.iter().filter_map(|flight| flight.failure) {
            *failures.entry(failure).or_insert(0) += 1;
        }
        let failures: Vec<String> = failures.iter().map(|(cause, count)| format!("{cause} {count}")).collect();
        let (completed, lap) = (completed.text(), format!("{} s", time(lap)));
        format!(
            "{:<24}{:>7}{:>6}  {:<10}  {completed:<40}  {lap:>10}  {simulated:>20}  {}",
            self.effect,
            self.size,
            self.seed,
            self.trained,
            failures.join(", ")
        )
    }
}

/// As printed; a dash where there is none.
pub fn time(seconds: Option<f64>) -> String {
    seconds.map_or("-".into(), |seconds| format!("{seconds:.3}"))
}

pub fn print(rows: &[Row]) {
    println!("\n{HEADER}");
    for row in rows {
        println!("{}", row.line());
    }
}
