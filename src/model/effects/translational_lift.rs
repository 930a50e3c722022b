//! Thrust gained from fresh wind: f_T += k v_h^2 (momentum theory), and by how much more forward than sideways:
//! f_T += forward (v_x^2 - v_y^2).

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct TranslationalLift;

impl Effect for TranslationalLift {
    const CARD: Card = Card {
        id: "translational_lift",
        name: "translational lift",
        sentence: "in fast level flight the vehicle carries itself on less throttle",
        kind: EffectKind::Thrust,
        parameters: &[
            EffectParameter { name: "k", unit: "1/m", low: 0.0, high: 0.08, typical: [0.003, 0.03] },
            EffectParameter { name: "forward", unit: "1/m", low: -0.08, high: 0.08, typical: [0.003, 0.03] },
        ],
        forms: &[1],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force grows with the square of the speed across the rotors",
        rivals: &["body_lift", "axial_inflow"],
        manoeuvre: ("level passes from slow to fast", &["forward", "backward", "left", "right"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let [x, y, _] = forces.velocity;
        let [forward, sideways] = [x * x, y * y];
        let lift = k[0].mul_add(forward + sideways, k[1] * (forward - sideways));
        forces.specific_thrust = forces.specific_thrust + lift;
    }
}
