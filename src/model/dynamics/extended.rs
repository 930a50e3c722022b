//! The compact model with [`effects`] that it lacks: the stages between a command and the motion, each open to every effect that
//! is present. Simulator and diagnosis compose the same stages; only where the inputs come from differs.

use super::{Parameters, State, battery, drag, response};
use crate::base::lane::{Lane, Real, build, each};
use crate::model::attitude::{body_axes, compose, dot, normalized, small_rotation};
use crate::model::constants::CONTROL_S;
use crate::model::effects::{
    self, Actuator, AerodynamicForces, BatteryLoad, BodyRates, CommandDelay, EffectValues, RelativeWind, Setpoint,
    ThrustInput,
};
use crate::model::thrust;
use crate::model::vehicle::Vehicle;

/// Commands kept: a delay may be this many control periods less one.
pub const LINE: usize = 14;
/// Latest that a command arrives, s.
const LATEST_S: f64 = 0.12;
/// Steps are divided until each is at most this long, s.
const FINE_S: f64 = 0.0021;

/// What the extended model needs beyond [`Parameters`].
#[derive(Clone, Copy, Debug)]
pub struct Beyond<R> {
    /// Time constants of roll, pitch, yaw, thrust, s.
    pub tau: [R; 4],
    /// Open-circuit voltage of a full and of an empty battery, V.
    pub full_v: R,
    pub empty_v: R,
    pub values: EffectValues<R>,
    /// Parts that a step is divided into.
    parts: u32,
}

/// What the extended model remembers beyond [`State`].
#[derive(Clone, Copy, Debug)]
pub struct Memory<R> {
    /// The last commands, newest first.
    pub line: [[R; 4]; LINE],
    /// Time since the newest one, s.
    pub phase: R,
    /// Change of the filtered rate commands, 1/s.
    pub slope: [R; 3],
    /// Voltage lost to slow polarisation, V.
    pub polarisation: R,
}

impl Beyond<f64> {
    pub fn new(vehicle: &Vehicle, tau: [f64; 4], numbers: [f64; effects::COUNT], dt: f64) -> Self {
        let parts = (dt / FINE_S).ceil() as u32;
        Beyond {
            tau,
            full_v: vehicle.battery.full_v,
            empty_v: vehicle.battery.empty_v,
            values: EffectValues::new(numbers),
            parts,
        }
    }
}

impl<R: Copy> Beyond<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Beyond<S> {
        let Beyond { tau, full_v, empty_v, values, parts } = self;
        Beyond {
            tau: tau.map(&mut f),
            full_v: f(*full_v),
            empty_v: f(*empty_v),
            values: values.map(&mut f),
            parts: *parts,
        }
    }
}

impl<L: Lane> Beyond<L> {
    /// Replaces the parameters of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &Beyond<L::Elem>) {
        self.tau.iter_mut().zip(new.tau).for_each(|(own, new)| own.set(lane, new));
        self.full_v.set(lane, new.full_v);
        self.empty_v.set(lane, new.empty_v);
        self.values.set_lane(lane, &new.values);
        self.parts = new.parts;
    }
}

impl<R: Copy> Memory<R> {
    /// As if `command` had been held for long without load.
    pub fn resting(command: [R; 4], zero: R, period: R) -> Self {
        Memory { line: [command; LINE], phase: period, slope: [zero; 3], polarisation: zero }
    }

    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Memory<S> {
        Memory {
            line: self.line.map(|command| command.map(&mut f)),
            phase: f(self.phase),
            slope: self.slope.map(&mut f),
            polarisation: f(self.polarisation),
        }
    }
}

impl Memory<f64> {
    /// Before the first step of a flight that begins with `command`.
    pub fn before(command: [f64; 4]) -> Self {
        Memory::resting(command, 0.0, CONTROL_S)
    }
}

impl<L: Lane> Memory<L> {
    /// Replaces the memory of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &Memory<L::Elem>) {
        for (own, new) in self.line.iter_mut().zip(&new.line) {
            own.iter_mut().zip(new).for_each(|(own, &new)| own.set(lane, new));
        }
        self.phase.set(lane, new.phase);
        self.slope.iter_mut().zip(&new.slope).for_each(|(own, &new)| own.set(lane, new));
        self.polarisation.set(lane, new.polarisation);
    }
}

/// Throttle 0..1 of a command -1..1.
#[inline(always)]
pub fn throttle<R: Real>(command: R) -> R {
    command.mul_add(R::of(0.5), R::of(0.5))
}

/// By how much the commands of roll, pitch, yaw and thrust arrive late, s.
#[inline(always)]
pub fn command_delays<R: Real>(p: &Parameters<R>) -> [R; 4] {
    let mut delay = CommandDelay { rates: R::zero(), yaw: R::zero(), thrust: R::zero() };
    effects::command_delay(&p.beyond.values, &mut delay);
    // No command comes before it was sent, or later than the line is long.
    let yaw = (delay.rates + delay.yaw).clamp(R::zero(), R::of(LATEST_S));
    [delay.rates, delay.rates, yaw, delay.thrust]
}

/// The filtered commands and their slope `h` seconds later, while the commands that arrive are `sent`, at terminal `voltage`.
#[inline(always)]
pub fn actuator_response<R: Real>(
    p: &Parameters<R>,
    command: [R; 4],
    slope: [R; 3],
    sent: [R; 4],
    voltage: R,
    h: R,
) -> ([R; 4], [R; 3]) {
    let values = &p.beyond.values;
    let zero = R::zero();
    let tau = p.beyond.tau;
    let mut actuator =
        Actuator { tau, tau_down: tau[3], inertia: zero, slew: [zero; 3], missing_v: p.beyond.full_v - voltage };
    effects::actuator(values, &mut actuator);
    let rates = build!(|i| command[i] * p.max_rate[i]);
    let throttle = throttle(command[3]);
    let mut setpoint = Setpoint { command: sent, throttle, rates, tau: actuator.tau, max_rate: p.max_rate };
    effects::setpoint(values, &mut setpoint);
    let falling = setpoint.command[3].lt(command[3]);
    let tau =
        [actuator.tau[0], actuator.tau[1], actuator.tau[2], R::select(falling, actuator.tau_down, actuator.tau[3])];
    let mut next: [R; 4] =
        build!(|i| response::toward(command[i], setpoint.command[i], R::one() - (-(h / tau[i])).exp()));
    let mut next_slope = slope;
    let (oscillates, limited) = values.shapes();
    if limited {
        for i in 0..3 {
            next[i] = response::limited(command[i], setpoint.command[i], tau[i], actuator.slew[i] * p.max_rate[i], h);
        }
    }
    if oscillates {
        // A lane without inertia keeps what the others of its block override.
        let oscillates_here = zero.lt(actuator.inertia);
        for i in 0..3 {
            let (value, change) =
                response::second_order(command[i], slope[i], setpoint.command[i], tau[i], actuator.inertia, h);
            next[i] = R::select(oscillates_here, value, next[i]);
            next_slope[i] = R::select(oscillates_here, change, next_slope[i]);
        }
    }
    (next, next_slope)
}

/// Body rates that filtered commands stand for, rad/s.
#[inline(always)]
pub fn body_rates<R: Real>(p: &Parameters<R>, command: [R; 4]) -> [R; 3] {
    let mut body = BodyRates { rates: build!(|i| command[i] * p.max_rate[i]), throttle: throttle(command[3]) };
    effects::body_rates(&p.beyond.values, &mut body);
    body.rates
}

/// Terminal voltage and polarisation (V) after `dt` seconds under the filtered thrust command, from the open-circuit voltage.
#[inline(always)]
pub fn terminal<R: Real>(p: &Parameters<R>, open: R, command: R, polarisation: R, dt: R) -> (R, R) {
    let s = throttle(command);
    let charge = (open - p.beyond.empty_v) / (p.beyond.full_v - p.beyond.empty_v);
    let mut battery_load = BatteryLoad { load: s * s, dt, charge, polarisation, drop: R::zero() };
    effects::battery_load(&p.beyond.values, &mut battery_load);
    (open - battery_load.drop, battery_load.polarisation)
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
    /// Sum over the axes of |command - response|.
    pub rate_error: R,
    /// Time since the battery was full, s.
    pub elapsed: R,
}

impl<R: Real> ForceInputs<R> {
    /// Those of a state, with the body's axes in the world and its velocity along them.
    #[inline(always)]
    pub fn of(s: &State<R>, p: &Parameters<R>, axes: [[R; 3]; 3], velocity: [R; 3]) -> Self {
        let mut rate_error = R::zero();
        for i in 0..3 {
            rate_error = rate_error + (s.memory.line[0][i] - s.command[i]).abs();
        }
        ForceInputs {
            command: s.command[3],
            voltage: s.terminal_voltage(p),
            axes,
            velocity,
            rates: body_rates(p, s.command),
            height: s.position[2],
            rate_error,
            elapsed: elapsed(p, s.voltage),
        }
    }
}

/// Time since the battery was full, from its open-circuit voltage, s; at most an hour, for batteries that hardly discharge.
#[inline(always)]
fn elapsed<R: Real>(p: &Parameters<R>, open: R) -> R {
    ((p.beyond.full_v - open) / (-p.voltage_rate).max(R::of(1e-6))).clamp(R::zero(), R::of(3600.0))
}

/// Specific force, body frame, m/s2.
#[inline(always)]
pub fn force<R: Real>(p: &Parameters<R>, at: &ForceInputs<R>) -> [R; 3] {
    let values = &p.beyond.values;
    let half = R::of(0.5);
    let middle_v = (p.beyond.full_v + p.beyond.empty_v) * half;
    let mut input = ThrustInput { command: at.command, voltage: at.voltage, middle_v };
    effects::thrust_input(values, &mut input);
    let mut wind = RelativeWind { axes: at.axes, velocity: at.velocity };
    effects::relative_wind(values, &mut wind);
    let damping = drag::damping_in_body(&p.drag, wind.velocity);
    let mut forces = AerodynamicForces {
        throttle: throttle(at.command),
        velocity: wind.velocity,
        rates: at.rates,
        height: at.height,
        rate_error: at.rate_error,
        elapsed: at.elapsed,
        specific_thrust: thrust::specific_thrust(&p.thrust, input.command, input.voltage),
        force: each!(wind.velocity, |v| -damping * v),
    };
    effects::aerodynamic_forces(values, &mut forces);
    [forces.force[0], forces.force[1], forces.force[2] + forces.specific_thrust]
}

/// The mean of what arrived `delay` seconds late during the `h` seconds before `end` (s since the newest command of `line`).
#[inline(always)]
fn arriving<R: Real>(line: &[[R; 4]; LINE], k: usize, delay: R, end: R, h: R) -> R {
    let (from, to) = (end - h - delay, end - delay);
    let mut sum = line[0][k] * (to.max(R::zero()) - from.max(R::zero()));
    for (age, command) in line.iter().enumerate().skip(1) {
        // Held from `begins` to one period later; the oldest was held before, too.
        let ends = R::of(-CONTROL_S * (age as f64 - 1.0));
        let begins = R::of(if age + 1 == LINE { -1e3 } else { -CONTROL_S * age as f64 });
        sum = command[k].mul_add((to.min(ends).max(begins)) - from.min(ends).max(begins), sum);
    }
    sum / h
}

/// One step of the extended model under the held command `action`: a function of its own, so that it is compiled once for each kind of
/// number and not again in every kernel that steps.
pub fn step<R: Real>(s: &State<R>, p: &Parameters<R>, action: [R; 4]) -> State<R> {
    R::vectorize(
        #[inline(always)]
        || stepped(s, p, action),
    )
}

#[inline(always)]
fn stepped<R: Real>(s: &State<R>, p: &Parameters<R>, action: [R; 4]) -> State<R> {
    let mut s = *s;
    let memory = &mut s.memory;
    let due = R::of(CONTROL_S - 1e-5).le(memory.phase);
    for age in (1..LINE).rev() {
        for k in 0..4 {
            memory.line[age][k] = R::select(due, memory.line[age - 1][k], memory.line[age][k]);
        }
    }
    memory.line[0] = action;
    memory.phase = R::select(due, R::zero(), memory.phase);
    let delay = command_delays(p);
    let h = p.dt * R::of(1.0 / f64::from(p.beyond.parts));
    for _ in 0..p.beyond.parts {
        s.memory.phase = s.memory.phase + h;
        let end = s.memory.phase;
        let sent = build!(|k| arriving(&s.memory.line, k, delay[k], end, h));
        s = part(&s, p, sent, h);
    }
    s
}

/// `h` seconds while the commands `sent` arrive, with forces taken at the middle.
#[inline(always)]
fn part<R: Real>(s: &State<R>, p: &Parameters<R>, sent: [R; 4], h: R) -> State<R> {
    let half = h * R::of(0.5);
    let open = battery::discharged(s.voltage, p.voltage_rate, half);
    let (voltage, polarisation) = terminal(p, open, s.command[3], s.memory.polarisation, h);
    let (command, slope) = actuator_response(p, s.command, s.memory.slope, sent, voltage, h);
    let mean: [R; 4] = build!(|i| (s.command[i] + command[i]) * R::of(0.5));
    let rates = body_rates(p, mean);

    let half_turn = small_rotation(rates, half);
    let middle = compose(s.attitude, half_turn);
    let axes = body_axes(middle);
    let velocity: [R; 3] = build!(|i| dot(axes[i], s.velocity));
    let mut rate_error = R::zero();
    for i in 0..3 {
        rate_error = rate_error + (sent[i] - mean[i]).abs();
    }
    let elapsed = elapsed(p, open);
    let height = s.position[2];
    let inputs = ForceInputs { command: mean[3], voltage, axes, velocity, rates, height, rate_error, elapsed };
    let pushed = force(p, &inputs);
    let acceleration: [R; 3] = build!(|i| {
        let world = axes[0][i].mul_add(pushed[0], axes[1][i].mul_add(pushed[1], axes[2][i] * pushed[2]));
        if i == 2 { world - p.gravity } else { world }
    });
    let velocity: [R; 3] = build!(|i| acceleration[i].mul_add(h, s.velocity[i]));
    let mut memory = s.memory;
    memory.slope = slope;
    memory.polarisation = polarisation;
    State {
        position: build!(|i| (s.velocity[i] + velocity[i]).mul_add(half, s.position[i])),
        velocity,
        attitude: normalized(compose(middle, half_turn)),
        command,
        voltage: battery::discharged(open, p.voltage_rate, half),
        memory,
    }
}
