//! A body that acts as a wing: f_z -= k v_h v_z, f_x += k v_z v_x.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "body_lift",
        name: "lift of the body",
        sentence: "at speed the body carries or pushes down like a plate, depending on how it meets the air",
        kind: Kind::Drag,
        parameters: &[Parameter { name: "k", unit: "1/m", low: 0.0, high: 0.08, typical: [0.003, 0.03] }],
        channels: &[Channel::Force],
        signature: "vertical specific force follows the product of the speeds across and along the rotors' axis",
        rivals: &["axial_inflow", "translational_lift", "vertical_drag", "drag_asymmetry"],
        manoeuvre: ("fast passes, knife edge and dives", &["forward", "backward", "left", "right", "dive"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let [x, y, z] = flow.velocity;
        let across = x.mul_add(x, y * y).sqrt();
        flow.force[2] = flow.force[2] - k[0] * across * z;
        flow.force[0] = flow.force[0] + k[0] * z * x;
    }
}
