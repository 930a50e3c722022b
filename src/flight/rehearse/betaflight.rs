//! What Betaflight's simulator build is sent and sends, over UDP on this machine, and how it is set up.
//!
//! Read in its source (its platform SIMULATOR, 2026.12): a state is 18 doubles, sticks are a double and 16 u16, motors
//! come as a u16, two bytes of nothing and 16 floats; all in this machine's byte order. The time in a state is never
//! changed, so that the firmware's clock goes as fast as the clock it is given ([`super::clock`]).

pub mod process;
pub mod wire;

use super::sticks::Sticks;
use crate::flight::instruments::Actual;
use crate::model::vehicle::AXES;
use std::fmt::Write;

/// Where states and sticks go, and where motors arrive.
pub const STATE_PORT: u16 = 9003;
pub const STICKS_PORT: u16 = 9004;
pub const MOTORS_PORT: u16 = 9001;

pub const STATE_BYTES: usize = 18 * 8;
pub const STICKS_BYTES: usize = 8 + 16 * 2;
pub const MOTORS_BYTES: usize = 4 + 16 * 4;

/// Pulse of a stick in the middle, and from there to its end; of a switch that is off, us.
const MIDDLE_US: f64 = 1500.0;
const HALF_US: f64 = 500.0;
const CLOSED_US: u16 = 988;

/// The packet of `held` sticks.
pub fn sticks(held: &Sticks) -> [u8; STICKS_BYTES] {
    let [roll, pitch, yaw] = held.rates.map(|share| share.clamp(-1.0, 1.0) * HALF_US);
    let pulse = |us: f64| (MIDDLE_US + us).round() as u16;
    let throttle = held.throttle.map_or(CLOSED_US, |open| pulse(2.0 * HALF_US * (open.clamp(0.0, 1.0) - 0.5)));
    let switch = if held.armed { 2000 } else { 1000 };
    let mut channels = [1000u16; 16];
    channels[..5].copy_from_slice(&[pulse(roll), pulse(pitch), throttle, pulse(-yaw), switch]);
    let mut out = [0; STICKS_BYTES];
    out[8..].copy_from_slice(&channels.map(u16::to_ne_bytes).concat());
    out
}

/// The packet of a state; `imu` is what was measured of its body rates (rad/s) and specific force (m/s2).
pub fn state(now: &Actual, imu: &[f64; 6]) -> [u8; STATE_BYTES] {
    let [p, q, r, x, y, z] = *imu;
    let [qw, qx, qy, qz] = now.attitude;
    // Its sensor looks down: y and z are turned about x, but for the yaw rate, which it takes as it is.
    let felt = [1.0, p, -q, r, -x, -y, -z, qw, qx, -qy, -qz];
    let numbers = [felt.as_slice(), &now.velocity, &now.position, &[101_325.0]];
    let mut out = [0; STATE_BYTES];
    let bytes = numbers.concat().into_iter().flat_map(f64::to_ne_bytes);
    out.iter_mut().zip(bytes).for_each(|(to, byte)| *to = byte);
    out
}

/// What each motor is sent, 0..1, in a packet of the firmware's; none where it is no such packet.
pub fn motors(bytes: &[u8]) -> Option<[f64; 4]> {
    let pulse = |i: usize| bytes[4 + 4 * i..8 + 4 * i].try_into().map(f32::from_ne_bytes).unwrap_or(f32::NAN);
    let shares: Option<[f64; 4]> =
        (bytes.len() == MOTORS_BYTES).then(|| std::array::from_fn(|i| 1e-3 * (f64::from(pulse(i)) - 1000.0)));
    shares.filter(|shares| shares.iter().all(|share| (-0.01..=1.01).contains(share)))
}

/// Full rates that the firmware can be set to, rad/s: in tens of degrees, at least `wanted`.
pub fn full_rates(wanted: [f64; 3]) -> [f64; 3] {
    wanted.map(|rate| (10.0 * tens(rate)).to_radians())
}

fn tens(rate: f64) -> f64 {
    (rate.to_degrees() / 10.0 - 1e-9).ceil().clamp(1.0, 199.0)
}

/// Command lines for a firmware whose sticks are to be rates of at most `wanted` (rad/s) and throttle, straight, and
/// that logs its flight.
pub fn settings(wanted: [f64; 3]) -> String {
    let mut out = String::from(
        "feature -GPS
feature AIRMODE
aux 0 0 0 1700 2100 0 0
set small_angle = 180
set pwr_on_arm_grace = 0
set runaway_takeoff_prevention = OFF
set auto_disarm_delay = 0
set min_check = 1000
set deadband = 0
set yaw_deadband = 0
set rc_smoothing = OFF
set throttle_boost = 0
set thr_mid = 50
set thr_expo = 0
set throttle_limit_type = OFF
set rates_type = ACTUAL
set blackbox_device = VIRTUAL
set blackbox_mode = NORMAL
set blackbox_sample_rate = 1/2
",
    );
    for (axis, rate) in AXES.into_iter().zip(wanted) {
        let tens = tens(rate);
        let _ = write!(out, "set {axis}_rc_rate = {tens}\nset {axis}_srate = {tens}\nset {axis}_expo = 0\n");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn double(bytes: &[u8], i: usize) -> f64 {
        f64::from_ne_bytes(bytes[8 * i..8 * i + 8].try_into().unwrap())
    }

    #[test]
    fn packets_are_laid_out_as_the_firmware_reads_them() {
        let actual = Actual {
            position: [1.0, 2.0, 3.0],
            velocity: [4.0, 5.0, 6.0],
            attitude: [0.5, 0.1, 0.2, 0.3],
            body_rates: [0.0; 3],
            specific_force: [0.0; 3],
            voltage: 16.0,
        };
        let packet = state(&actual, &[0.1, 0.2, 0.3, 7.0, 8.0, 9.8]);
        let expected =
            [1.0, 0.1, -0.2, 0.3, -7.0, -8.0, -9.8, 0.5, 0.1, -0.2, -0.3, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0, 101_325.0];
        assert!((0..18).all(|i| double(&packet, i) == expected[i]));

        let channel = |packet: &[u8], i: usize| u16::from_ne_bytes([packet[8 + 2 * i], packet[9 + 2 * i]]);
        let flying = sticks(&Sticks { rates: [1.0, -0.5, 0.25], throttle: Some(0.25), armed: true });
        assert_eq!([0, 1, 2, 3, 4].map(|i| channel(&flying, i)), [2000, 1250, 1250, 1375, 2000]);
        let resting = sticks(&Sticks::default());
        assert_eq!([0, 1, 2, 3, 4].map(|i| channel(&resting, i)), [1500, 1500, 988, 1500, 1000]);
    }

    #[test]
    fn only_whole_packets_of_motors_are_taken() {
        let mut packet = vec![4, 0, 0, 0];
        [1000.0f32, 1250.0, 1500.0, 2000.0].iter().for_each(|us| packet.extend(us.to_ne_bytes()));
        packet.resize(MOTORS_BYTES, 0);
        assert_eq!(motors(&packet), Some([0.0, 0.25, 0.5, 1.0]));
        assert_eq!(motors(&packet[..67]), None);
        packet[4..8].copy_from_slice(&f32::NAN.to_ne_bytes());
        assert_eq!(motors(&packet), None);
    }

    #[test]
    fn rates_are_set_in_tens_of_degrees_and_never_too_low() {
        let wanted = [618.0_f64, 120.0, 3000.0].map(f64::to_radians);
        let found = full_rates(wanted).map(f64::to_degrees).map(f64::round);
        assert_eq!(found, [620.0, 120.0, 1990.0]);
        let text = settings(wanted);
        assert!(text.contains("set roll_rc_rate = 62\nset roll_srate = 62\n") && text.contains("pitch_srate = 12\n"));
    }
}
