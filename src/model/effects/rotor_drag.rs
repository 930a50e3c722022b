//! Drag of the turning rotors: f_xy -= k s v_xy (blade flapping and induced drag).

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct RotorDrag;

impl Effect for RotorDrag {
    const CARD: Card = Card {
        id: "rotor_drag",
        name: "rotor drag",
        sentence: "the vehicle slows down even at low speed, more with more throttle",
        kind: EffectKind::Drag,
        parameters: &[EffectParameter { name: "k", unit: "1/s", low: 0.0, high: 1.5, typical: [0.05, 0.5] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::ThrustCommand, Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "horizontal specific force opposes the speed in proportion, times the throttle",
        rivals: &["steady_wind"],
        manoeuvre: ("passes from 2 to 20 m/s in every direction", &["forward", "backward", "left", "right"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let damping = k[0] * forces.throttle;
        for i in 0..2 {
            forces.force[i] = forces.force[i] - damping * forces.velocity[i];
        }
    }
}
