//! The estimator's velocity is smoothed: tau v' + v = v_true.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, Role};

pub struct VelocityLag;

impl Effect for VelocityLag {
    const CARD: Card = Card {
        id: "velocity_lag",
        name: "lagging velocity estimate",
        sentence: "the velocity in the log is smoother and later than the flight was",
        kind: EffectKind::Sensor,
        parameters: &[EffectParameter { name: "tau", unit: "s", low: 0.0, high: 0.2, typical: [0.01, 0.08] }],
        writes: &[Quantity::Velocity],
        channels: &[ResidualChannel::Push],
        role: Role::VelocityLag,
        signature: "the change of velocity trails the integrated accelerometer after every punch",
        rivals: &["imu_misalignment"],
        manoeuvre: ("punches, cuts and reversals of direction", &["punch", "chop", "forward", "backward"]),
        ..Card::BLANK
    };
}
