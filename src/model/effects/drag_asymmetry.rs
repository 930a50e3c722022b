//! Drag that differs between forward and backward: f_x -= k |v_x| (|v_x| + flow (|v| - |v_x|)). At `flow` = 0 the nose
//! is braked by the speed along it alone, at 1 by that of the whole flow, as the compact model's drag is.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;
use crate::model::attitude::dot;

pub struct DragAsymmetry;

impl Effect for DragAsymmetry {
    const CARD: Card = Card {
        id: "drag_asymmetry",
        name: "different drag forward and backward",
        sentence: "at the same lean the vehicle is faster in one direction than in the other",
        kind: EffectKind::Drag,
        parameters: &[
            EffectParameter { name: "k", unit: "1/m", low: -0.02, high: 0.02, typical: [0.001, 0.008] },
            EffectParameter { name: "flow", unit: "1", low: 0.0, high: 1.5, typical: [0.3, 1.0] },
        ],
        forms: &[1],
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
        let v = forces.velocity;
        let nose = v[0].abs();
        let flow = k[1].mul_add(dot(v, v).sqrt() - nose, nose);
        forces.force[0] = forces.force[0] - k[0] * nose * flow;
    }
}
