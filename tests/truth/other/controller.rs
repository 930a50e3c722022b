//! The flight controller: sticks arrive, are curved and filtered; a PID with a filtered gyro turns them into thrust
//! shares of four motors.

use super::airframe::Airframe;
use super::faults::Faults;
use nalgebra::{Vector3, Vector4};
use std::collections::VecDeque;

/// Loop period, s: two integration steps.
pub const LOOP_S: f64 = 0.001;
/// Cut-off of the gyro's filter and of the derivative's, Hz.
const GYRO_HZ: f64 = 180.0;
const DERIVATIVE_HZ: f64 = 90.0;
/// Integral over proportional gain, 1/s, the error beyond which it relaxes, rad/s, and its limit.
const INTEGRAL: f64 = 4.0;
const RELAXED: f64 = 0.3;
const WOUND: f64 = 0.3;
/// Most that the controller asks for of a turn about each axis, thrust share.
const MOST: [f64; 3] = [0.5, 0.5, 0.2];

/// Roll, pitch, yaw that more of each motor turns toward: front left, front right, rear left, rear right.
pub const MIX: [[f64; 3]; 4] = [[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]];

#[derive(Clone, Debug, Default)]
pub struct Controller {
    /// Commands on their way: when roll, pitch and yaw arrive, when thrust does, and what they are.
    sent: VecDeque<(f64, f64, [f64; 4])>,
    arrived: [f64; 4],
    /// Filters of the sticks, three in a row, and of the throttle, two.
    smooth: [[f64; 3]; 3],
    throttle: [f64; 2],
    filtered: Vector3<f64>,
    derivative: Vector3<f64>,
    wound: Vector3<f64>,
    count: u64,
}

impl Controller {
    /// At rest, throttle closed.
    pub fn resting() -> Self {
        Controller { arrived: [0.0, 0.0, 0.0, -1.0], throttle: [-1.0; 2], ..Self::default() }
    }

    /// The pilot's command (-1..1) leaves at `time`.
    pub fn send(&mut self, time: f64, command: [f64; 4], faults: &Faults) {
        self.count += 1;
        // Varies from packet to packet by a third, never out of turn.
        let varies = 1.0 + 0.33 * (self.count as f64 * 2.399).sin();
        let link = faults.of("link_jitter") * varies;
        let thrust = link + faults.of("throttle_link");
        self.sent.push_back((time + link, time + thrust, command));
        while self.sent.len() > 40 {
            self.sent.pop_front();
        }
    }

    /// Thrust shares (0..1) of the motors after a period of the loop that ends at `time`.
    pub fn next(&mut self, airframe: &Airframe, faults: &Faults, gyro: &Vector3<f64>, time: f64) -> Vector4<f64> {
        for (rates, thrust, command) in &self.sent {
            if *rates <= time + 1e-9 {
                self.arrived[..3].copy_from_slice(&command[..3]);
            }
            if *thrust <= time + 1e-9 {
                self.arrived[3] = command[3];
            }
        }
        let wanted = Vector3::from_fn(|k, _| curve(self.smoothed(k, faults), faults) * airframe.max_rate[k]);
        let before = self.filtered;
        self.filtered += (gyro - self.filtered) * share(GYRO_HZ);
        let slope = (self.filtered - before) / LOOP_S;
        self.derivative += (slope - self.derivative) * share(DERIVATIVE_HZ);
        let error = wanted - self.filtered;
        let mut out = Vector3::zeros();
        for k in 0..3 {
            let gain = airframe.bandwidth[k] / airframe.authority[k];
            let relax = 1.0 / (1.0 + (error[k] / RELAXED).powi(2));
            self.wound[k] = (self.wound[k] + gain * INTEGRAL * error[k] * relax * LOOP_S).clamp(-WOUND, WOUND);
            let asked = gain * (error[k] - airframe.motor_s * self.derivative[k]) + self.wound[k];
            out[k] = asked.clamp(-MOST[k], MOST[k]);
        }
        mix(airframe, self.opened(faults), &out)
    }

    /// A stick behind its filters.
    fn smoothed(&mut self, k: usize, faults: &Faults) -> f64 {
        let tau = faults.of("stick_filter");
        let mut now = self.arrived[k];
        if tau > 0.0 {
            for stage in &mut self.smooth[k] {
                *stage += (now - *stage) * (1.0 - (-LOOP_S / tau).exp());
                now = *stage;
            }
        }
        now
    }

    /// The throttle (0..1) behind its filters.
    fn opened(&mut self, faults: &Faults) -> f64 {
        let tau = faults.of("throttle_filter");
        let mut now = self.arrived[3];
        if tau > 0.0 {
            for stage in &mut self.throttle {
                *stage += (now - *stage) * (1.0 - (-LOOP_S / tau).exp());
                now = *stage;
            }
        }
        0.5 + 0.5 * now
    }
}

fn share(hz: f64) -> f64 {
    1.0 - (-2.0 * std::f64::consts::PI * hz * LOOP_S).exp()
}

/// Share of the full rate that a stick asks for.
fn curve(stick: f64, faults: &Faults) -> f64 {
    let size = stick.abs();
    let bend = faults.of("super_rate");
    let bent = if bend > 0.0 { size * (1.0 - bend) / (1.0 - bend * size) } else { size };
    let power = faults.of("power_rate");
    let shaped = if power > 0.0 { bent.powf(power) } else { bent };
    shaped * stick.signum()
}

/// Shares of the motors for a throttle and a wanted turn: what does not fit moves all motors, as far as there is room.
fn mix(airframe: &Airframe, throttle: f64, turn: &Vector3<f64>) -> Vector4<f64> {
    let mean = (airframe.idle + (1.0 - airframe.idle) * throttle).powi(2);
    let differ = Vector4::from_fn(|i, _| (0..3).map(|k| MIX[i][k] * turn[k]).sum::<f64>());
    let spread = differ.max() - differ.min();
    let differ = if spread > 1.0 { differ / spread } else { differ };
    let mean = mean.min(1.0 - differ.max()).max(-differ.min());
    differ.add_scalar(mean).map(|share| share.clamp(0.0, 1.0))
}
