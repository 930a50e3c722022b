//! Drag that differs between forward and backward: f_x -= k v_x^2.

use super::{Card, ResidualChannel, Effect, AerodynamicForces, EffectKind, EffectParameter};
use crate::base::lane::Real;

pub struct DragAsymmetry;

impl Effect for DragAsymmetry {
    const CARD: Card = Card {
        id: "drag_asymmetry",
        name: "different drag forward and backward",
        sentence: "at the same lean the vehicle is faster in one direction than in the other",
        kind: EffectKind::Drag,
        parameters: &[EffectParameter { name: "k", unit: "1/m", low: -0.02, high: 0.02, typical: [0.001, 0.008] }],
        channels: &[ResidualChannel::Force],
        signature: "forward specific force has a part that is the same for flight forward and backward",
        rivals: &["body_lift", "steady_wind"],
        manoeuvre: ("fast passes forward and backward", &["forward", "backward"]),
        shown: None,
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let x = forces.velocity[0];
        forces.force[0] = forces.force[0] - k[0] * x * x;
    }
}
