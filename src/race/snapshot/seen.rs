//! What a policy sees in the flights that it was trained for: the range of every entry of its observation.

use crate::base::lane::{Level, dispatch};
use crate::learn::nn::Network;
use crate::race::env::Race;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::env::reset::StartPlace;
use crate::race::heat::{Heat, MOST};
use rayon::prelude::*;

/// Flights from each of the two starts, and their longest duration in steps.
pub const FLIGHTS: usize = 2 * MOST;
pub const STEPS: usize = 800;

/// The least and the greatest of every entry over flights of the mean policy as in training: randomised vehicles,
/// noise on observations and actions, the training apertures; as many from the pad as along the track, until a lap is
/// complete.
pub fn ranges(race: &Race, network: &Network<f32>) -> [[f32; OBSERVATIONS]; 2] {
    let level = Level::best();
    let heats: Vec<_> = [StartPlace::Pad, StartPlace::Spline]
        .into_iter()
        .flat_map(|place| (0..FLIGHTS / MOST).map(move |heat| (place, heat * MOST)))
        .collect();
    let raced = heats.into_par_iter().map(|(place, first)| {
        let (steps, gates) = (STEPS, race.gates.len() + 1);
        dispatch(level, Heat { race, network, place, first, vehicles: MOST, steps, gates, seen: true })
    });
    let nothing = [[f32::INFINITY; OBSERVATIONS], [f32::NEG_INFINITY; OBSERVATIONS]];
    let seen = raced.map(|raced| raced.iter().flat_map(|raced| &raced.seen).fold(nothing, wider));
    seen.reduce(|| nothing, |[low, high], more| wider(wider([low, high], &more[0]), &more[1]))
}

/// `range` with what is in `row`; what is no number is left out.
fn wider([mut low, mut high]: [[f32; OBSERVATIONS]; 2], row: &[f32; OBSERVATIONS]) -> [[f32; OBSERVATIONS]; 2] {
    for (k, &x) in row.iter().enumerate() {
        low[k] = low[k].min(x);
        high[k] = high[k].max(x);
    }
    [low, high]
}
