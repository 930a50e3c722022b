//! A thousand vehicles, no two alike, race round the square under a controller of a dozen lines.
//!
//!     cargo run --release --example simulate

use racer::track::Gate;
use racer::{Error, Motion, Setup, Simulation, StartPlace, Vehicle};

/// Speed that the controller keeps, m/s.
const SPEED: f64 = 3.0;

/// Flies `vehicle` through a gate: the wanted velocity asks for an acceleration, that for a
/// direction of thrust, and that for body rates.
fn fly_through(gate: &Gate, at: &Motion, vehicle: &Vehicle) -> [f32; 4] {
    let (sin, cos) = gate.heading_deg.to_radians().sin_cos();
    let beyond = [0.3 * cos, 0.3 * sin, 0.0];
    let away: [f64; 3] = std::array::from_fn(|k| gate.position_m[k] + beyond[k] - at.position_m[k]);
    let distance = away.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut force: [f64; 3] = std::array::from_fn(|k| 3.0 * (SPEED * away[k] / distance - at.velocity_m_s[k]));
    force[2] += vehicle.gravity_m_s2;
    let [forward, left, up] = at.into_body(force);
    let full = vehicle.max_rates_rad_s();
    let (roll, pitch) = (-6.0 * left.atan2(up) / full[0], 6.0 * forward.atan2(up) / full[1]);
    let thrust = vehicle.hover_command(at.voltage_v) + 0.06 * (up - vehicle.gravity_m_s2);
    [roll, pitch, 0.0, thrust].map(|x| x as f32)
}

fn main() -> Result<(), Error> {
    let setup = Setup::new(&["track=square"])?;
    let gates = &setup.track.gates;
    let mut simulation = Simulation::new(&setup, 1000, StartPlace::Pad)?;
    let (mut passed, mut ended) = (0, 0);
    for _ in 0..1000 {
        let motions = simulation.motions();
        let command = |at: &Motion| fly_through(&gates[at.target_gate], at, &setup.vehicle);
        let commands: Vec<_> = motions.iter().map(command).collect();
        for transition in simulation.step(&commands)? {
            passed += usize::from(transition.passed_gate);
            ended += usize::from(transition.ending.is_some());
        }
    }
    let (vehicles, track) = (simulation.len(), &setup.track.name);
    println!("{vehicles} vehicles flew 10 s on {track}: {passed} gates passed, {ended} flights ended");
    Ok(())
}
