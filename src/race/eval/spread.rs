//! How far randomised vehicles fly from where the nominal one does, and where along the lap they do most (paper Figure
//! 7).

use crate::base::lane::{Level, dispatch};
use crate::base::stats::quantile;
use crate::learn::nn::Network;
use crate::model::track::Track;
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use crate::race::heat::{Heat, MOST, Raced};
use nalgebra::Vector3;
use rayon::prelude::*;
use serde::Serialize;

/// Flights from the pad, and how they spread.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Positions of the nominal vehicle, step by step, m.
    pub nominal: Vec<Vector3<f64>>,
    /// Those of the randomised vehicles.
    pub randomised: Vec<Vec<Vector3<f64>>>,
    /// Along the nominal flight.
    pub profile: Vec<Station>,
    /// Where along the nominal flight it passed each gate, m, and which.
    pub gates: Vec<(f64, usize)>,
}

/// Distances from a place of the nominal flight to where the others crossed the plane through it that the nominal
/// vehicle crossed at right angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Station {
    /// Length of the nominal flight until there, m.
    pub at_m: f64,
    /// Median and 90 % quantile of the distances, m.
    pub median_m: f64,
    pub p90_m: f64,
    /// Vehicles that came there.
    pub vehicles: usize,
    /// The gate that the nominal vehicle flew to.
    pub gate: usize,
}

/// Distance between stations, m.
const STEP_M: f64 = 0.25;
/// A vehicle is looked for this long before and after it crossed the last plane, in steps of 10 ms.
const WINDOW: usize = 70;
/// A vehicle that crosses the plane further away is somewhere else, m.
const FAR_M: f64 = 8.0;
/// Least vehicles that a spread is told from.
const LEAST: usize = 5;

/// Flies the nominal vehicle and `randomised` others of an evaluation for a lap each, at most `max_steps` steps; `race`
/// is made scored first. Runs on the current rayon pool.
pub fn spread(
    level: Level,
    race: &Race,
    track: &Track,
    network: &Network<f32>,
    randomised: usize,
    max_steps: usize,
) -> Spread {
    let race = race.scored(track);
    let all = randomised + 1;
    let blocks: Vec<Vec<Raced>> = (0..all.div_ceil(MOST))
        .into_par_iter()
        .map(|block| {
            let (first, gates) = (block * MOST, track.gates.len() + 1);
            let vehicles = MOST.min(all - first);
            dispatch(
                level,
                Heat {
                    race: &race,
                    network,
                    place: StartPlace::Pad,
                    first,
                    vehicles,
                    steps: max_steps,
                    gates,
                    seen: false,
                },
            )
        })
        .collect();
    let raced: Vec<Raced> = blocks.into_iter().flatten().collect();
    let path = |raced: &Raced| -> Vec<Vector3<f64>> {
        raced.steps.iter().map(|(craft, ..)| Vector3::from(craft.state.position.map(f64::from))).collect()
    };
    let nominal = path(&raced[0]);
    let others: Vec<_> = raced[1..].iter().map(path).collect();
    let targets: Vec<usize> = raced[0].steps.iter().map(|(_, _, gate)| *gate as usize).collect();
    let lengths = lengths(&nominal);
    let passed = targets.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]);
    let gates = passed.map(|(i, pair)| (lengths[i + 1], pair[0])).collect();
    let profile = profile(&nominal, &targets, &others);
    Spread { nominal, randomised: others, profile, gates }
}

impl Spread {
    /// Where the randomised vehicles spread most, by the 90 % quantile. A single station that stands out is where the
    /// nominal vehicle turns back and its plane cuts the others' way twice.
    pub fn widest(&self) -> Option<&Station> {
        let lasting = |three: &&[Station]| three.iter().map(|s| s.p90_m).fold(f64::INFINITY, f64::min);
        self.profile.windows(3).max_by(|a, b| lasting(a).total_cmp(&lasting(b))).map(|three| &three[1])
    }
}

/// Length of the way until each place, m.
fn lengths(path: &[Vector3<f64>]) -> Vec<f64> {
    let mut total = 0.0;
    let steps = path.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    std::iter::once(0.0)
        .chain(steps.map(|step| {
            total += step;
            total
        }))
        .collect()
}

/// Stations along `nominal`, whose vehicle flew to the gates `targets`. Each of the `others` is followed from plane to
/// plane.
pub fn profile(nominal: &[Vector3<f64>], targets: &[usize], others: &[Vec<Vector3<f64>>]) -> Vec<Station> {
    let lengths = lengths(nominal);
    let mut last_crossed = vec![0_usize; others.len()];
    let mut stations = Vec::new();
    let mut due = STEP_M;
    for i in 1..nominal.len().saturating_sub(1) {
        if lengths[i] < due {
            continue;
        }
        due = lengths[i] + STEP_M;
        let Some(normal) = (nominal[i + 1] - nominal[i - 1]).try_normalize(1e-6) else { continue };
        let mut distances = Vec::with_capacity(others.len());
        for (path, last) in others.iter().zip(&mut last_crossed) {
            let crossed = (last.saturating_sub(WINDOW)..(*last + WINDOW).min(path.len().saturating_sub(1)))
                .filter_map(|j| Some((crossing(nominal[i], normal, path[j], path[j + 1])?, j)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((distance, j)) = crossed.filter(|(distance, _)| *distance < FAR_M) {
                distances.push(distance);
                *last = j;
            }
        }
        if distances.len() >= LEAST {
            let (median_m, p90_m) = (quantile(&distances, 0.5), quantile(&distances, 0.9));
            stations.push(Station { at_m: lengths[i], median_m, p90_m, vehicles: distances.len(), gate: targets[i] });
        }
    }
    stations
}

/// Distance from `place` to where the line from `a` to `b` crosses the plane through it along its `normal`, m.
fn crossing(place: Vector3<f64>, normal: Vector3<f64>, a: Vector3<f64>, b: Vector3<f64>) -> Option<f64> {
    let (before, after) = (normal.dot(&(a - place)), normal.dot(&(b - place)));
    (before < 0.0 && after >= 0.0).then(|| (a + (b - a) * (before / (before - after)) - place).norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Circles of other radii, flown at other speeds, are as far away as their radii differ; one that leaves is missed.
    #[test]
    fn distances_are_those_across_the_path() {
        let circle = |radius: f64, pace: f64, steps: usize| -> Vec<Vector3<f64>> {
            let angle = |i: usize| 0.01 * pace * i as f64;
            (0..steps).map(|i| Vector3::new(radius * angle(i).cos(), radius * angle(i).sin(), 1.0)).collect()
        };
        let nominal = circle(10.0, 1.0, 500);
        let others: Vec<_> = [10.5, 9.5, 11.0, 10.5, 9.0, 10.5].map(|r| circle(r, 1.1, 430)).into();
        let found = profile(&nominal, &vec![3; 500], &others);
        assert!(found.len() > 150 && found.iter().all(|s| s.gate == 3 && s.vehicles == 6), "{found:?}");
        for station in &found {
            // Sorted: 0.5, 0.5, 0.5, 0.5, 1, 1; chords of a step are shorter than the arc by a tenth of a millimetre.
            assert!((station.median_m - 0.5).abs() < 1e-2 && (station.p90_m - 1.0).abs() < 1e-2, "{station:?}");
        }
        let mut short = others.clone();
        short[0].truncate(200);
        let found = profile(&nominal, &vec![3; 500], &short);
        assert_eq!(found.last().map(|s| s.vehicles), Some(5));
    }
}
