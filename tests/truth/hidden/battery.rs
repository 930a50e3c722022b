//! Voltage: discharge, and what the load takes away.

use super::{Craft, World};
use crate::truth::thrust;

/// Time in which the pack goes from full to empty, s.
const DISCHARGE_S: f64 = 300.0;
/// Load (share of full thrust to the power of 1.5) that empties it in that time.
const USUAL_LOAD: f64 = 0.2;

/// Voltage of the pack without load, V.
fn open_circuit(craft: &Craft, world: &World, time: f64) -> f64 {
    let (vehicle, terms) = (&world.vehicle, &world.terms);
    if terms.circuit.is_some() {
        return vehicle.full_v + vehicle.voltage_rate * DISCHARGE_S * craft.drawn;
    }
    let charge = (1.0 - time / DISCHARGE_S).clamp(0.0, 1.0);
    let x = 2.0 * charge - 1.0;
    let legendre = 0.5 * (5.0 * x * x * x - 3.0 * x);
    vehicle.full_v + vehicle.voltage_rate * time + terms.ocv_curve * legendre
}

/// Voltage at the terminals, V.
pub fn terminal(craft: &Craft, world: &World, time: f64) -> f64 {
    let terms = &world.terms;
    let open = open_circuit(craft, world, time) - craft.relaxed;
    match terms.circuit {
        Some(circuit) => open - circuit.at_once * power(craft, world),
        None => open - terms.sag * craft.share().powi(2),
    }
}

/// Voltage that thrust follows: the firmware may make up for part of the change.
pub fn of_thrust(craft: &Craft, world: &World, time: f64) -> f64 {
    let middle = 0.5 * (world.vehicle.full_v + world.vehicle.empty_v);
    middle + (1.0 - world.terms.compensation) * (terminal(craft, world, time) - middle)
}

/// Current as a share of that at full throttle: thrust to the power of 1.5.
fn power(craft: &Craft, world: &World) -> f64 {
    let vehicle = &world.vehicle;
    let lift = |u: f64| thrust::per_mass(vehicle, u, vehicle.full_v).max(0.0);
    (lift(craft.u) / lift(1.0)).powf(1.5)
}

/// Change of the voltage that relaxes (V/s), and of the share of the charge that is taken (1/s).
pub fn change(craft: &Craft, world: &World) -> [f64; 2] {
    let terms = &world.terms;
    match (terms.circuit, terms.relaxation) {
        (Some(circuit), _) => {
            let load = power(craft, world);
            let taken = (0.3 + 0.7 * load / USUAL_LOAD) / DISCHARGE_S;
            [(circuit.later * load - craft.relaxed) / circuit.tau, taken]
        }
        (None, Some([volts, tau])) => [(volts * craft.share().powi(2) - craft.relaxed) / tau, 0.0],
        _ => [0.0; 2],
    }
}
