//! The gyro is stamped late: a sample of time t carries the time t + offset.

use super::{
    Card, CompactNumber, Effect, EffectKind, EffectParameter, Evidence, Quantity, ResidualChannel, Role, Twin,
};

pub struct StreamOffset;

impl Effect for StreamOffset {
    const CARD: Card = Card {
        id: "stream_offset",
        name: "gyro stamped late",
        sentence: "in the log the gyro lags everything else by some milliseconds, though in flight it does not",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "offset", unit: "s", low: -0.05, high: 0.05, typical: [0.001, 0.015] }],
        together: &["rate_delay"],
        writes: &[Quantity::GyroTime],
        channels: &[ResidualChannel::Rate, ResidualChannel::Turn],
        role: Role::GyroLate,
        absorbed_by: &[CompactNumber::RollTime, CompactNumber::PitchTime, CompactNumber::YawTime],
        twin: Some(Twin { effect: "rate_delay", told_by: Evidence::OdometryClock }),
        negative: "the attitude is later than the gyro, as estimators are: the gyro need not be early",
        signature: "the gyro is shifted against the attitude, not only against the commands",
        rivals: &["rate_delay", "clock_skew"],
        manoeuvre: ("fast stick doublets on every axis", &["roll-doublets", "pitch-doublets", "yaw-doublets"]),
        ..Card::BLANK
    };
}
