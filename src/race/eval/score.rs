//! What flights are worth: the metrics of an evaluation, each defined here and nowhere else.

use super::fly::{EvaluatedFlight, Flights};
use crate::base::stats;
use crate::model::track::Track;
use crate::race::env::terminate::CAUSES;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One start distribution's result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Benchmark {
    /// Vehicles that flew.
    pub agents: usize,
    /// Share of agents that passed all gates in order and the first one again.
    pub lap_completion: f64,
    /// Time from the first crossing of the first gate to the next, over completed laps; none where no lap was
    /// completed.
    pub lap_time_s: Option<LapTime>,
    /// Gates that they passed.
    pub gates_passed: GatesPassed,
    /// Highest speed of any agent, m/s.
    pub top_speed_m_s: f64,
    /// Share of commands with |a| > 0.95 over the first four seconds, all agents while they fly.
    pub saturated_share: f64,
    /// Mean of |a_t - a_(t-1)|^2 over the first four seconds, all agents while they fly.
    pub mean_action_change_sq: f64,
    /// Agents that failed, by the gate they were flying to and the cause; those that ran out of steps as "out_of_time".
    pub failures_by_gate: BTreeMap<String, BTreeMap<String, usize>>,
    /// Share of agents that passed each section: its last gate, having passed its first.
    pub sections: BTreeMap<String, f64>,
}

/// Lap times over the vehicles that completed one, s.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct LapTime {
    /// Half of them are faster.
    pub median: f64,
    /// 5 % are faster.
    pub p05: f64,
    /// 95 % are faster.
    pub p95: f64,
    /// The fastest.
    pub best: f64,
}

/// Gates passed, over all vehicles.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct GatesPassed {
    /// Half of them passed no more.
    pub median: f64,
    /// The mean.
    pub mean: f64,
}

/// Scores `flights` on `track`.
pub fn score(track: &Track, all: &Flights) -> Benchmark {
    let flights = &all.flights;
    let gates = track.gates.len();
    let agents = flights.len();
    let laps: Vec<f64> = flights.iter().filter_map(|f| f.lap_time(gates)).collect();
    let passed: Vec<f64> = flights.iter().map(|f| f.passes.len() as f64).collect();
    let mut failures_by_gate: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for flight in flights.iter().filter(|f| f.passes.len() <= gates) {
        let gate = (flight.first_gate + flight.passes.len()) % gates;
        let cause = flight.failure.map_or("out_of_time", |c| CAUSES[c]);
        *failures_by_gate.entry(track.gate_label(gate)).or_default().entry(cause.into()).or_default() += 1;
    }
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let total = |f: fn(&EvaluatedFlight) -> f64| flights.iter().map(f).sum::<f64>();
    Benchmark {
        agents,
        lap_completion: share(laps.len() as f64, agents as f64),
        lap_time_s: (!laps.is_empty()).then(|| LapTime {
            median: stats::quantile(&laps, 0.5),
            p05: stats::quantile(&laps, 0.05),
            p95: stats::quantile(&laps, 0.95),
            best: stats::quantile(&laps, 0.0),
        }),
        gates_passed: GatesPassed { median: stats::quantile(&passed, 0.5), mean: stats::mean(&passed) },
        top_speed_m_s: flights.iter().map(|f| f.top_speed).fold(0.0, f64::max),
        saturated_share: share(total(|f| f64::from(f.saturated)), total(|f| f64::from(f.commands))),
        mean_action_change_sq: share(total(|f| f.action_change), total(|f| f64::from(f.changes))),
        failures_by_gate,
        sections: track
            .sections
            .iter()
            .map(|section| {
                let [first, last] = [section.gates[0], section.gates[section.gates.len() - 1]];
                let done = flights.iter().filter(|f| passed_section(f, first, last, gates)).count();
                (section.name.clone(), share(done as f64, agents as f64))
            })
            .collect(),
    }
}

/// Whether the flight passed gate `last` after gate `first` (or as the same gate).
fn passed_section(flight: &EvaluatedFlight, first: usize, last: usize, gates: usize) -> bool {
    let order = |gate: usize| (gate + gates - flight.first_gate) % gates;
    let entered = order(first);
    let length = (last + gates - first) % gates;
    flight.passes.len() > entered + length
}
