//! An independent simulator: shares no equation with `src/`, so that a test can be wrong about us.
//!
//! Runge-Kutta at 2 kHz under commands held for 10 ms, and sensors with noise, bias, quantisation and their own clocks. The
//! pilot is racer's: he is not part of the physics.

#![allow(dead_code)] // Each test uses a part.

pub mod motion;
pub mod sense;
pub mod vehicle;

use motion::Body;
use nalgebra::{UnitQuaternion, Vector3};
use racer::flight::{Log, VehicleRecord};
use racer::pilot::{Known, Pilot, Seen};
use rand::SeedableRng;
use rand::rngs::StdRng;
use sense::Sensors;
pub use vehicle::Vehicle;

/// Integration step, s.
pub const STEP_S: f64 = 5e-4;
/// Steps between two commands.
const STEPS: usize = 20;

/// What a flight was.
pub struct Flown {
    pub log: Log,
    /// Commands in [-1, 1], one each 10 ms.
    pub commands: Vec<[f64; 4]>,
    /// The body at each command.
    pub bodies: Vec<Body>,
}

/// Flies `vehicle` for `seconds` with the pilot; noise is `noise` times the usual.
pub fn fly(vehicle: &Vehicle, seed: u64, seconds: f64, noise: f64) -> Flown {
    let known = Known {
        max_rate_rad_s: vehicle.full_rate,
        hover: vehicle.hover(vehicle.full_v),
        thrust_to_weight: vehicle.push(1.0, vehicle.full_v) / vehicle::GRAVITY,
    };
    let mut pilot = Pilot::new(seed, known);
    let mut sensors = Sensors::new(noise, StdRng::seed_from_u64(seed));
    let mut body = Body::resting(vehicle.full_v);
    let (mut commands, mut bodies) = (Vec::new(), Vec::new());
    let mut log = Log { name: format!("flight {seed}"), ..Log::default() };
    log.vehicle = VehicleRecord { mass_kg: Some(vehicle.mass), max_rate_rad_s: Some(vehicle.full_rate) };
    for tick in 0..(seconds * 100.0) as usize {
        let time_s = tick as f64 * STEPS as f64 * STEP_S;
        let [w, x, y, z] = wxyz(&body.attitude);
        let seen =
            Seen { time_s, position: body.position.into(), velocity: body.velocity.into(), attitude: [w, x, y, z] };
        let command = pilot.command(&seen);
        let asked: [f64; 3] = std::array::from_fn(|k| command[k] * vehicle.full_rate[k]);
        log.setpoint.push(time_s, [asked[0], asked[1], asked[2], 0.5 * (command[3] + 1.0)]);
        commands.push(command);
        bodies.push(body.clone());
        for step in 0..STEPS {
            sensors.sense(vehicle, &body, tick * STEPS + step, &mut log);
            body.advance(vehicle, command, STEP_S);
        }
    }
    Flown { log, commands, bodies }
}

pub fn wxyz(q: &UnitQuaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

pub fn up() -> Vector3<f64> {
    Vector3::z()
}
