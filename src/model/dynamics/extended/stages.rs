//! The stages between a command and the motion, each open to every effect that is present. Simulator and diagnosis
//! compose the same stages; only where the inputs come from differs.

use super::{EffectMemory, Extended};
use crate::base::lane::{Mask, Real, build, each};
use crate::model::attitude::{body_axes, dot};
use crate::model::dynamics::response::ResponseSteps;
use crate::model::dynamics::{State, drag, response};
use crate::model::effects::{
    self, Actuator, AerodynamicForces, BatteryLoad, BodyRates, CommandDelay, CommandSetpoint, RelativeWind, ThrustInput,
};
use crate::model::thrust;

/// Latest that a command arrives, s.
const LATEST_S: f64 = 0.12;

/// Throttle 0..1 of a command -1..1.
#[inline(always)]
pub fn throttle<R: Real>(command: R) -> R {
    command.mul_add(R::of(0.5), R::of(0.5))
}

/// By how much the commands of roll, pitch, yaw and thrust arrive late, s.
#[inline(always)]
pub fn command_delays<R: Real>(p: &Extended<R>) -> [R; 4] {
    let mut delay = CommandDelay { rates: R::zero(), yaw: R::zero(), thrust: R::zero() };
    effects::command_delay(&p.values, &mut delay);
    // No command comes before it was sent, or later than the line is long.
    let within = |delay: R| delay.clamp(R::zero(), R::of(LATEST_S));
    let rates = within(delay.rates);
    [rates, rates, within(delay.rates + delay.yaw), within(delay.thrust)]
}

/// The filtered commands and their slope `h` seconds later, while the commands that arrive are `sent`, at terminal
/// `voltage`.
#[inline(always)]
pub fn actuator_response<R: Real>(
    p: &Extended<R>,
    command: [R; 4],
    slope: [R; 3],
    sent: [R; 4],
    voltage: R,
    h: R,
) -> ([R; 4], [R; 3]) {
    actuator_response_by(&mut response::Computed, p, (command, slope), sent, voltage, h)
}

/// The same, with what steps of time do from `steps`.
#[inline(always)]
pub fn actuator_response_by<R: Real>(
    steps: &mut impl ResponseSteps<R>,
    p: &Extended<R>,
    (command, slope): ([R; 4], [R; 3]),
    sent: [R; 4],
    voltage: R,
    h: R,
) -> ([R; 4], [R; 3]) {
    let values = &p.values;
    let zero = R::zero();
    let tau = p.tau;
    let (inertia, slew, missing_v) = ([zero; 3], [zero; 3], p.full_v - voltage);
    let mut actuator = Actuator { tau, tau_down: tau[3], inertia, slew, slower: R::one(), missing_v };
    effects::actuator(values, &mut actuator);
    for i in 0..3 {
        actuator.tau[i] = actuator.tau[i] * actuator.slower;
        actuator.inertia[i] = actuator.inertia[i] * actuator.slower;
        actuator.slew[i] = actuator.slew[i] * actuator.slower;
    }
    let rates = build!(|i| command[i] * p.compact.max_rate[i]);
    let throttle = throttle(command[3]);
    let mut setpoint =
        CommandSetpoint { command: sent, throttle, rates, tau: actuator.tau, max_rate: p.compact.max_rate };
    effects::setpoint(values, &mut setpoint);
    let falling = setpoint.command[3].lt(command[3]);
    let tau =
        [actuator.tau[0], actuator.tau[1], actuator.tau[2], R::select(falling, actuator.tau_down, actuator.tau[3])];
    let (oscillates, limited) = values.shapes();
    let mut next_slope = slope;
    let mut next: [R; 4] = [zero; 4];
    for i in 0..4 {
        // An axis, or a lane, without inertia keeps what the others override.
        let second_order = zero.lt(if i < 3 { actuator.inertia[i] } else { zero });
        if !oscillates || (!second_order).any() {
            next[i] = if i < 3 && limited {
                let slew = actuator.slew[i] * p.compact.max_rate[i];
                response::limited(command[i], setpoint.command[i], tau[i], slew, h, || steps.left(i, tau[i], h))
            } else {
                response::toward(command[i], setpoint.command[i], R::one() - steps.left(i, tau[i], h))
            };
        }
        if i < 3 && oscillates {
            let inertia = actuator.inertia[i];
            let (value, change) =
                steps.second_order(i, tau[i], inertia, h).after(command[i], slope[i], setpoint.command[i]);
            next[i] = R::select(second_order, value, next[i]);
            next_slope[i] = R::select(second_order, change, next_slope[i]);
        }
    }
    (next, next_slope)
}

/// Body rates that filtered commands stand for, rad/s.
#[inline(always)]
pub fn body_rates<R: Real>(p: &Extended<R>, command: [R; 4]) -> [R; 3] {
    let mut body = BodyRates { rates: build!(|i| command[i] * p.compact.max_rate[i]), throttle: throttle(command[3]) };
    effects::body_rates(&p.values, &mut body);
    body.rates
}

/// Terminal voltage and polarisation (V) after `dt` seconds under the filtered thrust command, from the open-circuit
/// voltage.
#[inline(always)]
pub fn terminal<R: Real>(p: &Extended<R>, open: R, command: R, polarisation: R, dt: R) -> (R, R) {
    let s = throttle(command);
    let charge = (open - p.empty_v) / (p.full_v - p.empty_v);
    let mut battery_load = BatteryLoad { load: s * s, dt, charge, polarisation, drop: R::zero() };
    effects::battery_load(&p.values, &mut battery_load);
    (open - battery_load.drop, battery_load.polarisation)
}

/// How far the rates are behind what is wanted of them.
#[derive(Clone, Copy, Debug)]
pub struct TurnError<R> {
    /// Sum over the axes of |command that has arrived - response|, each as a share of the maximum rate.
    pub share: R,
    /// Sum over the axes of |command - response|, rad/s: a rate loop that answers late works on its setpoint at once.
    pub behind: R,
}

impl<R: Real> TurnError<R> {
    /// No error.
    pub fn none() -> Self {
        Self { share: R::zero(), behind: R::zero() }
    }

    /// That of a response to `command`, of which `arrived` is what has arrived.
    #[inline(always)]
    pub fn of(p: &Extended<R>, command: [R; 4], arrived: [R; 4], response: [R; 4]) -> Self {
        let mut out = Self::none();
        for i in 0..3 {
            out.share = out.share + (arrived[i] - response[i]).abs();
            out.behind = (command[i] - response[i]).abs().mul_add(p.compact.max_rate[i], out.behind);
        }
        out
    }
}

/// What thrust and drag depend on.
#[derive(Clone, Copy, Debug)]
pub struct ForceInputs<R> {
    /// Filtered thrust command, -1..1.
    pub command: R,
    /// At the terminals, V.
    pub voltage: R,
    /// The body's axes in the world.
    pub axes: [[R; 3]; 3],
    /// Over ground, body frame, m/s.
    pub velocity: [R; 3],
    /// Body rates, rad/s.
    pub rates: [R; 3],
    /// Over the ground, m.
    pub height: R,
    /// How far the response is behind.
    pub turn_error: TurnError<R>,
    /// Time since the battery was full, s.
    pub elapsed: R,
}

impl<R: Real> ForceInputs<R> {
    /// Those of a state.
    #[inline(always)]
    fn of(s: &State<R>, p: &Extended<R>, memory: &EffectMemory<R>) -> Self {
        let axes = body_axes(s.attitude);
        let velocity = build!(|i| dot(axes[i], s.velocity));
        let turn_error = TurnError::of(p, memory.line[0], memory.line[0], s.command);
        ForceInputs {
            command: s.command[3],
            voltage: loaded(s, p, memory),
            axes,
            velocity,
            rates: body_rates(p, s.command),
            height: s.position[2],
            turn_error,
            elapsed: elapsed(p, s.voltage),
        }
    }
}

/// Time since the battery was full, from its open-circuit voltage, s; at most an hour, for batteries that hardly
/// discharge.
#[inline(always)]
pub fn elapsed<R: Real>(p: &Extended<R>, open: R) -> R {
    ((p.full_v - open) / (-p.compact.voltage_rate).max(R::of(1e-6))).clamp(R::zero(), R::of(3600.0))
}

/// Specific force, body frame, m/s2.
#[inline(always)]
pub fn force<R: Real>(p: &Extended<R>, at: &ForceInputs<R>) -> [R; 3] {
    let values = &p.values;
    let half = R::of(0.5);
    let middle_v = (p.full_v + p.empty_v) * half;
    let behind = at.turn_error.behind;
    let mut input = ThrustInput { command: at.command, voltage: at.voltage, middle_v, behind };
    effects::thrust_input(values, &mut input);
    let mut wind = RelativeWind { axes: at.axes, velocity: at.velocity };
    effects::relative_wind(values, &mut wind);
    let damping = drag::damping_in_body(&p.compact.drag, wind.velocity);
    let mut forces = AerodynamicForces {
        throttle: throttle(at.command),
        velocity: wind.velocity,
        drag: p.compact.drag,
        damping,
        rates: at.rates,
        height: at.height,
        rate_error: at.turn_error.share,
        elapsed: at.elapsed,
        specific_thrust: thrust::specific_thrust(&p.compact.thrust, input.command, input.voltage),
        force: each!(wind.velocity, |v| -damping * v),
    };
    effects::aerodynamic_forces(values, &mut forces);
    [forces.force[0], forces.force[1], forces.force[2] + forces.specific_thrust]
}

/// Voltage at the battery's terminals under the present load, V.
#[inline(always)]
pub fn loaded<R: Real>(s: &State<R>, p: &Extended<R>, memory: &EffectMemory<R>) -> R {
    terminal(p, s.voltage, s.command[3], memory.polarisation, R::zero()).0
}

/// Thrust, drag and what effects add, over the mass, body frame, m/s2.
#[inline(always)]
pub fn specific_force<R: Real>(s: &State<R>, p: &Extended<R>, memory: &EffectMemory<R>) -> [R; 3] {
    force(p, &ForceInputs::of(s, p, memory))
}
