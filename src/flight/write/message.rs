//! The canonical messages, field by field. Numbers that racer has not are written as each message defines it.

use super::cdr::Cdr;
use crate::flight::MOTORS;

/// Reference frames in headers.
pub const WORLD: &str = "world";
pub const BODY: &str = "base_link";

/// Leads a covariance whose quantity was not measured.
const UNMEASURED: f64 = -1.0;

/// `mavros_msgs/msg/AttitudeTarget`: body rates (rad/s) and thrust (0..1).
pub fn attitude_target(cdr: &mut Cdr, [roll, pitch, yaw, thrust]: [f64; 4]) {
    const IGNORE_ATTITUDE: u8 = 128;
    let ignored = [(roll, 1), (pitch, 2), (yaw, 4), (thrust, 64)];
    cdr.u8(ignored.into_iter().filter(|(number, _)| number.is_nan()).map(|(_, bit)| bit).sum::<u8>() | IGNORE_ATTITUDE);
    level(cdr);
    cdr.f64s(&[roll, pitch, yaw]);
    cdr.f32(thrust);
}

/// `sensor_msgs/msg/Imu`: body rates (rad/s) and specific force (m/s2).
pub fn imu(cdr: &mut Cdr, row: [f64; 6]) {
    level(cdr);
    covariance::<9>(cdr, &[f64::NAN]);
    for vector in row.chunks(3) {
        cdr.f64s(vector);
        covariance::<9>(cdr, vector);
    }
}

/// `nav_msgs/msg/Odometry`: position (m), attitude (w x y z), velocity in the body frame (m/s).
pub fn odometry(cdr: &mut Cdr, [px, py, pz, w, x, y, z, vx, vy, vz]: [f64; 10]) {
    cdr.text(BODY);
    cdr.f64s(&[px, py, pz, x, y, z, w]);
    covariance::<36>(cdr, &[px, py, pz, w]);
    cdr.f64s(&[vx, vy, vz, f64::NAN, f64::NAN, f64::NAN]);
    covariance::<36>(cdr, &[vx, vy, vz]);
}

/// `sensor_msgs/msg/BatteryState`: voltage (V) and current (A).
pub fn battery_state(cdr: &mut Cdr, [voltage, current]: [f64; 2]) {
    const DISCHARGING: u8 = 2;
    const HEALTH_UNKNOWN: u8 = 0;
    const LIPO: u8 = 3;
    let [temperature, charge, capacity, design_capacity, percentage] = [f64::NAN; 5];
    for number in [voltage, temperature, current, charge, capacity, design_capacity, percentage] {
        cdr.f32(number);
    }
    for number in [DISCHARGING, HEALTH_UNKNOWN, LIPO, true.into()] {
        cdr.u8(number);
    }
    // Voltages and temperatures of cells.
    cdr.length(0);
    cdr.length(0);
    // Location and serial number.
    cdr.text("");
    cdr.text("");
}

/// `sensor_msgs/msg/JointState`: speeds of so many rotors (rad/s).
pub fn joint_state(rotors: usize) -> impl Fn(&mut Cdr, [f64; MOTORS]) {
    move |cdr, speeds| {
        cdr.length(rotors);
        for rotor in 0..rotors {
            cdr.text(&format!("rotor_{rotor}"));
        }
        // Angles.
        cdr.length(0);
        cdr.length(rotors);
        cdr.f64s(&speeds[..rotors]);
        // Torques.
        cdr.length(0);
    }
}

/// `actuator_msgs/msg/Actuators`: what so many motors were sent, of the full command (0..1).
pub fn actuators(motors: usize) -> impl Fn(&mut Cdr, [f64; MOTORS]) {
    move |cdr, commands| {
        // Positions and speeds.
        cdr.length(0);
        cdr.length(0);
        cdr.length(motors);
        cdr.f64s(&commands[..motors]);
    }
}

/// `mavros_msgs/msg/State`: whether it is armed.
pub fn state(cdr: &mut Cdr, [armed]: [f64; 1]) {
    const STANDBY: u8 = 3;
    const ACTIVE: u8 = 4;
    let armed = armed != 0.0;
    // Connected, armed, guided, manual input.
    for flag in [true, armed, false, false] {
        cdr.u8(flag.into());
    }
    // Mode.
    cdr.text("");
    cdr.u8(if armed { ACTIVE } else { STANDBY });
}

/// `mavros_msgs/msg/ExtendedState`: whether it is in the air.
pub fn extended_state(cdr: &mut Cdr, [in_air]: [f64; 1]) {
    const VTOL_UNDEFINED: u8 = 0;
    const ON_GROUND: u8 = 1;
    const IN_AIR: u8 = 2;
    cdr.u8(VTOL_UNDEFINED);
    cdr.u8(if in_air != 0.0 { IN_AIR } else { ON_GROUND });
}

/// No rotation.
fn level(cdr: &mut Cdr) {
    cdr.f64s(&[0.0, 0.0, 0.0, 1.0]);
}

/// Unknown, or that of a quantity that was not measured.
fn covariance<const N: usize>(cdr: &mut Cdr, of: &[f64]) {
    let mut covariance = [0.0; N];
    if of.iter().all(|number| number.is_nan()) {
        covariance[0] = UNMEASURED;
    }
    cdr.f64s(&covariance);
}
