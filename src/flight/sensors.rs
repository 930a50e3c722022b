//! How simulated flights are measured: rates, noise, bias and resolution of each stream.

use crate::base::check::{BadInput, Check, Invalid};
use crate::base::document::Library;
use crate::base::rng::Sequence;
use rand::RngExt;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

const LIBRARY: Library = Library {
    kind: "sensors",
    folder: "configs/sensors",
    builtin: &[
        ("ideal", include_str!("../../configs/sensors/ideal.toml")),
        ("typical", include_str!("../../configs/sensors/typical.toml")),
    ],
};

/// The sensors of a vehicle. Setpoints are recorded as they were sent, at 100 Hz.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorConfig {
    /// Body rates and specific force.
    pub imu: Imu,
    /// Position, velocity and attitude.
    pub odometry: Odometry,
    /// The battery's voltage.
    pub battery: Voltmeter,
}

/// Body rates (rad/s) and specific force (m/s2).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Imu {
    /// A multiple of 100 Hz, up to 8000; also the rate at which the flight is integrated.
    pub rate_hz: f64,
    /// Errors of the body rates, rad/s.
    pub gyro: Channel,
    /// Errors of the specific force, m/s2.
    pub specific_force: Channel,
}

/// Position (m), velocity (m/s) and attitude (rad).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Odometry {
    /// At most the IMU's; samples fall on those of the IMU.
    pub rate_hz: f64,
    /// Errors of the position, m.
    pub position: Channel,
    /// Errors of the velocity, m/s.
    pub velocity: Channel,
    /// Errors of the attitude, rad.
    pub attitude: Turn,
}

/// Battery voltage (V).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Voltmeter {
    /// At most the IMU's; samples fall on those of the IMU.
    pub rate_hz: f64,
    /// Errors of the voltage, V.
    pub voltage: Channel,
}

/// Errors of one quantity, along each axis, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Standard deviation of each sample.
    pub noise: f64,
    /// Standard deviation of the constant that a flight draws.
    pub bias: f64,
    /// Smallest difference between two readings; 0 for none.
    pub step: f64,
    /// Largest reading.
    #[serde(default = "unlimited")]
    pub range: f64,
}

/// Errors of an attitude: small rotations, rad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Standard deviation of each sample, about each body axis.
    pub noise: f64,
    /// Standard deviation of the constant that a flight draws, about each body axis.
    pub bias: f64,
}

fn unlimited() -> f64 {
    f64::INFINITY
}

impl SensorConfig {
    /// Reads sensors by name or file.
    pub fn load(name: &str) -> Result<Self, BadInput> {
        LIBRARY.open(name)?.decode()
    }

    /// The built-in ones without errors.
    pub fn ideal() -> Self {
        LIBRARY.built_in("ideal").and_then(|file| file.decode()).expect("a built-in file is valid")
    }
}

impl Channel {
    /// Draws the constant error of a flight.
    pub fn draw_bias<const N: usize>(&self, rng: &mut Sequence) -> [f64; N] {
        std::array::from_fn(|_| self.bias * rng.sample::<f64, _>(StandardNormal))
    }

    /// What is read of `truth`.
    pub fn read<const N: usize>(&self, truth: [f64; N], bias: [f64; N], rng: &mut Sequence) -> [f64; N] {
        std::array::from_fn(|i| {
            let x = truth[i] + bias[i] + self.noise * rng.sample::<f64, _>(StandardNormal);
            let x = if self.step > 0.0 { (x / self.step).round() * self.step } else { x };
            x.clamp(-self.range, self.range)
        })
    }
}

impl Turn {
    /// The same errors as a channel of rotation vectors.
    pub fn channel(self) -> Channel {
        Channel { noise: self.noise, bias: self.bias, step: 0.0, range: f64::INFINITY }
    }
}

impl Check for Channel {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless_not_negative("noise", self.noise, "")?;
        Invalid::unless_not_negative("bias", self.bias, "")?;
        Invalid::unless_not_negative("step", self.step, "0 for none")?;
        Invalid::unless(self.range > 0.0, "range", self.range, "a number above 0", "leave it out for none")
    }
}

impl Check for SensorConfig {
    fn check(&self) -> Result<(), Invalid> {
        let Self { imu, odometry, battery } = self;
        let whole = imu.rate_hz % 100.0 == 0.0 && (100.0..=8000.0).contains(&imu.rate_hz);
        let expected = "a multiple of 100, 100 to 8000";
        Invalid::unless(whole, "imu.rate_hz", imu.rate_hz, expected, "commands are sent at 100 Hz")?;
        for (key, rate) in [("odometry.rate_hz", odometry.rate_hz), ("battery.rate_hz", battery.rate_hz)] {
            let expected = format!("above 0 and at most imu.rate_hz = {}", imu.rate_hz);
            Invalid::unless(rate > 0.0 && rate <= imu.rate_hz, key, rate, &expected, "")?;
        }
        for (key, channel) in [
            ("imu.gyro", imu.gyro),
            ("imu.specific_force", imu.specific_force),
            ("odometry.position", odometry.position),
            ("odometry.velocity", odometry.velocity),
            ("odometry.attitude", odometry.attitude.channel()),
            ("battery.voltage", battery.voltage),
        ] {
            channel.check().map_err(|invalid| invalid.within(key))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};

    #[test]
    fn errors_are_as_large_as_configured() {
        let channel = Channel { noise: 0.5, bias: 0.0, step: 0.25, range: 3.0 };
        let mut rng = Philox::new(1).sequence(RngStream::Sensors, 0, 0);
        let read: Vec<f64> = (0..20_000).map(|_| channel.read([1.0], [0.5], &mut rng)[0]).collect();
        let mean = read.iter().sum::<f64>() / read.len() as f64;
        let variance = read.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / read.len() as f64;
        // Rounding adds step^2 / 12.
        assert!((mean - 1.5).abs() < 0.02 && (variance - 0.25 - 0.0052).abs() < 0.01, "{mean} {variance}");
        assert!(read.iter().all(|x| x % 0.25 == 0.0 && *x <= 3.0));
    }

    #[test]
    fn built_in_sensors_load_and_nonsense_does_not() {
        assert_eq!(SensorConfig::load("ideal").unwrap().imu.gyro.range, f64::INFINITY);
        let good = SensorConfig::load("typical").unwrap();
        let mut bad = good.clone();
        bad.imu.rate_hz = 250.0;
        assert_eq!(bad.check().unwrap_err().key, "imu.rate_hz");
        bad = good.clone();
        bad.odometry.rate_hz = 1000.0;
        assert_eq!(bad.check().unwrap_err().key, "odometry.rate_hz");
        bad = good;
        bad.odometry.attitude.noise = f64::NAN;
        assert_eq!(bad.check().unwrap_err().key, "odometry.attitude.noise");
    }
}
