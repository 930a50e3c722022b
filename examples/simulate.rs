//! A thousand vehicles, no two alike, race under a controller of ten lines.
//!
//!     cargo run --release --example simulate

use racer::{Error, Motion, Setup, Simulation, StartPlace, Vehicle};

/// Flies `vehicle` to a point: the speed that is wanted asks for an acceleration, that for a direction of thrust, and
/// that for body rates.
fn fly_to(point: [f64; 3], at: &Motion, vehicle: &Vehicle) -> [f32; 4] {
    let speed: [f64; 3] = std::array::from_fn(|k| 1.5 * (point[k] - at.position_m[k]).clamp(-2.0, 2.0));
    let mut force: [f64; 3] = std::array::from_fn(|k| 2.5 * (speed[k] - at.velocity_m_s[k]));
    force[2] += vehicle.gravity_m_s2;
    let [forward, left, up] = at.into_body(force);
    let full = vehicle.max_rates_rad_s();
    let roll = -5.0 * left.atan2(up) / full[0];
    let pitch = 5.0 * forward.atan2(up) / full[1];
    let thrust = vehicle.hover_command(at.voltage_v) + 0.06 * (up - vehicle.gravity_m_s2);
    [roll, pitch, 0.0, thrust].map(|x| x as f32)
}

fn main() -> Result<(), Error> {
    let setup = Setup::new(&["track=figure_eight"])?;
    let mut simulation = Simulation::new(&setup, 1000, StartPlace::Pad)?;
    let (mut passed, mut ended) = (0, 0);
    for _ in 0..1000 {
        let motions = simulation.motions();
        let gate = |at: &Motion| setup.track.gates[at.target_gate].position_m;
        let commands: Vec<_> = motions.iter().map(|at| fly_to(gate(at), at, &setup.vehicle)).collect();
        for transition in simulation.step(&commands)? {
            passed += usize::from(transition.passed_gate);
            ended += usize::from(transition.ending.is_some());
        }
    }
    let (vehicles, track) = (simulation.len(), &setup.track.name);
    println!("{vehicles} vehicles flew 10 s on {track}: {passed} gates passed, {ended} flights ended");
    Ok(())
}
