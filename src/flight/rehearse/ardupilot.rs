//! What ArduPilot's simulator build of its copter is sent and sends, over UDP on this machine.
//!
//! Read in its source (ArduCopter 4.7.0-dev, `SIM_JSON`): started with `--model JSON`, it sends a packet of servo
//! outputs, waits for a line of JSON that says how the vehicle is then and what time it is, and goes on to that time.
//! So it keeps racer's time without being given a clock. The line can carry a receiver's channels, but those are read
//! 50 times a second; sticks go as MAVLink's RC_CHANNELS_OVERRIDE therefore ([`link`]), a hundred times.
//!
//! They are those of a pilot in ACRO with its rate loop alone: its guided modes take body rates, too, but hold an
//! attitude by them, and leave the rates out where that is missed by more than 60 degrees.

pub mod gains;
pub mod link;
pub mod parameters;
pub mod process;
pub mod wire;

use super::sticks::Sticks;
use crate::flight::instruments::Actual;

/// What a packet of 16 outputs begins with; one of 32 begins with another number.
const MAGIC: [u16; 2] = [18458, 29569];
/// Number, rate, and count of the frame stand before the outputs.
const HEADER: usize = 2 + 2 + 4;
/// More than the longest packet.
pub const SERVO_BYTES: usize = HEADER + 2 * 32 + 1;

/// Where the outputs 1 to 4 of its frame X are in an airframe's order: it begins front right, goes on rear left, front
/// left, and ends rear right.
const OUTPUTS: [usize; 4] = [3, 0, 1, 2];

/// Which frame it is, and what each motor is sent, 0..1, in the order of
/// [`Airframe`](super::airframe::Airframe); none where `bytes` are no packet of the firmware's.
pub fn motors(bytes: &[u8]) -> Option<(u32, [f64; 4])> {
    let word = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
    let channels = (bytes.len().checked_sub(HEADER)?) / 2;
    let known = bytes.len() == HEADER + 2 * channels && [16, 32].contains(&channels);
    if !known || word(0) != MAGIC[channels / 32] {
        return None;
    }
    let frame = u32::from(word(4)) | u32::from(word(6)) << 16;
    // An output that is off says 0 us.
    Some((frame, OUTPUTS.map(|i| (1e-3 * (f64::from(word(HEADER + 2 * i)) - 1000.0)).clamp(0.0, 1.0))))
}

/// The line that says how the vehicle is at the firmware's `time_s`; `imu` is what was measured of its body rates
/// (rad/s) and specific force (m/s2).
pub fn state(time_s: f64, now: &Actual, imu: &[f64; 6]) -> String {
    // From ENU and FLU to NED and FRD: a half turn about the world's north-east diagonal, and one about the body's x.
    let world = |[east, north, up]: [f64; 3]| list([north, east, -up]);
    let body = |[x, y, z]: [f64; 3]| list([x, -y, -z]);
    let [w, x, y, z] = now.attitude;
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let attitude = list([w + z, x + y, x - y, w - z].map(|part| part * half));
    let [p, q, r, ax, ay, az] = *imu;
    let imu = format!("{{\"gyro\":{},\"accel_body\":{}}}", body([p, q, r]), body([ax, ay, az]));
    let [position, velocity] = [now.position, now.velocity].map(world);
    let battery = format!("{{\"voltage\":{:.4},\"current\":0}}", now.voltage);
    format!(
        "\n{{\"timestamp\":{time_s:.9},\"imu\":{imu},\"position\":{position},\"quaternion\":{attitude},\
         \"velocity\":{velocity},\"battery\":{battery},\"no_time_sync\":1}}\n"
    )
}

/// What it reads knows no exponents and nothing that is no number.
fn list<const N: usize>(numbers: [f64; N]) -> String {
    let shown = numbers.map(|x| format!("{:.9}", if x.is_finite() { x } else { 0.0 }));
    format!("[{}]", shown.join(","))
}

/// Pulses of the channels 1 to 8, us: roll, pitch, throttle, yaw, nothing, the switch that arms, and nothing.
pub fn channels(held: &Sticks) -> [u16; 8] {
    let pulse = |share: f64| (1500.0 + 500.0 * share.clamp(-1.0, 1.0)).round() as u16;
    let [roll, pitch, yaw] = held.rates;
    let throttle = held.throttle.map_or(1000, |open| pulse(2.0 * open - 1.0));
    let switch = if held.armed { 2000 } else { 1000 };
    // Nose down and yaw left are below the middle here.
    [pulse(roll), pulse(-pitch), throttle, pulse(-yaw), 1000, switch, 1000, 1000]
}

/// Full rates that it is set to, rad/s. Its sticks for roll and pitch have one rate, and their deflections together
/// count as one at most: either can be as wanted while the other is, too.
pub fn full_rates([roll, pitch, yaw]: [f64; 3]) -> [f64; 3] {
    let whole = |rate: f64| (rate.to_degrees() - 1e-9).ceil().clamp(1.0, 2000.0).to_radians();
    let tilt = whole(std::f64::consts::SQRT_2 * roll.max(pitch));
    [tilt, tilt, whole(yaw)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::attitude::body_axes;

    fn packet(magic: u16, channels: usize, frame: u32, outputs: [u16; 4]) -> Vec<u8> {
        let mut out = [magic.to_le_bytes(), 1000_u16.to_le_bytes()].concat();
        out.extend(frame.to_le_bytes());
        outputs.iter().for_each(|us| out.extend(us.to_le_bytes()));
        out.resize(HEADER + 2 * channels, 0);
        out
    }

    #[test]
    fn motors_are_turned_from_its_order_into_the_airframes() {
        // Front right, rear left, front left, rear right; the airframe's are rear right, front right, rear left, front
        // left.
        let sent = [1100, 1200, 1300, 1400];
        let expected = [0.4, 0.1, 0.2, 0.3];
        for (magic, channels) in [(18458, 16), (29569, 32)] {
            let (frame, shares) = motors(&packet(magic, channels, 70_000, sent)).unwrap();
            assert_eq!(frame, 70_000);
            assert!((0..4).all(|i| (shares[i] - expected[i]).abs() < 1e-12), "{shares:?}");
        }
        assert_eq!(motors(&packet(18458, 16, 0, [0, 990, 2000, 2010])).unwrap().1, [1.0, 0.0, 0.0, 1.0]);
        for wrong in [packet(18458, 32, 1, sent), packet(29569, 16, 1, sent), packet(18458, 15, 1, sent), vec![1; 7]] {
            assert_eq!(motors(&wrong), None);
        }
    }

    #[test]
    fn the_line_has_the_vehicle_in_its_frames() {
        let attitude = [0.8, 0.2, -0.4, 0.4];
        let actual = Actual {
            position: [1.0, 2.0, 3.0],
            velocity: [4.0, 5.0, -6.0],
            attitude,
            body_rates: [0.0; 3],
            specific_force: [0.0; 3],
            voltage: 16.0,
        };
        let line = state(1.25, &actual, &[0.1, 0.2, 0.3, 7.0, 8.0, f64::NAN]);
        assert!(line.starts_with('\n') && line.ends_with('\n'));
        let read: serde_json::Value = serde_json::from_str(line.trim()).unwrap();
        let numbers = |value: &serde_json::Value| -> Vec<f64> {
            value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        assert_eq!(read["timestamp"], 1.25);
        assert_eq!(numbers(&read["imu"]["gyro"]), [0.1, -0.2, -0.3]);
        assert_eq!(numbers(&read["imu"]["accel_body"]), [7.0, -8.0, 0.0]);
        assert_eq!(numbers(&read["position"]), [2.0, 1.0, -3.0]);
        assert_eq!(numbers(&read["velocity"]), [5.0, 4.0, 6.0]);
        assert_eq!(read["battery"]["voltage"], 16.0);
        // The nose points to the same place in both, and so does the right wing.
        let turned: [f64; 4] = numbers(&read["quaternion"]).try_into().unwrap();
        let (ours, theirs) = (body_axes(attitude), body_axes(turned));
        let near = |a: [f64; 3], [x, y, z]: [f64; 3]| (0..3).all(|i| (a[i] - [y, x, -z][i]).abs() < 1e-6);
        assert!(near(theirs[0], ours[0]) && near(theirs[1], ours[1].map(|x| -x)), "{theirs:?} {ours:?}");
    }

    #[test]
    fn sticks_are_its_pulses_and_full_rates_are_never_too_low() {
        let flying = Sticks { rates: [1.0, 0.5, 0.25], throttle: Some(0.25), armed: true };
        assert_eq!(channels(&flying)[..6], [2000, 1250, 1250, 1375, 1000, 2000]);
        assert_eq!(channels(&Sticks::default())[..6], [1500, 1500, 1000, 1500, 1000, 1000]);
        let found = full_rates([618.0_f64, 300.0, 119.5].map(f64::to_radians)).map(|x| x.to_degrees().round());
        assert_eq!(found, [874.0, 874.0, 120.0]);
    }
}
