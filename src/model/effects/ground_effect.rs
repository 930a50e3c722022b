//! More thrust close to the ground: f_T is scaled by 1 + k (R / 4 H)^2 ((H + soft) / (h + soft))^2, h of the rotors, H
//! 0.3 m. With `soft` = 0 that is 1 + k (R / 4 h)^2 (Cheeseman and Bennett); with more it ends lower at the ground and
//! reaches higher, as an exponential does.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct GroundEffect;

/// Radius of a rotor, and its height over the ground when the vehicle stands, m.
const RADIUS_M: f64 = 0.0635;
const ROTOR_M: f64 = 0.05;
/// The rotors' height at which `k` is all of it whatever the form, m: a quarter of a metre under the vehicle.
const AT_M: f64 = 0.25 + ROTOR_M;

impl Effect for GroundEffect {
    const CARD: Card = Card {
        id: "ground_effect",
        name: "ground effect",
        sentence: "close to the ground the vehicle floats on its own air",
        kind: EffectKind::Thrust,
        // 0.6 to 5 % at 0.25 m.
        parameters: &[
            EffectParameter { name: "k", unit: "1", low: 0.0, high: 90.0, typical: [2.0, 18.0] },
            EffectParameter { name: "soft", unit: "m", low: 0.0, high: 0.8, typical: [0.05, 0.4] },
        ],
        forms: &[1],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force grows with thrust over height squared below half a metre",
        manoeuvre: ("hovering a hand above the ground, and landings", &["low-hover"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let near = (k[1] + R::of(AT_M)) / (forces.height.max(R::zero()) + R::of(ROTOR_M) + k[1]);
        let ratio = R::of(0.25 * RADIUS_M / AT_M) * near;
        forces.specific_thrust = forces.specific_thrust * (k[0] * ratio).mul_add(ratio, R::one());
    }
}
