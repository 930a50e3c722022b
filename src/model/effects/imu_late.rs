//! The whole IMU stamped late: gyro and accelerometer at t are those of t - d. Against the commands both are late by
//! the same time, and so is the odometry once its clock has been moved to theirs.

use super::{
    Card, CompactNumber, Effect, EffectKind, EffectParameter, Evidence, Quantity, ResidualChannel, Role, Twin,
};

pub struct ImuLate;

impl Effect for ImuLate {
    const CARD: Card = Card {
        id: "imu_late",
        name: "IMU stamped late",
        sentence: "in the log gyro and accelerometer lag everything else, though in flight they do not",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "delay", unit: "s", low: 0.0, high: 0.05, typical: [0.002, 0.015] }],
        writes: &[Quantity::RateCommand, Quantity::ThrustCommand],
        channels: &[ResidualChannel::Rate, ResidualChannel::Force],
        role: Role::ImuLate,
        absorbed_by: &[
            CompactNumber::RollTime,
            CompactNumber::PitchTime,
            CompactNumber::YawTime,
            CompactNumber::ThrustTime,
        ],
        twin: Some(Twin { effect: "link_delay", told_by: Evidence::OdometryClock }),
        signature: "rates and forces lag the commands by one time, and motors do not or the odometry was off by it",
        rivals: &["link_delay", "stream_offset", "rate_delay", "thrust_delay"],
        manoeuvre: ("fast stick doublets on every axis, and throttle steps", &["roll-doublets", "throttle-steps"]),
        ..Card::BLANK
    };
}
