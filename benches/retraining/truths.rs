//! Simulators to race in that share nothing with racer's: a vehicle with effects of the catalogue, and a quadrotor
//! motor by motor under its flight controller, with causes in forms of their own.

use crate::truth::CONTROL_S;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Craft, Flight, World};
use crate::truth::other::faults::Faults;
use crate::truth::other::plant::Plant;
use crate::truth::other::{self, Airframe};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::pilot::Seen;

/// Time in which a pack goes from full to empty, s.
const DISCHARGE_S: f64 = 300.0;
/// Longest that weather is made for, s.
const LONGEST_S: f64 = 2.0 * DISCHARGE_S;

/// A world in which flights begin.
pub trait Truth {
    /// A flight that begins in the air above `place`, m, with a share of the charge; `seed` decides what is by chance.
    fn begin(&self, place: Vector3<f64>, heading_rad: f64, charge: f64, seed: u64) -> Box<dyn Flown + '_>;
}

/// A flight, a command at a time.
pub trait Flown {
    fn seen(&self) -> Seen;
    /// The throttle (-1..1) that the motors have reached.
    fn throttle(&self) -> f64;
    /// Whether it stands on the ground.
    fn rests(&self) -> bool;
    /// Holds `command` (roll, pitch, yaw rate, thrust in -1..1) for a control step.
    fn hold(&mut self, command: [f64; 4]);
}

impl Truth for World {
    fn begin(&self, place: Vector3<f64>, heading_rad: f64, charge: f64, seed: u64) -> Box<dyn Flown + '_> {
        let attitude = heading(heading_rad);
        let attitude = Quaternion::from(attitude.quaternion().coords);
        // In the air above the ground, as races begin in racer's own simulator.
        let craft = Craft { position: place, attitude, resting: false, ..Craft::on_ground() };
        Box::new(Flight::new(self, craft, (1.0 - charge) * DISCHARGE_S, seed))
    }
}

impl Flown for Flight<'_> {
    fn seen(&self) -> Seen {
        Flight::seen(self)
    }

    fn throttle(&self) -> f64 {
        self.craft.u
    }

    fn rests(&self) -> bool {
        self.craft.resting
    }

    fn hold(&mut self, command: [f64; 4]) {
        Flight::hold(self, command);
    }
}

/// The quadrotor motor by motor.
pub struct ByMotor<'a> {
    pub airframe: &'a Airframe,
    pub hidden: &'a [Hidden],
}

struct MotorFlight<'a> {
    airframe: &'a Airframe,
    faults: Faults,
    plant: Plant,
    time_s: f64,
}

impl Truth for ByMotor<'_> {
    fn begin(&self, place: Vector3<f64>, heading_rad: f64, charge: f64, seed: u64) -> Box<dyn Flown + '_> {
        let mut plant = Plant::on_ground(self.airframe);
        (plant.position, plant.attitude, plant.resting) = (place, heading(heading_rad), false);
        let faults = Faults::new(self.hidden, seed, LONGEST_S);
        Box::new(MotorFlight { airframe: self.airframe, faults, plant, time_s: (1.0 - charge) * DISCHARGE_S })
    }
}

impl Flown for MotorFlight<'_> {
    fn seen(&self) -> Seen {
        other::seen(&self.plant, self.time_s)
    }

    fn throttle(&self) -> f64 {
        let idle = self.airframe.idle;
        (2.0 * (self.plant.speeds.mean() - idle) / (1.0 - idle) - 1.0).clamp(-1.0, 1.0)
    }

    fn rests(&self) -> bool {
        self.plant.resting
    }

    fn hold(&mut self, command: [f64; 4]) {
        self.plant.controller.send(self.time_s, command, &self.faults);
        for k in 0..(CONTROL_S / other::STEP_S).round() as u32 {
            self.plant.step(self.airframe, &self.faults, self.time_s + f64::from(k) * other::STEP_S);
        }
        self.time_s += CONTROL_S;
    }
}

fn heading(rad: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), rad)
}
