//! Drag along the thrust: f_z -= (1 +- climb) (k + square (|v_z| - 5 m/s) + across v_h) v_z, never less than none. At
//! `square` = 0 it goes with the speed, at `square` = k / (5 m/s) with its square, as a plate's, and below 0 it grows
//! less than the speed. With `across` the flow from the side counts as well. By the share `climb` it is more in climbs
//! and less in descents; at 1 only climbs are braked.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

/// The vertical speed at which `k` is all of the drag, m/s: between a climb and a dive.
const AT: f64 = 5.0;

pub struct VerticalDrag;

impl Effect for VerticalDrag {
    const CARD: Card = Card {
        id: "vertical_drag",
        name: "vertical drag",
        sentence: "climbs and descents are braked, whatever the throttle",
        kind: EffectKind::Drag,
        parameters: &[
            EffectParameter { name: "k", unit: "1/s", low: 0.0, high: 0.9, typical: [0.05, 0.3] },
            EffectParameter { name: "square", unit: "1/m", low: -0.1, high: 0.2, typical: [0.01, 0.06] },
            EffectParameter { name: "climb", unit: "1", low: -1.0, high: 1.0, typical: [0.2, 1.0] },
            EffectParameter { name: "across", unit: "1/m", low: -0.1, high: 0.2, typical: [0.01, 0.06] },
        ],
        forms: &[1, 2, 3],
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
        let [x, y, z] = forces.velocity;
        let across = x.mul_add(x, y * y).sqrt();
        let slope = k[1].mul_add(z.abs() - R::of(AT), k[3].mul_add(across, k[0])).max(R::zero());
        forces.force[2] = forces.force[2] - slope * k[2].mul_add(z.abs(), z);
    }
}
