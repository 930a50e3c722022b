//! Collective thrust and everything that takes from it.

use super::{Craft, World, battery, inflow};
use crate::truth::thrust::per_mass;
use nalgebra::Vector3;

/// Radius of a rotor, m, and height of the rotors over the ground when standing, m.
const ROTOR_M: f64 = 0.0635;
const STANDING_M: f64 = 0.05;
/// Time over which thrust fades, s.
const FADE_S: f64 = 300.0;
/// Induced velocity over the root of thrust over mass, (m s2)^0.5: 5 m/s in hover.
pub const INDUCED: f64 = 1.6;

/// What acts on the rotors at a moment.
pub struct Flow<'a> {
    /// Air velocity (m/s) and body rates (rad/s), body frame.
    pub air: &'a Vector3<f64>,
    pub rates: &'a Vector3<f64>,
    /// Rates asked for by the command that has arrived, and by the newest, rad/s.
    pub wanted: &'a Vector3<f64>,
    pub asked: &'a Vector3<f64>,
    pub time: f64,
}

/// Change of the filtered command, 1/s.
pub fn change(craft: &Craft, world: &World, command: f64) -> f64 {
    let error = command - craft.u;
    let tau = match world.terms.thrust_lag {
        Some([up, down]) => {
            if error > 0.0 {
                up
            } else {
                down
            }
        }
        None => world.vehicle.tau[3],
    };
    error / tau
}

/// Thrust over mass without flow, m/s2.
pub fn standing(craft: &Craft, world: &World, time: f64) -> f64 {
    turning(craft, world, time, 0.0)
}

/// The same while the rates are so far behind what is wanted, summed over the axes, rad/s.
fn turning(craft: &Craft, world: &World, time: f64, behind: f64) -> f64 {
    let terms = &world.terms;
    let volts = battery::of_thrust(craft, world, time);
    // Motors are neither slower than stopped nor faster than full.
    let room = (terms.mixer_room * behind).min(0.5);
    let throttle = (0.5 + 0.5 * craft.u).max(room).min(1.0 - room);
    let command = if room > 0.0 { 2.0 * throttle - 1.0 } else { craft.u };
    let mut thrust = per_mass(&world.vehicle, command + 2.0 * terms.throttle_offset, volts);
    thrust *= 1.0 - terms.fade * time / FADE_S;
    if let Some([loss, tau]) = terms.heat {
        thrust *= 1.0 - loss * (1.0 - (-time / tau).exp());
    }
    if let Some([loss, then]) = terms.thrust_step {
        thrust *= 1.0 - if time > then { loss } else { 0.0 };
    }
    thrust
}

/// Thrust over mass in flight, m/s2.
pub fn flying(craft: &Craft, world: &World, flow: &Flow) -> f64 {
    let terms = &world.terms;
    let mut thrust = turning(craft, world, flow.time, (flow.asked - flow.rates).abs().sum());
    if terms.momentum > 0.0 {
        thrust = inflow::thrust(thrust, flow.air, terms.momentum);
    }
    if terms.propwash > 0.0 {
        thrust *= 1.0 - terms.propwash * recirculation(thrust, flow.air.z);
    }
    let height = craft.position.z.max(0.0) + STANDING_M;
    thrust *= 1.0 + terms.ground_effect * (ROTOR_M / (4.0 * height)).powi(2);
    if terms.mixer_loss > 0.0 {
        let max_rate = Vector3::from(world.vehicle.max_rate);
        let effort = (flow.wanted - flow.rates).component_div(&max_rate).map(f64::abs).sum();
        thrust *= (1.0 - terms.mixer_loss * effort).max(0.0);
    }
    thrust -= terms.rate_thrust * flow.rates.xy().norm_squared();
    thrust -= terms.axial_inflow * craft.share() * flow.air.z;
    thrust + terms.translational_lift * flow.air.xy().norm_squared()
}

/// How much of its own downwash the rotor takes in: 1 where it sinks at 1.2 times the induced velocity.
pub fn recirculation(thrust: f64, climb: f64) -> f64 {
    if climb >= 0.0 || thrust <= 0.0 {
        return 0.0;
    }
    let sink = -climb / (INDUCED * thrust.sqrt());
    (-((sink - 1.2) / 0.5).powi(2)).exp() * (sink / 0.6).clamp(0.0, 1.0)
}

/// Recirculation as the sensors feel it.
pub fn washed(craft: &Craft, world: &World, air: &Vector3<f64>, time: f64) -> f64 {
    if world.terms.propwash == 0.0 || craft.resting {
        return 0.0;
    }
    recirculation(standing(craft, world, time), air.z)
}
