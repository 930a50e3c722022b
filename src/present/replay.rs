//! A flight to be shown: where each vehicle was, what it was told, and through which gates it flew.
//!
//! Made of a policy's race in the simulator ([`race`]) or of a flight log ([`recorded`]); shown as an MCAP file for
//! Foxglove ([`mcap`]) or as a page ([`crate::present::report::replay`]).

mod foxglove;
mod layout;
mod log;
pub mod mcap;
mod schema;
mod simulated;
pub mod timed;

pub use layout::layout;
pub use log::recorded;
pub use simulated::race;

use crate::model::track::Track;
use crate::race::env::observe::OBSERVATIONS;

/// Vehicles in the world of one track, or of none.
#[derive(Clone, Debug)]
pub struct Replay {
    pub title: String,
    /// When time 0 was, ns since 1970, or since the clock of the source started.
    pub start_ns: u64,
    pub track: Option<Track>,
    /// The first is looked at; the others are beside it to compare.
    pub vehicles: Vec<ReplayVehicle>,
}

/// One vehicle's flight.
#[derive(Clone, Debug)]
pub struct ReplayVehicle {
    pub name: String,
    /// In the order of time.
    pub frames: Vec<ReplayFrame>,
    /// Gates that were passed: when, s, and which, by its place on the track.
    pub passes: Vec<(f64, usize)>,
    /// Times from one crossing of the first gate to the next, s.
    pub laps: Vec<f64>,
    /// Why the flight ended, in words, where it failed.
    pub failure: Option<String>,
}

/// One moment of a flight. NaN stands for what is not known.
#[derive(Clone, Copy, Debug)]
pub struct ReplayFrame {
    pub time_s: f64,
    /// World, m.
    pub position: [f64; 3],
    /// World, m/s.
    pub velocity: [f64; 3],
    /// Body to world, w x y z.
    pub attitude: [f64; 4],
    /// Body, rad/s.
    pub rates: [f64; 3],
    /// Roll, pitch, yaw rate and thrust, -1 to 1.
    pub command: [f64; 4],
    pub voltage: f64,
    /// The gate that is flown to, by its place on the track.
    pub target: Option<usize>,
    /// What the policy saw, as the network gets it.
    pub observation: Option<[f32; OBSERVATIONS]>,
}

impl ReplayFrame {
    /// m/s
    pub fn speed(&self) -> f64 {
        self.velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
    }
}

/// Times from each crossing of the first gate that was passed to its next, s.
fn laps(passes: &[(f64, usize)]) -> Vec<f64> {
    let Some(&(_, first)) = passes.first() else { return Vec::new() };
    let times: Vec<f64> = passes.iter().filter(|(_, gate)| *gate == first).map(|(time, _)| *time).collect();
    times.windows(2).map(|pair| pair[1] - pair[0]).collect()
}
