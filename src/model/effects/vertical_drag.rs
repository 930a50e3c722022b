//! Drag along the thrust in proportion to the speed: f_z -= k v_z.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "vertical_drag",
        name: "vertical drag",
        sentence: "climbs and descents are braked, whatever the throttle",
        kind: Kind::Drag,
        parameters: &[Parameter { name: "k", unit: "1/s", low: 0.0, high: 0.9, typical: [0.05, 0.3] }],
        channels: &[Channel::Force],
        signature: "vertical specific force falls with vertical speed, at any throttle",
        rivals: &["axial_inflow", "body_lift"],
        manoeuvre: ("climbs and descents at different throttle", &["climb", "descent", "dive", "punch"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        flow.force[2] = flow.force[2] - k[0] * flow.velocity[2];
    }
}
