//! The canonical messages, field by field. Numbers that racer has not are written as each message defines it.

use super::cdr::Cdr;

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

/// `sensor_msgs/msg/JointState`: rotor speeds (rad/s).
pub fn joint_state(cdr: &mut Cdr, speeds: [f64; 4]) {
    cdr.length(speeds.len());
    for rotor in 0..speeds.len() {
        cdr.text(&format!("rotor_{rotor}"));
    }
    // Angles.
    cdr.length(0);
    cdr.length(speeds.len());
    cdr.f64s(&speeds);
    // Torques.
    cdr.length(0);
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
