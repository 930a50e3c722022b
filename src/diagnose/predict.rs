//! What the model says the sensors of a flight should have read: the same stages as the simulator's, driven by the log.

use super::model::{BEGIN, Model, Stage};
use super::record::Record;
use crate::dynamics::Parameters;
use crate::dynamics::attitude::{Quaternion, body_axes, compose, dot, normalized, small_rotation};
use crate::dynamics::battery::discharged;
use crate::dynamics::extended::{self, Moment};
use crate::effects::{self, Channel, Sensed};
use crate::flight::lowpass::LowPass;
use crate::flight::series::period;
use crate::lane::{Kernel, Lane32, Level, build, dispatch};
use std::sync::Arc;

/// Cut-off below which the measured voltage is believed rather than the modelled one, Hz.
const VOLTAGE_HZ: f64 = 0.5;

/// Channels of the residual: rates, specific force, turns and pushes along x, y, z, and the voltage.
pub const CHANNELS: usize = 13;
pub const RATE: usize = 0;
pub const FORCE: usize = 3;
pub const TURN: usize = 6;
pub const PUSH: usize = 9;
pub const VOLTAGE: usize = 12;

/// What a channel compares.
pub fn kind(channel: usize) -> Channel {
    [Channel::Rate, Channel::Force, Channel::Turn, Channel::Push, Channel::Voltage][channel / 3]
}

/// One flight, predicted; every stage is kept and shared, so that a number late in the chain is cheap to change.
#[derive(Clone, Debug, Default)]
pub struct Predicted {
    /// Filtered commands, and the share that each rate lags, summed.
    command: Arc<Vec<[f64; 4]>>,
    lag: Arc<Vec<f64>>,
    /// What the filtered commands go to, and how fast those of the rates change.
    asked: Arc<Vec<([f64; 4], [f64; 3])>>,
    /// Body rates, and those that the gyro's late samples show.
    pub rates: Arc<Vec<[f64; 3]>>,
    seen_rates: Arc<Vec<[f64; 3]>>,
    /// At the terminals, modelled and as thrust sees it, V.
    pub modelled_v: Arc<Vec<f64>>,
    pub voltage: Arc<Vec<f64>>,
    /// Specific force, m/s2.
    pub force: Arc<Vec<[f64; 3]>>,
    /// By channel, in the units of [`Record`]; empty where the log lacks it.
    pub channels: [Arc<Vec<f64>>; CHANNELS],
}

/// The filtered commands at every sample.
struct Responses {
    command: Vec<[f64; 4]>,
    lag: Vec<f64>,
    asked: Vec<([f64; 4], [f64; 3])>,
}

/// What of a prediction has to be made again.
#[derive(Clone, Copy, Debug)]
pub struct Anew {
    /// From where on.
    pub stage: Stage,
    /// Whether only body rates change, or only what is about thrust and drag.
    pub rates: bool,
    pub forces: bool,
    /// Whether the readings of the IMU are corrected in another way.
    pub corrections: bool,
}

impl Anew {
    pub const ALL: Anew = Anew { stage: Stage::Response, rates: true, forces: true, corrections: true };
}

impl Predicted {
    /// Filtered thrust command at a sample, -1..1.
    pub fn thrust(&self, i: usize) -> f64 {
        self.command[i][3]
    }

    /// Sum over the axes of |command - response| at a sample.
    pub fn lag(&self, i: usize) -> f64 {
        self.lag[i]
    }

    /// Predicts `record`, number `flight`, at `x`.
    pub fn new(model: &Model, record: &Record, flight: usize, x: &[f64]) -> Self {
        Self::default().anew(Anew::ALL, model, record, flight, x)
    }

    /// The same at other numbers, which change no more than `what`.
    pub fn changed(&self, what: Anew, model: &Model, record: &Record, flight: usize, x: &[f64]) -> Self {
        self.clone().anew(what, model, record, flight, x)
    }

    fn anew(self, what: Anew, model: &Model, record: &Record, flight: usize, x: &[f64]) -> Self {
        dispatch(Level::best(), Remake { from: self, what, model, record, flight, x })
    }

    #[inline(always)]
    fn remade(mut self, what: Anew, model: &Model, record: &Record, flight: usize, x: &[f64]) -> Self {
        let p = model.parameters(x);
        let stage = what.stage;
        if stage <= Stage::Response {
            let Responses { command, lag, asked } = respond(&p, record, model, x, 0.0);
            (self.command, self.lag, self.asked) = (command.into(), lag.into(), asked.into());
        }
        if stage <= Stage::Spin && what.rates {
            let offset = model.of(x, "stream_offset", "offset");
            self.rates = spin(&p, record, &self.command).into();
            self.seen_rates = if offset == 0.0 {
                self.rates.clone()
            } else {
                spin(&p, record, &respond(&p, record, model, x, offset).command).into()
            };
        }
        if stage <= Stage::Battery && what.forces {
            self.discharge(&p, record, x[BEGIN + flight]);
        }
        if stage <= Stage::Force && what.forces {
            self.push(&p, record, model.of(x, "velocity_lag", "tau"), model.vehicle().gravity_m_s2);
        }
        self.sense(&p, what, model, record, x);
        if what.corrections {
            self.integrate(model, record, x);
        }
        if stage <= Stage::Battery && what.forces {
            self.channels[VOLTAGE] = record.volts.iter().map(|(i, _)| self.modelled_v[*i]).collect::<Vec<_>>().into();
        }
        self
    }

    /// Modelled voltage, and that with its slow error taken off, which thrust sees.
    #[inline(always)]
    fn discharge(&mut self, p: &Parameters<f64>, record: &Record, begin_v: f64) {
        let n = record.time.len();
        if record.volts.is_empty() {
            (self.modelled_v, self.voltage) = (vec![0.0; n].into(), vec![0.0; n].into());
            return;
        }
        let since = record.since();
        let mut polarisation = 0.0;
        let mut before = since;
        let mut modelled = Vec::with_capacity(n);
        for (i, &t) in record.time.iter().enumerate() {
            let open = discharged(begin_v, p.voltage_rate, t - since);
            let command = if self.command[i][3].is_finite() { self.command[i][3] } else { -1.0 };
            let (v, next) = extended::terminal(p, open, command, polarisation, (t - before).max(0.0));
            (polarisation, before) = (next, t.max(since));
            modelled.push(v);
        }
        let mut error: Vec<f64> = record.voltage.iter().zip(&modelled).map(|(m, v)| m - v).collect();
        if let Some(filter) = LowPass::new(VOLTAGE_HZ, period(&record.time)) {
            filter.run(&mut error);
        }
        self.voltage = modelled.iter().zip(error).map(|(v, e)| v + e).collect::<Vec<_>>().into();
        self.modelled_v = modelled.into();
    }

    /// Specific force. A velocity that lags by `tau` is taken as what it will be.
    #[inline(always)]
    fn push(&mut self, p: &Parameters<f64>, record: &Record, tau: f64, gravity: f64) {
        let since = record.since();
        let mut out = Vec::with_capacity(record.time.len());
        let force = |i: usize| -> [f64; 3] { build!(|k| record.fine.imu[3 + k][i]) };
        let late = if tau > 0.0 { Some(lagged(record, tau, force)) } else { None };
        for i in 0..record.time.len() {
            let mut velocity: [f64; 3] = build!(|k| record.velocity[k][i]);
            if let Some(late) = &late {
                let mut gains = late[i * record.fine.every];
                gains[2] -= gravity;
                for k in 0..3 {
                    velocity[k] += tau * dot(record.axes[i][k], gains);
                }
            }
            let moment = Moment {
                command: self.command[i][3],
                voltage: self.voltage[i],
                axes: record.axes[i],
                velocity,
                rates: self.rates[i],
                height: record.height[i],
                rate_error: self.lag[i],
                elapsed: record.time[i] - since,
            };
            out.push(extended::force(p, &moment));
        }
        self.force = out.into();
    }

    /// Readings, averaged over bins.
    #[inline(always)]
    fn sense(&mut self, p: &Parameters<f64>, what: Anew, model: &Model, record: &Record, x: &[f64]) {
        let k = model.sensors(x);
        let arm = ["rx", "ry", "rz"].iter().any(|side| model.of(x, "imu_lever_arm", side) != 0.0);
        let acceleration = if arm { self.turning(p, record) } else { vec![[0.0; 3]; record.time.len()] };
        let known =
            |c: usize| if c < 3 { record.commanded[0] } else { record.commanded[1] && (record.moves || c == 5) };
        let wanted = |c: usize| known(c) && if c < 3 { what.rates } else { what.forces };
        let mut means: [Vec<f64>; 6] = Default::default();
        for &[from, to] in &record.bins {
            let mut sum = [0.0; 6];
            for i in from..to {
                let throttle = extended::throttle(self.command[i][3]);
                let (rates, force) = (self.rates[i], self.force[i]);
                let mut sensed = Sensed { rates, acceleration: acceleration[i], force, throttle };
                effects::sense(k, &mut sensed);
                for j in 0..3 {
                    // The gyro's own lateness, on top of what the sensor makes of it.
                    sum[j] += sensed.rates[j] - rates[j] + self.seen_rates[i][j];
                    sum[3 + j] += sensed.force[j];
                }
            }
            (0..6).filter(|&c| wanted(c)).for_each(|c| means[c].push(sum[c] / (to - from) as f64));
        }
        for (c, mean) in means.into_iter().enumerate() {
            if wanted(c) {
                self.channels[c] = mean.into();
            }
        }
    }

    /// Angular acceleration, rad/s2: what the response does at each moment, for it is over in a few samples.
    #[inline(always)]
    fn turning(&self, p: &Parameters<f64>, record: &Record) -> Vec<[f64; 3]> {
        const MOMENT_S: f64 = 1e-5;
        if !record.commanded[0] {
            return slopes(&record.time, &self.rates);
        }
        let mut out = Vec::with_capacity(record.time.len());
        for i in 0..record.time.len() {
            let (sent, slope) = self.asked[i];
            let voltage = supplied(p, record, i);
            let (next, _) = extended::respond(p, self.command[i], slope, sent, voltage, MOMENT_S);
            let (now, next) = (extended::spin(p, self.command[i]), extended::spin(p, next));
            out.push(build!(|k| (next[k] - now[k]) / MOMENT_S));
        }
        out
    }

    /// What the IMU, corrected, integrates to over each window: the turn (rotation vector) and the change of velocity (less gravity), both in the
    /// body frame at the window's beginning.
    #[inline(always)]
    fn integrate(&mut self, model: &Model, record: &Record, x: &[f64]) {
        if record.windows.is_empty() {
            return;
        }
        let k = model.sensors(x);
        // A gyro that is late was not what the odometry's clock was to be moved to.
        let late = model.of(x, "stream_offset", "offset");
        let offset = if late == 0.0 { 0.0 } else { late - record.moved };
        let stretch = 1.0 / (1.0 + model.of(x, "clock_skew", "skew"));
        let tau = model.of(x, "velocity_lag", "tau");
        let gyro = shifted(record, offset);
        let fine = &record.fine;
        let slope = slopes(&fine.time, &gyro);
        let mut corrected: Vec<[f64; 6]> = Vec::with_capacity(gyro.len());
        for i in 0..gyro.len() {
            let throttle = extended::throttle(self.command[i / fine.every][3]);
            let throttle = if throttle.is_finite() { throttle } else { 0.0 };
            let force = [fine.imu[3][i], fine.imu[4][i], fine.imu[5][i]];
            corrected.push(truth(k, [gyro[i], force], slope[i], throttle));
        }
        let lagged = if tau > 0.0 { Some(missing(record, &corrected, tau)) } else { None };
        let mut out: [Vec<f64>; 6] = Default::default();
        for &[from, to] in &record.windows {
            let mut turn: Quaternion<f64> = [1.0, 0.0, 0.0, 0.0];
            let axes = record.axes[from];
            // Gravity was taken off the measured change for as long as the recorder's clock said, not for as long as it was.
            let fast = (1.0 - stretch) * (record.time[to] - record.time[from]) * model.vehicle().gravity_m_s2;
            let mut pushed: [f64; 3] = std::array::from_fn(|j| fast * axes[j][2]);
            for i in from * fine.every..to * fine.every {
                let h = (fine.time[i + 1] - fine.time[i]) * stretch;
                let mean: [f64; 6] = std::array::from_fn(|j| 0.5 * (corrected[i][j] + corrected[i + 1][j]));
                let half = small_rotation([mean[0], mean[1], mean[2]], 0.5 * h);
                let middle = compose(turn, half);
                turn = normalized(compose(middle, half));
                let mut push = in_world(&body_axes(middle), [mean[3], mean[4], mean[5]]);
                if let Some(world) = &lagged {
                    for j in 0..3 {
                        push[j] += (0..3).map(|c| axes[j][c] * 0.5 * (world[i][c] + world[i + 1][c])).sum::<f64>();
                    }
                }
                (0..3).for_each(|j| pushed[j] += h * push[j]);
            }
            let rotated = vector(turn);
            for j in 0..3 {
                out[j].push(rotated[j]);
                if record.moves {
                    out[3 + j].push(pushed[j]);
                }
            }
        }
        for (c, values) in out.into_iter().enumerate() {
            self.channels[TURN + c] = values.into();
        }
    }
}

/// A fused multiply-add is an instruction below a kernel, and a call of a function elsewhere.
struct Remake<'a> {
    from: Predicted,
    what: Anew,
    model: &'a Model,
    record: &'a Record,
    flight: usize,
    x: &'a [f64],
}

impl Kernel for Remake<'_> {
    type Output = Predicted;

    #[inline(always)]
    fn run<L: Lane32>(self) -> Predicted {
        self.from.remade(self.what, self.model, self.record, self.flight, self.x)
    }
}

/// What was measured, in the layout of [`Predicted::channels`].
pub fn measured(record: &Record, gravity: f64) -> [Vec<f64>; CHANNELS] {
    let mut out: [Vec<f64>; CHANNELS] = Default::default();
    for (c, channel) in out.iter_mut().enumerate().take(6) {
        let mean = |&[from, to]: &[usize; 2]| (from..to).map(|i| record.imu[c][i]).sum::<f64>() / (to - from) as f64;
        *channel = record.bins.iter().map(mean).collect();
    }
    for &[from, to] in &record.windows {
        let [w, a, b, c] = record.attitude[from];
        let turn = vector(compose([w, -a, -b, -c], record.attitude[to]));
        let velocity = |i: usize| in_world(&record.axes[i], std::array::from_fn(|k| record.velocity[k][i]));
        let (v0, v1) = (velocity(from), velocity(to));
        let mut gained: [f64; 3] = std::array::from_fn(|k| v1[k] - v0[k]);
        gained[2] += gravity * (record.time[to] - record.time[from]);
        for k in 0..3 {
            out[TURN + k].push(turn[k]);
            out[PUSH + k].push((0..3).map(|j| record.axes[from][k][j] * gained[j]).sum());
        }
    }
    out[VOLTAGE] = record.volts.iter().map(|(_, v)| *v).collect();
    out
}

#[inline(always)]
fn in_world(axes: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| (0..3).map(|j| axes[j][k] * v[j]).sum())
}

/// The rotation vector of a rotation of less than half a turn, rad.
#[inline(always)]
fn vector(q: Quaternion<f64>) -> [f64; 3] {
    let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
    let axis = q[1].hypot(q[2]).hypot(q[3]);
    let scale = if axis > 1e-12 { 2.0 * axis.atan2(sign * q[0]) * sign / axis } else { 2.0 * sign };
    [q[1] * scale, q[2] * scale, q[3] * scale]
}

/// The truth behind a reading of rates and specific force: what the sensors make of it is small, so that two rounds of correction are enough.
#[inline(always)]
fn truth(k: &[f64], measured: [[f64; 3]; 2], acceleration: [f64; 3], throttle: f64) -> [f64; 6] {
    let [mut rates, mut force] = measured;
    for _ in 0..2 {
        let mut sensed = Sensed { rates, acceleration, force, throttle };
        effects::sense(k, &mut sensed);
        rates = std::array::from_fn(|j| rates[j] + measured[0][j] - sensed.rates[j]);
        force = std::array::from_fn(|j| force[j] + measured[1][j] - sensed.force[j]);
    }
    [rates[0], rates[1], rates[2], force[0], force[1], force[2]]
}

/// The measured rates as they were when their late samples say they are.
#[inline(always)]
fn shifted(record: &Record, offset: f64) -> Vec<[f64; 3]> {
    let n = record.fine.time.len();
    if offset == 0.0 {
        return (0..n).map(|i| std::array::from_fn(|k| record.fine.imu[k][i])).collect();
    }
    let at = |t: f64, k: usize, near: usize| {
        let mut i = near.min(n - 2);
        while i > 0 && record.fine.time[i] > t {
            i -= 1;
        }
        while i + 2 < n && record.fine.time[i + 1] < t {
            i += 1;
        }
        let share = ((t - record.fine.time[i]) / (record.fine.time[i + 1] - record.fine.time[i])).clamp(0.0, 1.0);
        record.fine.imu[k][i] + share * (record.fine.imu[k][i + 1] - record.fine.imu[k][i])
    };
    (0..n).map(|i| std::array::from_fn(|k| at(record.fine.time[i] + offset, k, i))).collect()
}

/// Specific forces `force` of the IMU's samples, turned into the world and through a first-order lag of `tau` seconds; straight lines between samples.
#[inline(always)]
fn lagged(record: &Record, tau: f64, force: impl Fn(usize) -> [f64; 3]) -> Vec<[f64; 3]> {
    let fine = &record.fine;
    let mut now: Option<[[f64; 3]; 2]> = None;
    let mut out = Vec::with_capacity(fine.time.len());
    for i in 0..fine.time.len() {
        let world = in_world(&fine_axes(record, i), force(i));
        let finite = world[0].is_finite() && world[1].is_finite() && world[2].is_finite();
        let next = match now {
            Some([late, _]) if !finite => late,
            Some([late, before]) => {
                let h = fine.time[i] - fine.time[i - 1];
                let alpha = crate::dynamics::response::alpha(tau, h);
                build!(|k| {
                    let rising = (world[k] - before[k]) * tau / h.max(1e-9);
                    world[k] - rising * alpha + (late[k] - before[k]) * (1.0 - alpha)
                })
            }
            None => world,
        };
        if finite {
            now = Some([next, world]);
        }
        out.push(if next[0].is_finite() { next } else { [0.0; 3] });
    }
    out
}

/// What such a lag adds to the corrected specific forces.
#[inline(always)]
fn missing(record: &Record, corrected: &[[f64; 6]], tau: f64) -> Vec<[f64; 3]> {
    let force = |i: usize| -> [f64; 3] { build!(|k| corrected[i][3 + k]) };
    let late = lagged(record, tau, force);
    let added = |i: usize| {
        let world = in_world(&fine_axes(record, i), force(i));
        let added: [f64; 3] = build!(|k| late[i][k] - world[k]);
        if added[0].is_finite() { added } else { [0.0; 3] }
    };
    (0..late.len()).map(added).collect()
}

/// The body's axes in the world at a sample of the whole IMU, between those at the record's.
#[inline(always)]
fn fine_axes(record: &Record, i: usize) -> [[f64; 3]; 3] {
    let at = i / record.fine.every;
    let share = (i % record.fine.every) as f64 / record.fine.every as f64;
    let (a, b) = (&record.axes[at], &record.axes[(at + 1).min(record.axes.len() - 1)]);
    build!(|j| build!(|k| a[j][k] + share * (b[j][k] - a[j][k])))
}

/// Change of each rate, by central differences.
#[inline(always)]
fn slopes(time: &[f64], rates: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let n = time.len();
    let one = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
        let h = (time[b] - time[a]).max(1e-6);
        std::array::from_fn(|k| (rates[b][k] - rates[a][k]) / h)
    };
    (0..n).map(one).collect()
}

#[inline(always)]
fn spin(p: &Parameters<f64>, record: &Record, command: &[[f64; 4]]) -> Vec<[f64; 3]> {
    if record.commanded[0] {
        command.iter().map(|c| extended::spin(p, *c)).collect()
    } else {
        (0..command.len()).map(|i| std::array::from_fn(|k| record.imu[k][i])).collect()
    }
}

/// Filtered commands at every sample; the gyro's samples are `offset` seconds late. Commands are held until the next, and what arrives is integrated exactly.
#[inline(always)]
fn respond(p: &Parameters<f64>, record: &Record, model: &Model, x: &[f64], offset: f64) -> Responses {
    let late = extended::lateness(p);
    // Roll and pitch, yaw, and thrust arrive each at their time.
    let late = [late[0] + offset, late[2] + offset, late[3]];
    let stretch = 1.0 / (1.0 + model.of(x, "clock_skew", "skew"));
    let lost = model.of(x, "command_dropout", "probability");
    let n = record.time.len();
    let mut out =
        Responses { command: Vec::with_capacity(n), lag: Vec::with_capacity(n), asked: Vec::with_capacity(n) };
    let none = [f64::NAN; 4];
    let Some((first, begin)) = record.sent.first().copied() else {
        return Responses { command: vec![none; n], lag: vec![0.0; n], asked: vec![(none, [0.0; 3]); n] };
    };
    // What arrives on average where commands get lost.
    let arrives = |i: usize, k: usize| {
        let now = record.sent[i].1[k];
        if i == 0 || lost == 0.0 { now } else { now + lost * (record.sent[i - 1].1[k] - now) }
    };
    let mut at = [0, 0, 0];
    let (mut command, mut slope, mut sent) = (begin, [0.0; 3], begin);
    let mut now = first;
    for i in 0..n {
        let t = record.time[i] * stretch;
        if t < first {
            out.command.push(none);
            out.lag.push(f64::NAN);
            out.asked.push((none, [0.0; 3]));
            continue;
        }
        let voltage = supplied(p, record, i);
        loop {
            let due = |g: usize| record.sent.get(at[g] + 1).map_or(f64::INFINITY, |next| next.0 + late[g]);
            let (g, next) = if due(0) <= due(1).min(due(2)) {
                (0, due(0))
            } else if due(1) <= due(2) {
                (1, due(1))
            } else {
                (2, due(2))
            };
            let until = next.min(t);
            if until > now {
                (command, slope) = extended::respond(p, command, slope, sent, voltage, until - now);
                now = until;
            }
            if next > t {
                break;
            }
            at[g] += 1;
            [0..2, 2..3, 3..4][g].clone().for_each(|k| sent[k] = arrives(at[g], k));
        }
        out.command.push(command);
        out.lag.push((0..3).map(|k| (sent[k] - command[k]).abs()).sum());
        out.asked.push((sent, slope));
    }
    out
}

/// The voltage that a sample's response depends on, V.
#[inline(always)]
fn supplied(p: &Parameters<f64>, record: &Record, i: usize) -> f64 {
    if record.voltage[i].is_finite() { record.voltage[i] } else { p.beyond.full_v }
}
