//! Drag that differs between forward and backward: f_x -= k v_x^2.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct DragAsymmetry;

impl Effect for DragAsymmetry {
    const CARD: Card = Card {
        id: "drag_asymmetry",
        name: "different drag forward and backward",
        sentence: "at the same lean the vehicle is faster in one direction than in the other",
        kind: EffectKind::Drag,
        parameters: &[EffectParameter { name: "k", unit: "1/m", low: -0.02, high: 0.02, typical: [0.001, 0.008] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "forward specific force has a part that is the same for flight forward and backward",
        rivals: &["body_lift", "steady_wind"],
        manoeuvre: ("fast passes forward and backward", &["forward", "backward"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let x = forces.velocity[0];
        forces.force[0] = forces.force[0] - k[0] * x * x;
    }
}
