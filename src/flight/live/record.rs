//! What was flown, as a log.

use crate::flight::Log;
use crate::model::attitude::{body_axes, dot};
use crate::race::onboard::{Estimate, Setpoint};

/// The log of a flight that is under way.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub log: Log,
}

impl Record {
    /// A state that arrived.
    pub fn state(&mut self, time_s: f64, e: &Estimate) {
        let axes = body_axes(e.attitude.map(f64::from));
        let velocity = e.velocity.map(f64::from);
        let [u, v, w] = axes.map(|axis| dot(axis, velocity));
        let [x, y, z] = e.position.map(f64::from);
        let [qw, qx, qy, qz] = e.attitude.map(f64::from);
        self.log.odometry.push(time_s, [x, y, z, qw, qx, qy, qz, u, v, w]);
        let [p, q, r] = e.body_rates.map(f64::from);
        // No accelerometer is in a state.
        self.log.imu.push(time_s, [p, q, r, f64::NAN, f64::NAN, f64::NAN]);
        self.log.battery.push(time_s, [f64::from(e.voltage), f64::NAN]);
    }

    /// A setpoint that was sent.
    pub fn setpoint(&mut self, time_s: f64, s: &Setpoint) {
        let [x, y, z] = s.body_rates.map(f64::from);
        self.log.setpoint.push(time_s, [x, y, z, f64::from(s.throttle)]);
    }
}
