//! A flight, ready to be predicted: what was commanded, what the surroundings were, and what was measured, on the IMU's
//! clock.

use super::motors::{Driven, driven};
use crate::base::stats::quantile;
use crate::flight::Log;
use crate::flight::series::{last_at, period};
use crate::flight::spans::{contain, length};
use crate::insight::criteria::consistent::ONE_CLOCK_SHARE;
use crate::insight::criteria::identified::CALM_LEAST;
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::prepare::rotors::{command_per_speed, mixing};
use crate::insight::prepare::windows::{often_enough, windows};
use crate::insight::quality::Quality;
use crate::model::attitude::{Quaternion, body_axes, rotation_vector_near};
use crate::model::vehicle::Vehicle;

/// Width of a bin: residuals of rates and specific force are averaged over it, s.
pub const BIN_S: f64 = 0.01;
/// Length of the stretches over which turns and pushes are compared, s.
const OVER_S: f64 = 0.25;

/// The IMU is thinned to about this rate for the residuals of rates and forces, Hz: what more of it says is the same
/// again. What is integrated stays whole.
const ENOUGH_HZ: f64 = 250.0;

/// The whole IMU, for integration.
#[derive(Debug)]
pub struct Fine {
    pub time: Vec<f64>,
    pub imu: [Vec<f64>; 6],
    /// Its samples for one of the record's.
    pub every: usize,
}

/// One flight.
#[derive(Debug)]
pub struct FlightRecord {
    pub name: String,
    /// Usable flight, s.
    pub usable_s: f64,
    /// By how much the odometry's clock was moved to the gyro's, s.
    pub moved: f64,
    pub fine: Fine,
    /// Of the thinned IMU, and its period, s.
    pub time: Vec<f64>,
    pub period_s: f64,
    pub usable: Vec<bool>,
    /// Stretch of time of each sample, counted over all flights.
    pub block: Vec<u32>,
    /// Commands and when they were given, s: roll, pitch, yaw, thrust, -1..1.
    pub sent: Vec<(f64, [f64; 4])>,
    /// Whether rates and thrust were commanded.
    pub commanded: [bool; 2],
    /// Whether commands and IMU were stamped by one clock, and whether the thrust command is in truth a measured rotor
    /// speed.
    pub one_clock: bool,
    pub from_rotors: bool,
    /// Body rates (rad/s) and specific force (m/s2) as measured.
    pub imu: [Vec<f64>; 6],
    /// What its motors are driven with, each two seconds.
    pub driven: Vec<Driven>,
    /// Velocity, body frame, m/s; 0 throughout where the log does not know it.
    pub velocity: [Vec<f64>; 3],
    pub moves: bool,
    /// Attitude (body to world), and the body's axes in the world; level where the log does not know it.
    pub attitude: Vec<Quaternion<f64>>,
    pub axes: Vec<[[f64; 3]; 3]>,
    /// Over the ground, m; 1 km where the log does not know it.
    pub height: Vec<f64>,
    pub position: [Vec<f64>; 3],
    /// Voltage, smoothed, at every sample; NaN throughout where it was not measured.
    pub voltage: Vec<f64>,
    /// Measured voltages: the sample that follows, and V.
    pub volts: Vec<(usize, f64)>,
    /// First and last sample of the stretches over which turn and push are compared.
    pub windows: Vec<[usize; 2]>,
    /// First sample of each bin, and one beyond its last.
    pub bins: Vec<[usize; 2]>,
    /// Whether the thrust of each bin is what a mixer made of the command.
    pub mixed: Vec<bool>,
}

impl FlightRecord {
    /// `flight` of a vehicle like `base`; `full_rate_rad_s` is what a full stick asks for.
    pub fn new(flight: &PreparedFlight, full_rate_rad_s: [f64; 3]) -> Self {
        Self::at_rate(flight, full_rate_rad_s, ENOUGH_HZ)
    }

    /// The same with the IMU thinned to about `enough_hz`; infinite keeps all of it.
    pub fn at_rate(flight: &PreparedFlight, full_rate_rad_s: [f64; 3], enough_hz: f64) -> Self {
        let quality = &flight.quality;
        let log = &quality.log;
        let every = ((1.0 / period(&flight.time)) / enough_hz * 1.05).floor().max(1.0) as usize;
        let thin = |x: &[f64]| -> Vec<f64> { x.iter().copied().step_by(every).collect() };
        let fine = Fine { time: flight.time.clone(), imu: std::array::from_fn(|k| flight.measured(k)), every };
        let time = thin(&flight.time);
        let usable: Vec<bool> = flight.usable.iter().copied().step_by(every).collect();
        let attitude: Vec<Quaternion<f64>> = flight.attitude.iter().copied().step_by(every).collect();
        let turns = attitude.iter().any(|q| q[0].is_finite());
        let level = [1.0, 0.0, 0.0, 0.0];
        let attitude: Vec<_> = if turns { attitude } else { vec![level; time.len()] };
        let axes = attitude.iter().map(|q| body_axes(*q)).collect();
        let moves = flight.velocity[0].iter().any(|v| v.is_finite());
        let velocity = if moves {
            std::array::from_fn(|k| thin(&flight.velocity[k]))
        } else {
            std::array::from_fn(|_| vec![0.0; time.len()])
        };
        let position: [Vec<f64>; 3] = std::array::from_fn(|k| thin(&flight.position[k]));
        let finite: Vec<f64> = position[2].iter().copied().filter(|z| z.is_finite()).collect();
        let ground = quantile(&finite, 0.002);
        let height = position[2].iter().map(|z| if ground.is_finite() { z - ground } else { 1e3 }).collect();
        let volts = log.battery.time_s.iter().zip(&log.battery.rows).filter(|(_, row)| row[0] > 0.0);
        let volts = volts.map(|(t, row)| (last_at(&time, *t).map_or(0, |i| i + 1), row[0]));
        let volts = volts.filter(|(i, _)| *i < time.len() && usable[*i]).collect();
        let mut out = Self {
            name: log.name.clone(),
            usable_s: length(&quality.usable),
            moved: quality.moved_s,
            usable,
            block: flight.block.iter().copied().step_by(every).collect(),
            sent: sent(quality, full_rate_rad_s),
            one_clock: one_clock(log),
            from_rotors: command_per_speed(log).is_some(),
            commanded: [0, 3].map(|k| log.setpoint.rows.iter().any(|row| row[k].is_finite())),
            imu: std::array::from_fn(|k| thin(&fine.imu[k])),
            driven: driven(log, &quality.usable),
            fine,
            velocity,
            moves,
            attitude,
            axes,
            height,
            position,
            voltage: thin(&flight.voltage),
            volts,
            windows: Vec::new(),
            bins: Vec::new(),
            mixed: Vec::new(),
            period_s: period(&time),
            time,
        };
        out.bins = out.divide(BIN_S.max(out.period_s * 0.99));
        out.mixed = out.mixed(log);
        if turns && often_enough(&log.odometry) {
            out.windows = out.stretches();
        }
        out
    }

    /// Whether each bin is the mixer's; none where hardly any would be left.
    fn mixed(&self, log: &Log) -> Vec<bool> {
        let mixing = mixing(log);
        let mixed: Vec<bool> = self.bins.iter().map(|[from, _]| contain(&mixing, self.time[*from])).collect();
        let left = mixed.iter().filter(|mixed| !**mixed).count() as f64;
        if left < CALM_LEAST.get() * mixed.len() as f64 { vec![false; mixed.len()] } else { mixed }
    }

    fn divide(&self, width: f64) -> Vec<[usize; 2]> {
        let mut out = Vec::new();
        let mut from = 0;
        while from < self.time.len() {
            let bin = (self.time[from] / width).floor();
            let to = (from..self.time.len()).find(|&i| (self.time[i] / width).floor() > bin).unwrap_or(self.time.len());
            if (from..to).all(|i| self.usable[i]) {
                out.push([from, to]);
            }
            from = to;
        }
        out
    }

    fn stretches(&self) -> Vec<[usize; 2]> {
        let usable = |[from, to]: [usize; 2]| (from..=to).all(|i| self.usable[i]);
        let known = |ends: [usize; 2]| ends.iter().all(|&i| self.attitude[i][0].is_finite());
        windows(&self.time, OVER_S, |ends| usable(ends) && known(ends))
    }

    /// The turn `q` over a window, rad: a fast flip is more than half a turn, and only the gyro tells which way round.
    #[inline(always)]
    pub fn turn(&self, q: Quaternion<f64>, &[from, to]: &[usize; 2]) -> [f64; 3] {
        let turned = |gyro: &[f64]| (from..to).map(|i| gyro[i] * (self.time[i + 1] - self.time[i])).sum();
        rotation_vector_near(q, || std::array::from_fn(|k| turned(&self.imu[k])))
    }

    /// When the flight begins, s.
    pub fn since(&self) -> f64 {
        self.time.iter().zip(&self.usable).find(|(_, usable)| **usable).map_or(0.0, |(t, _)| *t)
    }
}

/// Whether nearly every command carries the time stamp of a sample of the IMU.
fn one_clock(log: &Log) -> bool {
    let same = |t: &&f64| last_at(&log.imu.time_s, **t).is_some_and(|i| log.imu.time_s[i] == **t);
    let n = log.setpoint.len();
    n > 0 && log.setpoint.time_s.iter().filter(same).count() as f64 > ONE_CLOCK_SHARE.get() * n as f64
}

/// Commands as shares of what a full stick asks for; what was not commanded is 0.
fn sent(quality: &Quality, full: [f64; 3]) -> Vec<(f64, [f64; 4])> {
    let setpoint = &quality.log.setpoint;
    let mut now = [0.0, 0.0, 0.0, -1.0];
    let mut out = Vec::with_capacity(setpoint.len());
    for (t, row) in setpoint.time_s.iter().zip(&setpoint.rows) {
        for k in 0..4 {
            if row[k].is_finite() {
                now[k] = if k < 3 { row[k] / full[k] } else { 2.0 * row[k] - 1.0 };
            }
        }
        out.push((*t, now));
    }
    out
}

/// What a full stick asks for, rad/s: as the vehicle file says, else the log, else the vehicle's rates.
pub fn full_rate(vehicle: &Vehicle, quality: &Quality) -> [f64; 3] {
    let identified = vehicle.identified.as_ref().map(|i| i.full_rate_deg_s.map(f64::to_radians));
    identified.or(quality.log.vehicle.max_rate_rad_s).unwrap_or(vehicle.max_rates_rad_s())
}
