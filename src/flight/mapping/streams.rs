//! The rows of each stream in SI, front-left-up and east-north-up.

use super::source::{Open, Rows};
use super::{BatteryPart, ImuPart, MotorsPart, OdometryPart, RotorsPart, SetpointPart, VelocityFrame, frames};
use crate::flight::MOTORS;

pub fn setpoint(part: &SetpointPart, open: &Open) -> Rows<4> {
    let body = part.body.unwrap_or(open.sources.mapping.body);
    let rates = open.vector::<_, 3>("rate", &part.rate, false)?;
    let thrust = open.scalar("thrust", &part.thrust)?;
    let row = |(rate, thrust)| {
        let [roll, pitch, yaw] = body.to_flu(rate);
        [roll, pitch, yaw, thrust]
    };
    Ok(rates.into_iter().zip(thrust).map(row).collect())
}

pub fn imu(part: &ImuPart, open: &Open) -> Rows<6> {
    let body = part.body.unwrap_or(open.sources.mapping.body);
    let turned = |vector| frames::mounted(part.rotation_deg, body.to_flu(vector));
    let gyro = open.vector("gyro", &part.gyro, false)?;
    let force = open.vector("specific_force", &part.specific_force, false)?;
    let row = |(gyro, force)| {
        let ([p, q, r], [x, y, z]) = (turned(gyro), turned(force));
        [p, q, r, x, y, z]
    };
    Ok(gyro.into_iter().zip(force).map(row).collect())
}

pub fn odometry(part: &OdometryPart, open: &Open) -> Rows<10> {
    let body = part.body.unwrap_or(open.sources.mapping.body);
    let world = part.world.unwrap_or(open.sources.mapping.world);
    let positions = open.vector("position", &part.position, false)?;
    let attitudes = open.vector("attitude", &part.attitude, true)?;
    let velocities = open.vector("velocity", &part.velocity, false)?;
    let row = |((position, attitude), velocity)| {
        let [x, y, z] = world.to_enu(position);
        let q @ [qw, qx, qy, qz] = frames::attitude(attitude, body, world);
        let [u, v, w] = match part.velocity_frame {
            VelocityFrame::Body => body.to_flu(velocity),
            VelocityFrame::World => frames::into_body(q, world.to_enu(velocity)),
        };
        [x, y, z, qw, qx, qy, qz, u, v, w]
    };
    Ok(positions.into_iter().zip(attitudes).zip(velocities).map(row).collect())
}

pub fn battery(part: &BatteryPart, open: &Open) -> Rows<2> {
    let voltage = measured(open.scalar("voltage", &part.voltage)?);
    let current = measured(open.scalar("current", &part.current)?);
    Ok(voltage.into_iter().zip(current).map(|(voltage, current)| [voltage, current]).collect())
}

/// A flight controller without the sensor logs nothing but zeros.
fn measured(values: Vec<f64>) -> Vec<f64> {
    if values.iter().all(|&value| value == 0.0) { vec![f64::NAN; values.len()] } else { values }
}

pub fn rotors(part: &RotorsPart, open: &Open) -> Rows<MOTORS> {
    open.vector("speed", &part.speed, false)
}

pub fn motors(part: &MotorsPart, open: &Open) -> Rows<MOTORS> {
    open.vector("command", &part.command, false)
}
