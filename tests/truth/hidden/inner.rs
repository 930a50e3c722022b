//! From rate commands to body rates: lag, second order, limits, couplings.

use super::{Craft, World, battery};
use crate::truth::effects::terms::Terms;
use nalgebra::Vector3;

/// Share of the limit of angular acceleration that yaw has.
const YAW_SLEW: f64 = 0.3;

/// Body rates that the commands ask for, rad/s.
pub fn wanted(craft: &Craft, world: &World, command: [f64; 4]) -> Vector3<f64> {
    let (vehicle, terms) = (&world.vehicle, &world.terms);
    let shaped = |a: f64| (1.0 - terms.expo) * a + terms.expo * a * a * a;
    let mut wanted = Vector3::from_fn(|k, _| vehicle.max_rate[k] * shaped(command[k]));
    wanted.z *= 1.0 - terms.yaw_loss * ((craft.share() - 0.8) / 0.2).clamp(0.0, 1.0);
    wanted
}

/// Change of what the inner loop has reached (rad/s2), and of that change.
pub fn change(craft: &Craft, world: &World, command: [f64; 4], time: f64) -> [Vector3<f64>; 2] {
    let (vehicle, terms) = (&world.vehicle, &world.terms);
    let error = wanted(craft, world, command) - craft.rates;
    let slower = 1.0 + terms.response_voltage * (vehicle.full_v - battery::terminal(craft, world, time));
    let mut spin = Vector3::zeros();
    let mut rates = if let Some([wn, zeta]) = terms.second_order {
        spin = error * (wn * wn / slower) - craft.spin * (2.0 * zeta * wn);
        craft.spin
    } else {
        Vector3::from_fn(|k, _| error[k] / (vehicle.tau[k] * slower))
    };
    if let Some([wn, zeta]) = terms.yaw_second_order {
        spin.z = error.z * (wn * wn / slower) - craft.spin.z * (2.0 * zeta * wn);
        rates.z = craft.spin.z;
    }
    if let Some(limit) = terms.slew {
        let limits = Vector3::new(limit, limit, YAW_SLEW * limit) / slower;
        rates = rates.zip_map(&limits, |rate, limit| rate.clamp(-limit, limit));
    }
    if let Some(limit) = terms.yaw_slew {
        rates.z = rates.z.clamp(-limit / slower, limit / slower);
    }
    let w = craft.rates;
    rates.x += terms.gyroscopic * w.y * w.z;
    rates.y -= terms.gyroscopic * w.z * w.x;
    [rates, spin]
}

/// Body rates, rad/s.
pub fn body_rates(craft: &Craft, terms: &Terms) -> Vector3<f64> {
    if craft.resting {
        return Vector3::zeros();
    }
    coupled(&craft.rates, terms) + terms.weak_motor * craft.share()
}

/// Angular acceleration of the body, rad/s2, from the change of the state.
pub fn body_acceleration(craft: &Craft, change: &Craft, terms: &Terms) -> Vector3<f64> {
    if craft.resting {
        return Vector3::zeros();
    }
    coupled(&change.rates, terms) + terms.weak_motor * (0.5 * change.u)
}

fn coupled(w: &Vector3<f64>, terms: &Terms) -> Vector3<f64> {
    let [xy, yx] = terms.cross;
    Vector3::new(w.x + xy * w.y, w.y + yx * w.x, w.z)
}
