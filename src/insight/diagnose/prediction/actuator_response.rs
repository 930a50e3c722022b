//! What arrives of the commands, and what body rates it makes.

use super::model::Model;
use super::record::FlightRecord;
use crate::insight::prepare::kept_steps::KeptSteps;
use crate::model::dynamics::extended::{self, Extended, TurnError};
use crate::model::effects::Role;

/// The filtered commands at every sample; how far those of the rates lag; what they go to, and how fast
/// those of the rates change.
pub struct ActuatorResponse {
    pub command: Vec<[f64; 4]>,
    pub lag: Vec<TurnError<f64>>,
    pub setpoint: Vec<([f64; 4], [f64; 3])>,
}

impl ActuatorResponse {
    fn with_capacity(n: usize) -> Self {
        Self { command: Vec::with_capacity(n), lag: Vec::with_capacity(n), setpoint: Vec::with_capacity(n) }
    }

    #[inline(always)]
    fn push(&mut self, command: [f64; 4], lag: TurnError<f64>, setpoint: ([f64; 4], [f64; 3])) {
        self.command.push(command);
        self.lag.push(lag);
        self.setpoint.push(setpoint);
    }
}

/// Body rates: those that the filtered commands make, or the gyro's where the log has no commands of them.
#[inline(always)]
pub fn body_rates(p: &Extended<f64>, record: &FlightRecord, command: &[[f64; 4]]) -> Vec<[f64; 3]> {
    if record.commanded[0] {
        command.iter().map(|c| extended::body_rates(p, *c)).collect()
    } else {
        (0..command.len()).map(|i| std::array::from_fn(|k| record.imu[k][i])).collect()
    }
}

/// Commands on their way: those of roll and pitch, of yaw, and of thrust arrive each at their time.
struct Arrivals<'a> {
    sent: &'a [(f64, [f64; 4])],
    late: [f64; 3],
    /// Share that is lost; the one before is held.
    lost: f64,
    /// The last that arrived, and what holds on average.
    at: [usize; 3],
    command: [f64; 4],
}

impl Arrivals<'_> {
    /// Which arrive next, and when.
    #[inline(always)]
    fn next(&self) -> (usize, f64) {
        let due = |g: usize| self.sent.get(self.at[g] + 1).map_or(f64::INFINITY, |next| next.0 + self.late[g]);
        let all = [due(0), due(1), due(2)];
        let g = if all[0] <= all[1].min(all[2]) {
            0
        } else if all[1] <= all[2] {
            1
        } else {
            2
        };
        (g, all[g])
    }

    #[inline(always)]
    fn take(&mut self, g: usize) {
        self.at[g] += 1;
        let i = self.at[g];
        for k in [0..2, 2..3, 3..4][g].clone() {
            let (now, before) = (self.sent[i].1[k], self.sent[i - 1].1[k]);
            self.command[k] = if self.lost == 0.0 { now } else { now + self.lost * (before - now) };
        }
    }
}

/// Filtered commands at every sample; the gyro's samples are `offset` seconds late. Commands are held until the next,
/// and what arrives is integrated exactly.
#[inline(always)]
pub fn actuator_response(
    p: &Extended<f64>,
    record: &FlightRecord,
    model: &Model,
    x: &[f64],
    offset: f64,
) -> ActuatorResponse {
    let n = record.time.len();
    let none = [f64::NAN; 4];
    let Some((first, begin)) = record.sent.first().copied() else {
        return ActuatorResponse {
            command: vec![none; n],
            lag: vec![TurnError::none(); n],
            setpoint: vec![(none, [0.0; 3]); n],
        };
    };
    let late = extended::command_delays(p);
    let imu = model.acting(x, Role::ImuLate);
    let late = [late[0] + offset + imu, late[2] + offset + imu, late[3] + imu];
    let lost = model.acting(x, Role::CommandsLost);
    let stretch = 1.0 / (1.0 + model.acting(x, Role::ClockFast));
    let mut arrivals = Arrivals { sent: &record.sent, late, lost, at: [0; 3], command: begin };
    let mut out = ActuatorResponse::with_capacity(n);
    let mut steps = KeptSteps::<4>::default();
    let (mut command, mut slope, mut now, mut newest) = (begin, [0.0; 3], first, 0);
    for i in 0..n {
        let t = record.time[i] * stretch;
        if t < first {
            out.push(none, TurnError { share: f64::NAN, behind: f64::NAN }, (none, [0.0; 3]));
            continue;
        }
        let voltage = supplied(p, record, i);
        loop {
            let (g, next) = arrivals.next();
            let until = next.min(t);
            if until > now {
                let stood = (command, slope);
                (command, slope) =
                    extended::actuator_response_by(&mut steps, p, stood, arrivals.command, voltage, until - now);
                now = until;
            }
            if next > t {
                break;
            }
            arrivals.take(g);
        }
        let sent = arrivals.command;
        while record.sent.get(newest + 1).is_some_and(|next| next.0 <= t) {
            newest += 1;
        }
        out.push(command, TurnError::of(p, record.sent[newest].1, sent, command), (sent, slope));
    }
    out
}

/// The voltage that a sample's response depends on, V.
#[inline(always)]
pub fn supplied(p: &Extended<f64>, record: &FlightRecord, i: usize) -> f64 {
    if record.voltage[i].is_finite() { record.voltage[i] } else { p.full_v }
}
