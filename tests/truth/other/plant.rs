//! All that moves, and a step of it.

use super::air::{self, Motion};
use super::airframe::{Airframe, GRAVITY};
use super::controller::Controller;
use super::faults::Faults;
use super::pack::Pack;
use super::{STEP_S, motors};
use nalgebra::{UnitQuaternion, Vector3, Vector4};

#[derive(Clone, Debug)]
pub struct Plant {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, rad/s, and their change, rad/s2.
    pub rates: Vector3<f64>,
    pub turning: Vector3<f64>,
    /// Speeds of the motors, share of full.
    pub speeds: Vector4<f64>,
    /// Thrust and drag over mass, body frame, m/s2.
    pub force: Vector3<f64>,
    pub pack: Pack,
    pub controller: Controller,
    pub resting: bool,
    /// What the controller asks of the motors, share of full thrust.
    pub shares: Vector4<f64>,
    /// A frame that rings: deflection and its speed.
    ringing: [f64; 2],
    steps: u64,
}

impl Plant {
    pub fn on_ground(airframe: &Airframe) -> Self {
        Plant {
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            attitude: UnitQuaternion::identity(),
            rates: Vector3::zeros(),
            turning: Vector3::zeros(),
            speeds: Vector4::repeat(airframe.idle),
            force: Vector3::new(0.0, 0.0, GRAVITY),
            pack: Pack::full(airframe),
            controller: Controller::resting(),
            resting: true,
            shares: Vector4::repeat(airframe.idle.powi(2)),
            ringing: [0.0; 2],
            steps: 0,
        }
    }

    /// High up, still, its motors carrying it.
    pub fn hovering(airframe: &Airframe) -> Self {
        let share = airframe.mass * GRAVITY / airframe.full_n;
        let still = Self::on_ground(airframe);
        let position = Vector3::new(0.0, 0.0, 1e4);
        let (speeds, shares) = (Vector4::repeat(share.sqrt()), Vector4::repeat(share));
        Plant { position, speeds, shares, resting: false, ..still }
    }

    /// The throttle (-1..1) that carries it with a full pack.
    pub fn hover_command(&self, airframe: &Airframe) -> f64 {
        let speed = (airframe.mass * GRAVITY / airframe.full_n).sqrt();
        2.0 * (speed - airframe.idle) / (1.0 - airframe.idle) - 1.0
    }

    /// A step from `time`, s.
    pub fn step(&mut self, airframe: &Airframe, faults: &Faults, time: f64) {
        if self.steps.is_multiple_of(2) {
            self.shares = self.controller.next(airframe, faults, &self.rates, time);
        }
        self.steps += 1;
        let volts = self.pack.driving(airframe, faults);
        let before = self.speeds;
        self.speeds = motors::turned(airframe, faults, &before, &self.shares, volts, STEP_S);
        let change = (self.speeds - before) / STEP_S;
        let middle = (before + self.speeds) * 0.5;
        let thrust = airframe.full_n * 0.25 * motors::thrusts(faults, &middle).sum();
        self.pack = self.pack.drained(airframe, faults, thrust / airframe.full_n, time, STEP_S);
        self.ring(faults, thrust / airframe.full_n);
        if self.resting && thrust < 1.02 * airframe.mass * (1.0 + faults.of("payload")) * GRAVITY {
            return;
        }
        self.resting = false;
        self.turning = motors::turning(airframe, faults, &middle, &change);
        self.fly(airframe, faults, thrust, time);
        if self.position.z < 0.0 {
            self.land();
        }
    }

    /// Moves the body, with forces taken at the middle of the step.
    fn fly(&mut self, airframe: &Airframe, faults: &Faults, thrust: f64, time: f64) {
        let rates = self.rates + self.turning * (0.5 * STEP_S);
        let half = UnitQuaternion::from_scaled_axis(rates * (0.5 * STEP_S));
        let middle = self.attitude * half;
        let weight = Vector3::new(0.0, 0.0, GRAVITY);
        let velocity = self.velocity + (middle * self.force - weight) * (0.5 * STEP_S);
        let motion = Motion {
            position: self.position + velocity * (0.5 * STEP_S),
            velocity,
            attitude: middle,
            thrust,
            used: self.pack.used,
            time: time + 0.5 * STEP_S,
            ringing: self.ringing[0],
        };
        self.force = air::specific_force(airframe, faults, &motion);
        let accelerated = middle * self.force - weight;
        self.position += (self.velocity + accelerated * (0.5 * STEP_S)) * STEP_S;
        self.velocity += accelerated * STEP_S;
        self.attitude = middle * half;
        self.rates += self.turning * STEP_S;
    }

    /// A side force that follows the throttle with a swing of 4 Hz.
    fn ring(&mut self, faults: &Faults, share: f64) {
        let stiff = (2.0 * std::f64::consts::PI * 4.0_f64).powi(2);
        let [place, speed] = self.ringing;
        let pull = stiff * (faults.of("ringing_frame") * (share - 0.2) - place) - 0.1 * stiff.sqrt() * speed;
        let speed = speed + pull * STEP_S;
        self.ringing = [place + speed * STEP_S, speed];
    }

    /// Stands where it came down.
    fn land(&mut self) {
        let (_, _, yaw) = self.attitude.euler_angles();
        self.attitude = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw);
        self.position.z = 0.0;
        (self.velocity, self.rates, self.turning) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        (self.force, self.resting) = (Vector3::new(0.0, 0.0, GRAVITY), true);
    }
}
