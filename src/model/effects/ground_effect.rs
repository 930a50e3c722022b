//! More thrust close to the ground: f_T is scaled by 1 + k (R / 4 h)^2 (Cheeseman and Bennett).

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct GroundEffect;

/// Radius of a rotor, and its height over the ground when the vehicle stands, m.
const RADIUS_M: f64 = 0.0635;
const ROTOR_M: f64 = 0.05;

impl Effect for GroundEffect {
    const CARD: Card = Card {
        id: "ground_effect",
        name: "ground effect",
        sentence: "close to the ground the vehicle floats on its own air",
        kind: EffectKind::Thrust,
        // 0.6 to 5 % at 0.25 m.
        parameters: &[EffectParameter { name: "k", unit: "1", low: 0.0, high: 90.0, typical: [2.0, 18.0] }],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        by_height: true,
        signature: "vertical specific force grows with thrust over height squared below half a metre",
        manoeuvre: ("hovering a hand above the ground, and landings", &["low-hover"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let ratio = R::of(0.25 * RADIUS_M) / (forces.height.max(R::zero()) + R::of(ROTOR_M));
        forces.specific_thrust = forces.specific_thrust * (k[0] * ratio).mul_add(ratio, R::one());
    }
}
