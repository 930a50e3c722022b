//! A body that acts as a wing: f_z -= k v_h v_z, f_x += k v_z v_x.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct BodyLift;

impl Effect for BodyLift {
    const CARD: Card = Card {
        id: "body_lift",
        name: "lift of the body",
        sentence: "at speed the body carries or pushes down like a plate, depending on how it meets the air",
        kind: EffectKind::Drag,
        parameters: &[EffectParameter { name: "k", unit: "1/m", low: 0.0, high: 0.08, typical: [0.003, 0.03] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force follows the product of the speeds across and along the rotors' axis",
        rivals: &["axial_inflow", "translational_lift", "vertical_drag", "drag_asymmetry"],
        manoeuvre: ("fast passes, knife edge and dives", &["forward", "backward", "left", "right", "dive"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let [x, y, z] = forces.velocity;
        let across = x.mul_add(x, y * y).sqrt();
        forces.force[2] = forces.force[2] - k[0] * across * z;
        forces.force[0] = forces.force[0] + k[0] * z * x;
    }
}
