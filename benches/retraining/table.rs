//! What came of it, a line for each policy and world.

use crate::program::Simulated;
use crate::race::Raced;
use crate::share::Share;
use racer::base::stats::quantile;
use std::collections::BTreeMap;
use std::path::Path;

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
    /// Times of the laps that were completed, s.
    fn laps(&self) -> Vec<f64> {
        self.flights.iter().filter_map(|flight| flight.lap_s).collect()
    }

    pub fn line(&self) -> String {
        let completed = Share::count(self.flights.iter().map(|flight| flight.lap_s.is_some()));
        let laps = self.laps();
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

/// Writes every row as a line of CSV.
///
/// # Panics
///
/// Where the file cannot be written.
pub fn write(path: &Path, rows: &[Row]) {
    let mut out = csv::Writer::from_path(path).expect("the CSV");
    out.write_record([
        "effect",
        "size",
        "seed",
        "trained",
        "laps",
        "flown",
        "lap_s",
        "simulated_percent",
        "simulated_s",
    ])
    .expect("the columns");
    let number = |x: Option<f64>, digits: usize| x.map_or(String::new(), |x| format!("{x:.digits$}"));
    for row in rows {
        let laps = row.laps();
        let median = (!laps.is_empty()).then(|| quantile(&laps, 0.5));
        let simulated = [row.simulated.map(|s| 100.0 * s.completion), row.simulated.and_then(|s| s.lap_s)];
        let fields = [
            row.effect.clone(),
            row.size.to_string(),
            row.seed.to_string(),
            row.trained.to_string(),
            laps.len().to_string(),
            row.flights.len().to_string(),
            number(median, 3),
            number(simulated[0], 1),
            number(simulated[1], 3),
        ];
        out.write_record(fields).expect("a line");
    }
    out.flush().expect("the CSV");
}
