//! What the model says the sensors of a flight should have read: the same stages as the simulator's, driven by the log.

mod readings;

use super::actuator_response::{ActuatorResponse, actuator_response, body_rates};
use super::bends;
use super::channels::{CHANNELS, TURN, VOLTAGE};
use super::forms;
use super::imu_seen::{LaggedForce, ShiftedImu};
use super::kinematics;
use super::model::Model;
use super::numbers::BEGIN;
use super::record::FlightRecord;
use crate::base::lane::{build, fused};
use crate::flight::lowpass::LowPass;
use crate::model::attitude::dot;
use crate::model::dynamics::battery::discharged;
use crate::model::dynamics::extended::{self, Extended, ForceInputs, TurnError};
use crate::model::effects::{Quantities, Quantity, Role};
use rayon::prelude::*;
use std::sync::Arc;

/// Cut-off below which the measured voltage is believed rather than the modelled one, Hz.
const VOLTAGE_HZ: f64 = 0.5;

/// Samples that one thread predicts while others predict others.
const SIDE_BY_SIDE: usize = 4096;

/// One flight, predicted; every stage is kept and shared, so that a number late in the chain is cheap to change.
#[derive(Clone, Debug, Default)]
pub struct Predicted {
    /// Filtered commands, and how far those of the rates lag.
    command: Arc<Vec<[f64; 4]>>,
    lag: Arc<Vec<TurnError<f64>>>,
    /// What the filtered commands go to, and how fast those of the rates change.
    setpoint: Arc<Vec<([f64; 4], [f64; 3])>>,
    /// Body rates, and those that the gyro's late samples show.
    pub rates: Arc<Vec<[f64; 3]>>,
    seen_rates: Arc<Vec<[f64; 3]>>,
    /// At the terminals, modelled and as thrust sees it, V.
    pub modelled_v: Arc<Vec<f64>>,
    pub voltage: Arc<Vec<f64>>,
    /// Specific force, m/s2.
    pub force: Arc<Vec<[f64; 3]>>,
    /// By channel, in the units of [`FlightRecord`]; empty where the log lacks it.
    pub channels: [Arc<Vec<f64>>; CHANNELS],
    /// The IMU on the odometry's clock, and its specific force as a late velocity sees it.
    shifted: Arc<ShiftedImu>,
    lagged: Arc<LaggedForce>,
}

impl Predicted {
    /// Filtered thrust command at a sample, -1..1.
    pub fn thrust(&self, i: usize) -> f64 {
        self.command[i][3]
    }

    /// How far the rates lag at a sample.
    pub fn lag(&self, i: usize) -> TurnError<f64> {
        self.lag[i]
    }

    /// Predicts `record`, number `flight`, at `x`.
    pub fn new(model: &Model, record: &FlightRecord, flight: usize, x: &[f64]) -> Self {
        Self::default().recomputed(Quantities::ALL, model, record, flight, x)
    }

    /// The same at other numbers, of which no more is `dirty`.
    pub fn changed(&self, dirty: Quantities, model: &Model, record: &FlightRecord, flight: usize, x: &[f64]) -> Self {
        self.clone().recomputed(dirty, model, record, flight, x)
    }

    fn recomputed(mut self, dirty: Quantities, model: &Model, record: &FlightRecord, flight: usize, x: &[f64]) -> Self {
        let p = model.parameters(x);
        // One body for every processor: a fused multiply-add is an instruction there, and a call of
        // a function elsewhere.
        if dirty.any(&[Quantity::RateCommand, Quantity::ThrustCommand]) {
            let ActuatorResponse { command, lag, setpoint } = fused(
                #[inline(always)]
                || actuator_response(&p, record, model, x, 0.0),
            );
            (self.command, self.lag, self.setpoint) = (command.into(), lag.into(), setpoint.into());
        }
        if !dirty.has(Quantity::Integrated) {
            self.read(&p, dirty, model, record, flight, x);
            return self;
        }
        // What the sensors should read, and what the IMU's readings integrate to: neither needs the other.
        let (shifted, command) = (self.shifted.clone(), self.command.clone());
        let ((), (shifted, integrated)) = rayon::join(
            || self.read(&p, dirty, model, record, flight, x),
            || {
                fused(
                    #[inline(always)]
                    || {
                        let shifted = ShiftedImu::renewed(shifted, record, kinematics::offsets(model, record, x));
                        let integrated = kinematics::integrate(model, record, x, &command, &shifted);
                        (shifted, integrated)
                    },
                )
            },
        );
        self.shifted = shifted;
        integrated.into_iter().enumerate().for_each(|(c, values)| self.channels[TURN + c] = values.into());
        self
    }

    /// What the IMU and the voltmeter read.
    fn read(
        &mut self,
        p: &Extended<f64>,
        dirty: Quantities,
        model: &Model,
        record: &FlightRecord,
        flight: usize,
        x: &[f64],
    ) {
        fused(
            #[inline(always)]
            || {
                if dirty.any(&[Quantity::BodyRates, Quantity::GyroTime]) {
                    self.turn(p, model, record, x);
                }
                if dirty.has(Quantity::Voltage) {
                    self.discharge(p, record, x[BEGIN + flight]);
                    let seen = record.volts.iter().map(|(i, _)| self.modelled_v[*i]);
                    self.channels[VOLTAGE] = seen.collect::<Vec<_>>().into();
                }
                if dirty.has(Quantity::SpecificForce) {
                    let lag = [model.acting(x, Role::VelocityLag), model.vehicle().gravity_m_s2];
                    self.push(p, record, lag);
                    self.bend_thrust(model, record, x);
                }
                if dirty.any(&[Quantity::Gyro, Quantity::Accelerometer]) {
                    self.sense(p, dirty, model, record, x);
                }
            },
        );
    }

    /// Body rates, and as a late gyro shows them.
    #[inline(always)]
    fn turn(&mut self, p: &Extended<f64>, model: &Model, record: &FlightRecord, x: &[f64]) {
        let offset = model.acting(x, Role::GyroLate);
        self.rates = body_rates(p, record, &self.command).into();
        self.seen_rates = if offset == 0.0 {
            self.rates.clone()
        } else {
            body_rates(p, record, &actuator_response(p, record, model, x, offset).command).into()
        };
    }

    /// Modelled voltage, and that with its slow error taken off, which thrust sees.
    #[inline(always)]
    fn discharge(&mut self, p: &Extended<f64>, record: &FlightRecord, begin_v: f64) {
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
            let open = discharged(begin_v, p.compact.voltage_rate, t - since);
            let command = if self.command[i][3].is_finite() { self.command[i][3] } else { -1.0 };
            let (v, next) = extended::terminal(p, open, command, polarisation, (t - before).max(0.0));
            (polarisation, before) = (next, t.max(since));
            modelled.push(v);
        }
        let mut error: Vec<f64> = record.voltage.iter().zip(&modelled).map(|(m, v)| m - v).collect();
        if let Some(filter) = LowPass::new(VOLTAGE_HZ, record.period_s) {
            filter.run(&mut error);
        }
        self.voltage = modelled.iter().zip(error).map(|(v, e)| v + e).collect::<Vec<_>>().into();
        self.modelled_v = modelled.into();
    }

    /// Specific force. A velocity that lags by `tau` is taken as what it will be.
    #[inline(always)]
    fn push(&mut self, p: &Extended<f64>, record: &FlightRecord, [tau, gravity]: [f64; 2]) {
        if tau > 0.0 {
            self.lagged = LaggedForce::renewed(std::mem::take(&mut self.lagged), record, tau);
        }
        let (since, this) = (record.since(), &*self);
        let mut out = vec![[0.0; 3]; record.time.len()];
        out.par_chunks_mut(SIDE_BY_SIDE).enumerate().for_each(|(chunk, out)| {
            fused(
                #[inline(always)]
                || {
                    for (j, out) in out.iter_mut().enumerate() {
                        *out = extended::force(
                            p,
                            &this.force_inputs(record, [tau, gravity, since], chunk * SIDE_BY_SIDE + j),
                        );
                    }
                },
            );
        });
        self.force = out.into();
    }

    /// What acts on a sample. Inline, so that all of it is compiled for a processor with a fused multiply-add.
    #[inline(always)]
    fn force_inputs(&self, record: &FlightRecord, [tau, gravity, since]: [f64; 3], i: usize) -> ForceInputs<f64> {
        let mut velocity: [f64; 3] = build!(|k| record.velocity[k][i]);
        if tau > 0.0 {
            let mut gains = self.lagged.world[i * record.fine.every];
            gains[2] -= gravity;
            for k in 0..3 {
                velocity[k] += tau * dot(record.axes[i][k], gains);
            }
        }
        ForceInputs {
            command: self.command[i][3],
            voltage: self.voltage[i],
            axes: record.axes[i],
            velocity,
            rates: self.rates[i],
            height: record.height[i],
            turn_error: self.lag[i],
            elapsed: record.time[i] - since,
        }
    }

    /// What the thrust has beside its curve.
    fn bend_thrust(&mut self, model: &Model, record: &FlightRecord, x: &[f64]) {
        let Some(sizes) = bends::thrust(x).filter(|_| !record.volts.is_empty()) else { return };
        let middle = model.middle_v();
        for (i, force) in Arc::make_mut(&mut self.force).iter_mut().enumerate() {
            let forms = forms::thrust(self.command[i][3], self.voltage[i] / middle - 1.0);
            force[2] += sizes.iter().zip(forms).map(|(size, form)| size * form).sum::<f64>();
        }
    }
}
