//! The model of the flights at any values of its numbers: the vehicle with every effect.

use super::bends;
use super::numbers::{DISCHARGE, DRAG, EFFECTS, FORMS, LOG_AT, MAX_RATE, ModelNumber, Numbers, TAU, THRUST, span};
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::extended::Extended;
use crate::model::dynamics::{Factors, Parameters, drag};
use crate::model::effects::{self, Card, Quantities, Role, SensorErrors};
use crate::model::vehicle::{MaxRates, TimeConstants, Vehicle};

/// All numbers, and the vehicle they are about.
#[derive(Clone, Debug)]
pub struct Model {
    pub numbers: Vec<ModelNumber>,
    /// Those of the base vehicle, without effects but its own.
    pub base: Vec<f64>,
    vehicle: Vehicle,
}

impl Model {
    /// The numbers of `vehicle` for flights that begin at `begin_v` volts.
    pub fn new(vehicle: &Vehicle, begin_v: &[f64]) -> Self {
        let Numbers { all, base } = Numbers::new(vehicle, begin_v);
        Self { numbers: all, base, vehicle: vehicle.clone() }
    }

    /// Where the thrust command is a measured rotor speed, the voltage has no part in the thrust.
    pub fn forget_voltage(&mut self) {
        let middle = self.middle_v();
        for (with, without) in [(4, 0), (5, 1)] {
            self.base[THRUST.start + without] += middle * self.base[THRUST.start + with];
            self.base[THRUST.start + with] = 0.0;
            (self.numbers[THRUST.start + with].low, self.numbers[THRUST.start + with].high) = (0.0, 0.0);
        }
        for number in &mut self.numbers[bends::THRUST..bends::VELOCITY] {
            (number.low, number.high) = (0.0, 0.0);
        }
    }

    /// The parameters of the extended model at `x`, for steps of any length.
    pub fn parameters(&self, x: &[f64]) -> Extended<f64> {
        let mut p = Parameters::new(&self.vehicle, &Factors::NOMINAL, CONTROL_S);
        let tau = std::array::from_fn(|k| x[TAU.start + k]);
        p.max_rate = std::array::from_fn(|k| x[MAX_RATE.start + k]);
        p.thrust = std::array::from_fn(|k| x[THRUST.start + k]);
        p.drag = std::array::from_fn(|k| x[DRAG.start + k]);
        p.voltage_rate = x[DISCHARGE];
        Extended::of(&self.vehicle, p, tau, std::array::from_fn(|k| x[EFFECTS + k]))
    }

    /// The parameters of sensors and chance at `x`.
    pub fn sensors<'a>(&self, x: &'a [f64]) -> SensorErrors<'a> {
        SensorErrors::new(&x[LOG_AT..FORMS])
    }

    /// The first parameters, at `x`, of the effects that act on a log in this way; 0 where there is none.
    pub fn acting(&self, x: &[f64], role: Role) -> f64 {
        effects::acting(role).map(|card| x[span(card).start]).sum()
    }

    /// The effects that are there at `x`.
    pub fn present(&self, x: &[f64]) -> Vec<&'static Card> {
        effects::cards().filter(|card| x[span(card)].iter().any(|k| *k != 0.0)).collect()
    }

    /// What of a prediction at `x` has to be computed again where the numbers `which` are changed.
    pub fn dirty(&self, which: &[usize], x: &[f64]) -> Quantities {
        let writes = which.iter().fold(Quantities::NONE, |all, &k| all.and(self.numbers[k].writes));
        writes.reached(&self.present(x))
    }

    /// The voltage at the middle of the battery, V.
    pub fn middle_v(&self) -> f64 {
        0.5 * (self.vehicle.battery.full_v + self.vehicle.battery.empty_v)
    }

    /// Moves the thrust in `x` by what a share of the voltage that is turned about a full battery, and not about its
    /// middle, makes of it.
    pub fn about_full(&self, x: &mut [f64], share: f64) {
        let volts = self.vehicle.battery.full_v - self.middle_v();
        // What the thrust has of the voltage, by itself and times the command.
        for i in 0..2 {
            x[THRUST.start + i] += share * volts * x[THRUST.start + 4 + i];
        }
    }

    /// Takes a share off what the thrust in `x` has of the voltage, about a full battery, and adds one to all of it.
    /// Eq. 7 stays what it is: c0 and c1 take what c4 and c5 give.
    pub fn off(&self, x: &mut [f64], [voltage, level]: [f64; 2]) {
        for i in 0..2 {
            let part = voltage * x[THRUST.start + 4 + i];
            x[THRUST.start + 4 + i] -= part;
            x[THRUST.start + i] += self.vehicle.battery.full_v * part;
        }
        x[THRUST].iter_mut().for_each(|c| *c *= 1.0 + level);
    }

    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// The base vehicle with the compact model's numbers of `x`, and no change of its effects.
    pub fn vehicle_at(&self, x: &[f64]) -> Vehicle {
        let mut v = self.vehicle.clone();
        let [roll, pitch, yaw, thrust] = std::array::from_fn(|k| x[TAU.start + k]);
        v.time_constant_s = TimeConstants { roll, pitch, yaw, thrust };
        let [roll, pitch, yaw] = std::array::from_fn(|k| x[MAX_RATE.start + k].to_degrees());
        v.max_rate_deg_s = MaxRates { roll, pitch, yaw };
        v.thrust_n = std::array::from_fn(|k| x[THRUST.start + k] * v.mass_kg);
        let k: [f64; 3] = std::array::from_fn(|k| (x[DRAG.start + k]).max(1e-5) * v.mass_kg);
        v.drag.semi_axes_m = drag::semi_axes(k, v.drag.coefficient, v.drag.air_density_kg_m3);
        v.battery.rate_v_s = x[DISCHARGE].min(0.0);
        v
    }
}
