//! A clock that runs fast or slow: t becomes (1 + skew) t.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role};

pub struct ClockSkew;

impl Effect for ClockSkew {
    const CARD: Card = Card {
        id: "clock_skew",
        name: "clock skew",
        sentence: "one recorder's clock drifts away from the other's over the flight",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "skew", unit: "1", low: -0.03, high: 0.03, typical: [1e-4, 0.016] }],
        together: &["rate_delay", "response_voltage"],
        writes: &[Quantity::RateCommand, Quantity::ThrustCommand, Quantity::Integrated],
        channels: &[ResidualChannel::Rate, ResidualChannel::Turn],
        role: Role::ClockFast,
        signature: "the shift between gyro and attitude grows over the log",
        rivals: &["stream_offset", "gyro_scale", "response_voltage"],
        manoeuvre: (
            "the same fast doublets early and late in a long log",
            &["roll-doublets", "pitch-doublets", "yaw-doublets"],
        ),
        ..Card::BLANK
    };
}
