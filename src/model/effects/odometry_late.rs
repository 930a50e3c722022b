//! Odometry stamped late: attitude and velocity at t are those of t - d. A check of the log takes off the most of it;
//! every fit allows for the rest.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role};

pub struct OdometryLate;

impl Effect for OdometryLate {
    const CARD: Card = Card {
        id: "odometry_late",
        name: "odometry stamped late",
        sentence: "in the log attitude and velocity come some milliseconds after the turns that they tell of",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "delay", unit: "s", low: -0.02, high: 0.02, typical: [0.002, 0.01] }],
        writes: &[Quantity::Integrated],
        channels: &[ResidualChannel::Turn, ResidualChannel::Push],
        role: Role::OdometryLate,
        signature: "attitude and velocity are shifted against gyro and accelerometer alike",
        rivals: &["stream_offset", "velocity_lag"],
        manoeuvre: ("fast stick doublets on every axis", &["roll-doublets", "pitch-doublets", "yaw-doublets"]),
        ..Card::BLANK
    };
}
