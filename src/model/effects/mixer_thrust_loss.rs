//! Thrust given up for turning: f_T is scaled by 1 - k times the sum of |command - response| over the axes.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct MixerThrustLoss;

impl Effect for MixerThrustLoss {
    const CARD: Card = Card {
        id: "mixer_thrust_loss",
        name: "thrust lost to the mixer",
        sentence: "the vehicle drops a little whenever it is jerked around",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "k", unit: "1", low: 0.0, high: 0.25, typical: [0.02, 0.1] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::RateError],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force dips while the rates are behind their commands",
        rivals: &["rate_thrust_coupling", "mixer_room"],
        manoeuvre: ("flips and sharp steps at one throttle", &["roll-flip", "pitch-flip", "rate-steps"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        forces.specific_thrust = forces.specific_thrust * (R::one() - k[0] * forces.rate_error);
    }
}
