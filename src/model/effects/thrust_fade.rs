//! Thrust that fades over a flight as the motors warm: f_T is scaled by 1 - k t / 300 s.

use super::{AerodynamicForces, Card, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct ThrustFade;

/// Time of flight that the parameter speaks of, s.
const FULL_S: f64 = 300.0;

impl Effect for ThrustFade {
    const CARD: Card = Card {
        id: "thrust_fade",
        name: "fading thrust",
        sentence: "the same throttle lifts less at the end of a flight, whatever the voltage",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "k", unit: "1", low: 0.0, high: 0.25, typical: [0.02, 0.08] }],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        absorbed_by: &[CompactNumber::Thrust],
        signature: "vertical specific force falls in proportion to the time in the air",
        rivals: &["voltage_compensation"],
        manoeuvre: (
            "the same punches at the start and at the end, on two packs",
            &["punch", "throttle-steps", "climb"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        forces.specific_thrust = forces.specific_thrust * (R::one() - k[0] * forces.elapsed * R::of(1.0 / FULL_S));
    }
}
