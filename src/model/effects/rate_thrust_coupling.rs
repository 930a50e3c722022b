//! Thrust lost in turns: f_T -= k (w_x^2 + w_y^2).

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct RateThrustCoupling;

impl Effect for RateThrustCoupling {
    const CARD: Card = Card {
        id: "rate_thrust_coupling",
        name: "thrust lost to body rates",
        sentence: "the vehicle drops a little in fast rolls and flips, the more the faster they are",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "k", unit: "m", low: 0.0, high: 0.05, typical: [0.002, 0.02] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::BodyRates],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force alone falls with the square of roll and pitch rate",
        rivals: &["mixer_thrust_loss", "imu_lever_arm"],
        manoeuvre: ("flips at steady rates and at one throttle", &["roll-flip", "pitch-flip"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let [x, y, _] = forces.rates;
        forces.specific_thrust = forces.specific_thrust - k[0] * x.mul_add(x, y * y);
    }
}
