//! Where the numbers of an identified vehicle come from. Nothing here changes how it flies.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The origin of an identified vehicle. Nothing here changes how it flies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identified {
    /// Version of racer that identified it.
    pub racer: String,
    /// The vehicle that lent what the flights could not tell.
    pub base: String,
    /// Rate setpoints that a command of 1 stands for: roll, pitch, yaw, deg/s. A policy's command times these is what
    /// the flight controller is to be sent.
    pub full_rate_deg_s: [f64; 3],
    /// What the thrust was identified from.
    #[serde(default)]
    pub thrust_from: ThrustSource,
    /// The flights.
    pub logs: Vec<LogSpan>,
    /// Where each number comes from, by the key of this file.
    #[serde(default)]
    pub origin: BTreeMap<String, Origin>,
    /// Keys of this file that the base vehicle lent, and why.
    pub assumed: BTreeMap<String, String>,
    /// 95 % confidence intervals by key, of numbers that the logs told; drag as deceleration over speed squared, 1/m.
    pub interval: BTreeMap<String, [f64; 2]>,
    /// From command to rotors, where the log told it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotors: Option<RotorChain>,
    /// Constant errors of the sensors that logged the flights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensors: Option<SensorOffsets>,
}

/// A flight, and from when to when it was used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogSpan {
    /// Name of the log.
    pub name: String,
    /// s since the start of the log.
    pub span_s: [f64; 2],
}

/// Where a number comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// Fitted to what the log measured.
    #[serde(rename = "log")]
    Log,
    /// What the log says about the vehicle.
    #[serde(rename = "record of the log")]
    Record,
    /// An option of the command line.
    #[serde(rename = "option")]
    Option,
    /// Lent by the base vehicle.
    #[serde(rename = "base vehicle")]
    Base,
}

/// What the thrust was identified from: the signal nearest to the rotors that the logs have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ThrustSource {
    /// The collective command, as the flight controller received it.
    #[default]
    #[serde(rename = "collective command")]
    Command,
    /// What each motor was sent.
    #[serde(rename = "motor outputs")]
    Motors,
    /// The speed of each rotor; thrust is proportional to its square.
    #[serde(rename = "rotor speeds")]
    Speeds,
}

impl ThrustSource {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Command => "collective command",
            Self::Motors => "motor outputs",
            Self::Speeds => "rotor speeds",
        }
    }
}

/// From the collective command to the rotors: what the flight controller makes of it, and how late they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotorChain {
    /// Mean motor output, 0..1, at no collective command and no rate demand.
    pub motor_offset: f64,
    /// What a full command adds at `motor_at_v`.
    pub motor_gain: f64,
    /// Power of the command in the output: a half where the flight controller takes outputs for rotor speeds and
    /// commands for thrust, 1 where it takes both alike.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub motor_power: f64,
    /// By how much that changes with the voltage, 1/V.
    pub motor_gain_per_v: f64,
    /// V.
    pub motor_at_v: f64,
    /// Command that a rotor speed stands for, s/rad, where the log has no other command.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command_per_speed: Option<f64>,
    /// Lag of the motor outputs behind the command, s; it is a part of `time_constant_s.thrust`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command_lag_s: Option<f64>,
    /// Lag of the rotors behind the motor outputs, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_lag_s: Option<f64>,
    /// Thrust of all rotors over the mean square of their speeds, N s2/rad2, where the log has their speeds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_n_per_speed_squared: Option<f64>,
}

impl RotorChain {
    /// Motor outputs are the command.
    pub const DIRECT: Self = Self {
        motor_offset: 0.0,
        motor_gain: 1.0,
        motor_power: 1.0,
        motor_gain_per_v: 0.0,
        motor_at_v: 0.0,
        command_per_speed: None,
        command_lag_s: None,
        rotor_lag_s: None,
        thrust_n_per_speed_squared: None,
    };

    /// Change of the mean motor output over that of the collective command at `volts`.
    fn gain(&self, volts: f64) -> f64 {
        let off = if volts.is_finite() { volts - self.motor_at_v } else { 0.0 };
        self.motor_gain + self.motor_gain_per_v * off
    }

    /// Mean motor output, 0..1, of a collective command of 0..1 without rate demand.
    pub fn motor(&self, command: f64, volts: f64) -> f64 {
        self.motor_offset + self.gain(volts) * power(command, self.motor_power)
    }

    /// The collective command, 0..1, that leads to this motor output.
    pub fn command(&self, motor: f64, volts: f64) -> f64 {
        power((motor - self.motor_offset) / self.gain(volts), 1.0 / self.motor_power)
    }
}

/// With the sign of `x`.
fn power(x: f64, exponent: f64) -> f64 {
    x.abs().powf(exponent).copysign(x)
}

fn one() -> f64 {
    1.0
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

/// Constant errors of the sensors, as the flights showed them: what a prediction of their readings adds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorOffsets {
    /// Roll, pitch, yaw, rad/s.
    pub gyro_rad_s: [f64; 3],
    /// Along x, y, z, m/s2.
    pub accelerometer_m_s2: [f64; 3],
}
