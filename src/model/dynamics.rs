//! The compact quadrotor model (paper Eq. 5 to 9): one step of 10 ms, written once for scalars and 16-lane blocks.
//!
//! World frame ENU with z up, body frame front-left-up, quaternions body to world as (w, x, y, z), SI units. Commands
//! are roll, pitch and yaw rate and collective thrust in [-1, 1]. Nothing here draws random numbers, reads a clock or a
//! configuration, allocates, or branches on lane data.

pub mod battery;
pub mod craft;
pub mod drag;
pub mod extended;
pub mod response;

use crate::base::lane::{Lane, Real, build, set_lanes};
use crate::model::attitude::{Quaternion, body_axes, compose, dot, normalized, small_rotation};
use crate::model::thrust;
use crate::model::vehicle::Vehicle;

pub use crate::model::vehicle::randomize::Factors;
pub use craft::Craft;

/// State of one vehicle (paper Eq. 5). Body rates are not kept: they are `command * max_rate`.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Position, world, m.
    pub position: [R; 3],
    /// Velocity, world, m/s.
    pub velocity: [R; 3],
    /// Attitude, body to world, unit quaternion.
    pub attitude: Quaternion<R>,
    /// Filtered commands u: roll, pitch, yaw, thrust, -1..1.
    pub command: [R; 4],
    /// Battery voltage without load, V.
    pub voltage: R,
}

/// The model's numbers as one step needs them. Forces are divided by the mass.
#[derive(Clone, Copy, Debug)]
pub struct Parameters<R> {
    /// Step length, s.
    pub dt: R,
    /// Share of the gap to the command that a step closes: 1 - exp(-dt / tau), per command.
    pub alpha: [R; 4],
    /// Share of the gap that the step's mean closes: 1 - (tau / dt) alpha, per command.
    pub mean_alpha: [R; 4],
    /// Body rate at full command: roll, pitch, yaw, rad/s.
    pub max_rate: [R; 3],
    /// c0..c5 of Eq. 7 over the mass, times the thrust factor, m/s2.
    pub thrust: [R; 6],
    /// Drag per axis: rho C_D / 2 times pi times the product of the other two semi-axes, over the mass, 1/m.
    pub drag: [R; 3],
    /// Gravity, m/s2.
    pub gravity: R,
    /// Battery voltage rate, V/s, negative.
    pub voltage_rate: R,
}

impl Parameters<f64> {
    /// The parameters of `vehicle` with `factors` for steps of `dt` seconds.
    pub fn new(vehicle: &Vehicle, factors: &Factors, dt: f64) -> Self {
        let tau = vehicle.time_constants();
        let tau: [f64; 4] = build!(|i| tau[i] * factors.time_constant[i]);
        let alpha = tau.map(|tau| response::alpha(tau, dt));
        let mean_alpha = build!(|i| 1.0 - tau[i] / dt * alpha[i]);
        let max_rate = vehicle.max_rates_rad_s();
        Parameters {
            dt,
            alpha,
            mean_alpha,
            max_rate: build!(|i| max_rate[i] * factors.max_rate[i]),
            thrust: vehicle.thrust_n.map(|c| c * factors.thrust / vehicle.mass_kg),
            drag: drag::ellipsoid(&vehicle.drag).map(|k| k * factors.drag / vehicle.mass_kg),
            gravity: vehicle.gravity_m_s2,
            voltage_rate: vehicle.battery.rate_v_s,
        }
    }
}

impl State<f64> {
    /// Position (m) and velocity (m/s) in the world, attitude, filtered commands, voltage (V).
    pub fn new(
        position: [f64; 3],
        velocity: [f64; 3],
        attitude: Quaternion<f64>,
        command: [f64; 4],
        voltage: f64,
    ) -> Self {
        State { position, velocity, attitude, command, voltage }
    }
}

impl<R: Copy> State<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> State<S> {
        State {
            position: self.position.map(&mut f),
            velocity: self.velocity.map(&mut f),
            attitude: self.attitude.map(&mut f),
            command: self.command.map(&mut f),
            voltage: f(self.voltage),
        }
    }
}

impl<R: Copy> Parameters<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Parameters<S> {
        Parameters {
            dt: f(self.dt),
            alpha: self.alpha.map(&mut f),
            mean_alpha: self.mean_alpha.map(&mut f),
            max_rate: self.max_rate.map(&mut f),
            thrust: self.thrust.map(&mut f),
            drag: self.drag.map(&mut f),
            gravity: f(self.gravity),
            voltage_rate: f(self.voltage_rate),
        }
    }
}

impl<L: Lane> State<L> {
    /// Replaces the state of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &State<L::Elem>) {
        let State { position, velocity, attitude, command, voltage } = self;
        set_lanes(position, lane, &new.position);
        set_lanes(velocity, lane, &new.velocity);
        set_lanes(attitude, lane, &new.attitude);
        set_lanes(command, lane, &new.command);
        voltage.set(lane, new.voltage);
    }
}

impl<L: Lane> Parameters<L> {
    /// Replaces the parameters of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &Parameters<L::Elem>) {
        let Parameters { dt, alpha, mean_alpha, max_rate, thrust, drag, gravity, voltage_rate } = self;
        set_lanes(alpha, lane, &new.alpha);
        set_lanes(mean_alpha, lane, &new.mean_alpha);
        set_lanes(max_rate, lane, &new.max_rate);
        set_lanes(thrust, lane, &new.thrust);
        set_lanes(drag, lane, &new.drag);
        dt.set(lane, new.dt);
        gravity.set(lane, new.gravity);
        voltage_rate.set(lane, new.voltage_rate);
    }
}

impl<R: Real> State<R> {
    /// Body rates, rad/s, body frame.
    #[inline(always)]
    pub fn body_rates(&self, p: &Parameters<R>) -> [R; 3] {
        build!(|i| self.command[i] * p.max_rate[i])
    }
}

/// Thrust and drag over the mass, body frame, m/s2: what an accelerometer at the centre of mass measures.
#[inline(always)]
pub fn specific_force<R: Real>(s: &State<R>, p: &Parameters<R>) -> [R; 3] {
    let axes = body_axes(s.attitude);
    let velocity = build!(|i| dot(axes[i], s.velocity));
    force_in_body(&p.thrust, &p.drag, s.command[3], s.voltage, velocity)
}

/// [`specific_force`] from c0..c5 of Eq. 7 and drag per axis (both over the mass), filtered thrust command, voltage and
/// velocity in the body frame.
#[inline(always)]
pub fn force_in_body<R: Real>(thrust: &[R; 6], drag: &[R; 3], command: R, voltage: R, velocity: [R; 3]) -> [R; 3] {
    let damping = drag::damping_in_body(drag, velocity);
    let [x, y, z]: [R; 3] = build!(|i| -damping * velocity[i]);
    [x, y, z + thrust::specific_thrust(thrust, command, voltage)]
}

/// One step of `p.dt` seconds under the held command `action`.
///
/// The response is integrated exactly, the attitude with the step's mean rate, and the acceleration is taken at the
/// step's middle: half the rotation done, mean thrust command, mid-step voltage and velocity. At 100 Hz the time
/// constants are as short as the step, and a plain Euler step would be twenty times worse.
#[inline(always)]
pub fn step<R: Real>(s: &mut State<R>, p: &Parameters<R>, action: [R; 4]) {
    let half_dt = p.dt * R::of(0.5);
    let mean: [R; 4] = build!(|i| response::toward(s.command[i], action[i], p.mean_alpha[i]));
    let command = build!(|i| response::toward(s.command[i], action[i], p.alpha[i]));

    // The same half rotation leads to the middle and from there to the end.
    let half_turn = small_rotation(build!(|i| mean[i] * p.max_rate[i]), half_dt);
    let middle = compose(s.attitude, half_turn);
    let attitude = normalized(compose(middle, half_turn));

    let axes = body_axes(middle);
    let voltage = battery::discharged(s.voltage, p.voltage_rate, half_dt);
    let lift = thrust::specific_thrust(&p.thrust, mean[3], voltage);
    let free: [R; 3] = [axes[2][0] * lift, axes[2][1] * lift, axes[2][2].mul_add(lift, -p.gravity)];
    let early: [R; 3] = build!(|i| free[i].mul_add(half_dt, s.velocity[i]));
    let damping = drag::damping(&p.drag, &axes, early);
    // `early` lacks the half step of drag; to first order that changes the quadratic drag by twice its own share.
    let damping = (damping * p.dt).mul_add(-damping, damping);

    let acceleration: [R; 3] = build!(|i| early[i].mul_add(-damping, free[i]));
    let velocity: [R; 3] = build!(|i| acceleration[i].mul_add(p.dt, s.velocity[i]));
    let position = build!(|i| (s.velocity[i] + velocity[i]).mul_add(half_dt, s.position[i]));
    let voltage = battery::discharged(voltage, p.voltage_rate, half_dt);
    *s = State { position, velocity, attitude, command, voltage };
}
