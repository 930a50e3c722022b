//! The reference lap: how fast a vehicle could be whose attitude followed at once.
//!
//! A point mass with the vehicle's largest thrust at a stated battery voltage, in any direction at any time, with
//! gravity and with the drag that the vehicle's own equations give it in the attitude that has least, flies a closed
//! lap through the apertures that a race is scored by, in their directions, and within the track's volume. Where it
//! crosses an aperture is free. It flies the lap again and again: it ends as fast as it began. In none of this does the
//! vehicle do better, and it has to turn before it can push.
//!
//! The lap is transcribed directly: places at equal times between gates, the times between gates and all places
//! unknown, acceleration and velocity by differences. The time is minimised by Newton's method through logarithmic
//! barriers ([`barrier`]), with exact second derivatives, from several first laps ([`EFFORT`]); the best is refined
//! twice. What is found is a local optimum, not a bound that is proven.

pub mod barrier;
pub mod course;
mod jet;
pub mod mass;
pub mod solve;
mod system;

use crate::base::rng::{Philox, RngStream};
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use course::{Course, Nodes};
use mass::Mass;
use nalgebra::Vector3;
use solve::solve;

/// The method in a line.
pub const METHOD: &str = "time-optimal closed lap of a point mass: full thrust in any direction at once, gravity, \
    drag in the slimmest \
    attitude, through the scored apertures within the volume; local optimum of a direct transcription";

/// How much is tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// First laps: one orderly, the others bent at random.
    pub starts: usize,
    /// Steps to a gate at first, and in each refinement of the best.
    pub density: usize,
    pub refined: [usize; 2],
}

/// What [`lap`] tries.
pub const EFFORT: Effort = Effort { starts: 4, density: 10, refined: [20, 40] };

/// A reference lap.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Time of the lap, s.
    pub seconds: f64,
    /// Battery voltage, constant, V.
    pub voltage: f64,
    /// m
    pub length: f64,
    /// m/s
    pub top_speed: f64,
    /// From the first gate on, at (nearly) equal times.
    pub moments: Vec<Moment>,
}

/// One moment of a reference lap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// s since the first gate.
    pub time_s: f64,
    /// m, world.
    pub position: Vector3<f64>,
    /// m/s, world.
    pub velocity: Vector3<f64>,
    /// Thrust over the mass, m/s2, world.
    pub thrust: Vector3<f64>,
}

/// The reference lap of `track` for the nominal `vehicle` with its battery at `voltage` (V), which stays. None where
/// the vehicle cannot carry itself at that voltage. Effects beyond the compact model are left out.
pub fn lap(track: &Track, vehicle: &Vehicle, voltage: f64) -> Option<Reference> {
    let mass = Mass::new(vehicle, voltage);
    let found = best(&Course::new(track, mass), EFFORT)?;
    Some(Reference { voltage, ..describe(&mass, &found) })
}

/// The fastest lap found from several beginnings. The same course always gives the same lap.
pub fn best(course: &Course, effort: Effort) -> Option<Nodes> {
    let starts = (0..effort.starts).filter_map(|start| {
        let mut rng = Philox::new(1).sequence(RngStream::Reference, start as u32, 0);
        let disorder = if start == 0 { 0.0 } else { 0.3 };
        solve(course, course.guess(effort.density, disorder, &mut rng)?, None)
    });
    let mut best = starts.min_by(|a, b| a.total().total_cmp(&b.total()))?;
    for density in effort.refined {
        // The barriers' weight at which a lap that is nearly right is not pushed far from it.
        const AGAIN: f64 = 1e-4;
        best = solve(course, best.refined(density), Some(AGAIN))?;
    }
    Some(best)
}

fn describe(mass: &Mass, lap: &Nodes) -> Reference {
    let mut time_s = 0.0;
    let mut moments = Vec::new();
    let mut length = 0.0;
    for place in &lap.places() {
        let [a, v] = lap.motion(place);
        let thrust = mass.thrust_for(a.into(), v.into()).into();
        moments.push(Moment { time_s, position: lap.positions[place.nodes[1]], velocity: v, thrust });
        time_s += lap.step(place.segments[1]);
        length += (lap.positions[place.nodes[2]] - lap.positions[place.nodes[1]]).norm();
    }
    let top_speed = moments.iter().map(|m| m.velocity.norm()).fold(0.0, f64::max);
    Reference { seconds: lap.total(), voltage: f64::NAN, length, top_speed, moments }
}
