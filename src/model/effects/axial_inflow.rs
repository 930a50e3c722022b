//! Thrust lost to air that comes from above: f_T -= (k s + across v_h) v_z, never less than none. The rotors' angle of
//! attack falls with v_z, and the faster the flow across them, the less induced flow gives way to it (momentum and
//! blade-element theory).

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct AxialInflow;

impl Effect for AxialInflow {
    const CARD: Card = Card {
        id: "axial_inflow",
        name: "axial inflow",
        sentence: "in a climb the rotors push less, in a descent more, the faster they turn",
        kind: EffectKind::Thrust,
        parameters: &[
            EffectParameter { name: "k", unit: "1/s", low: 0.0, high: 4.0, typical: [0.1, 1.7] },
            EffectParameter { name: "across", unit: "1/m", low: -0.1, high: 0.2, typical: [0.01, 0.06] },
        ],
        forms: &[1],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::ThrustCommand, Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force falls with throttle times vertical speed",
        rivals: &["vertical_drag", "propwash", "body_lift"],
        manoeuvre: ("climbs and descents at different throttle", &["climb", "descent", "dive", "punch"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let [x, y, z] = forces.velocity;
        let across = x.mul_add(x, y * y).sqrt();
        let slope = k[0].mul_add(forces.throttle, k[1] * across).max(R::zero());
        forces.specific_thrust = forces.specific_thrust - slope * z;
    }
}
