//! Turning about two axes pushes the third: w_x' += k w_y w_z, w_y' -= k w_z w_x, less what the rate loop holds.

use super::{Card, CommandSetpoint, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct GyroscopicCoupling;

impl Effect for GyroscopicCoupling {
    const CARD: Card = Card {
        id: "gyroscopic_coupling",
        name: "gyroscopic coupling",
        sentence: "a turn about two axes at once drags in the third",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "k", unit: "1", low: -1.0, high: 1.0, typical: [0.01, 0.05] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        signature: "the rate of one axis follows the product of the two others",
        rivals: &["rate_cross_coupling"],
        manoeuvre: ("yaw spins with roll and pitch at the same time", &["rate-steps", "yaw-spin", "circle"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn setpoint<R: Real>(k: &[R], setpoint: &mut CommandSetpoint<R>) {
        let [x, y, z] = setpoint.rates;
        let (tau, max) = (setpoint.tau, setpoint.max_rate);
        setpoint.command[0] = setpoint.command[0] + k[0] * y * z * tau[0] / max[0];
        setpoint.command[1] = setpoint.command[1] - k[0] * z * x * tau[1] / max[1];
    }
}
