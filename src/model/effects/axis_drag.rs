//! Drag of each body axis by itself, f_i = -k_i |v| v_i (k_i in 1/m), in the place of the ellipsoid's, which is along
//! the flow: flow that comes askew pushes to the side as well. It is the quadratic drag with a diagonal matrix that
//! most simulators have; `share` says how far the vehicle is from the one toward the other, at the same k_i.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::{Real, build};
use crate::model::attitude::dot;

pub struct AxisDrag;

impl Effect for AxisDrag {
    const CARD: Card = Card {
        id: "axis_drag",
        name: "drag of each axis by itself",
        sentence: "air that comes askew pushes the vehicle to its slippery side as well as back",
        kind: EffectKind::Drag,
        // Up to 1.5 the air takes energy wherever the largest k_i is at most 30 times the smallest.
        parameters: &[EffectParameter { name: "share", unit: "1", low: 0.0, high: 1.5, typical: [0.3, 1.0] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "specific force across the flow, where the flow comes between the axes",
        rivals: &["body_lift", "axial_inflow", "vertical_drag"],
        manoeuvre: (
            "fast passes in every direction, dives and climbs at speed",
            &["forward", "backward", "left", "right", "dive"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let v = forces.velocity;
        let speed = dot(v, v).sqrt();
        forces.force = build!(|i| (k[0] * (forces.damping - forces.drag[i] * speed)).mul_add(v[i], forces.force[i]));
    }
}
