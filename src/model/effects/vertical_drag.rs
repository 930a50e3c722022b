//! Drag along the thrust in proportion to the speed: f_z -= k v_z.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct VerticalDrag;

impl Effect for VerticalDrag {
    const CARD: Card = Card {
        id: "vertical_drag",
        name: "vertical drag",
        sentence: "climbs and descents are braked, whatever the throttle",
        kind: EffectKind::Drag,
        parameters: &[EffectParameter { name: "k", unit: "1/s", low: 0.0, high: 0.9, typical: [0.05, 0.3] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force falls with vertical speed, at any throttle",
        rivals: &["axial_inflow", "body_lift"],
        manoeuvre: ("climbs and descents at different throttle", &["climb", "descent", "dive", "punch"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        forces.force[2] = forces.force[2] - k[0] * forces.velocity[2];
    }
}
