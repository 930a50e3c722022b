//! Gains to begin with, from the vehicle's own numbers.
//!
//! The firmware's own defaults are for a frame with propellers of ten inches. Its rate loops answer in shares of what
//! the motors can give; what that turns the vehicle by follows from thrust curve and inertia at hover.

use super::super::airframe::Airframe;
use crate::model::vehicle::Vehicle;

/// Of one rate loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateGains {
    /// Share per rad/s, per rad, and per rad/s2.
    pub p: f64,
    pub i: f64,
    pub d: f64,
}

/// How fast each rate loop is to answer, 1/s. Half as much again let `seed_class` answer no sooner.
const BANDWIDTH: [f64; 3] = [60.0, 60.0, 40.0];
/// How fast a lasting error is to be integrated away, 1/s. Four times as much made it overshoot by a tenth.
const INTEGRAL: f64 = 0.5;
/// How much of the motors' lag the derivative takes up. With all of it the vehicle answered later.
const LEAD: f64 = 0.7;
/// How much the difference of an axis' motors is of its loop's answer, from the mean.
const SHARE: f64 = 0.5;

/// What a whole answer of each rate loop turns the vehicle by at hover with a half-empty battery, rad/s2: roll, pitch,
/// yaw.
pub fn authority(vehicle: &Vehicle, frame: &Airframe) -> [f64; 3] {
    let volts = 0.5 * (vehicle.battery.full_v + vehicle.battery.empty_v);
    let hover = vehicle.hover_command(volts);
    let thrust = |share: f64| 0.25 * vehicle.thrust_at(hover + 2.0 * share, volts);
    const NEAR: f64 = 0.05;
    // Newtons of a motor per share of its command.
    let slope = (thrust(NEAR) - thrust(-NEAR)) / (2.0 * NEAR);
    let sides = [[-1.0, -1.0, 1.0, 1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]];
    std::array::from_fn(|axis| frame.turning(sides[axis].map(|side| side * SHARE * slope), [0.0; 3])[axis])
}

/// Gains for roll, pitch, and yaw.
pub fn of(vehicle: &Vehicle, frame: &Airframe) -> [RateGains; 3] {
    let authority = authority(vehicle, frame);
    let lag_s = vehicle.time_constants()[3];
    std::array::from_fn(|axis| {
        let p = BANDWIDTH[axis] / authority[axis].max(1e-3);
        RateGains { p, i: p * INTEGRAL, d: p * LEAD * lag_s }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vehicle_that_turns_harder_needs_less_of_every_gain() {
        let vehicle = Vehicle::load("seed_class").unwrap();
        let frame = Airframe::of(&vehicle);
        let heavy = Airframe { inertia_kg_m2: frame.inertia_kg_m2.map(|x| 2.0 * x), ..frame };
        let (light, heavy) = (of(&vehicle, &frame), of(&vehicle, &heavy));
        for (light, heavy) in light.into_iter().zip(heavy) {
            assert!(light.p > 0.0 && light.d > 0.0 && (heavy.p / light.p - 2.0).abs() < 1e-9, "{light:?} {heavy:?}");
        }
        // Rotors far out turn it harder than their torques do.
        let [roll, pitch, yaw] = authority(&vehicle, &frame);
        assert!(roll == pitch && roll > 3.0 * yaw && yaw > 0.0, "{roll} {pitch} {yaw}");
    }
}
