//! Thrust lost to air that comes from above: the rotors' angle of attack falls with v_z (momentum and blade-element theory).

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "axial_inflow",
        name: "axial inflow",
        sentence: "in a climb the rotors push less, in a descent more, the faster they turn",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "k", unit: "1/s", low: 0.0, high: 4.0, typical: [0.1, 1.7] }],
        channels: &[Channel::Force],
        signature: "vertical specific force falls with throttle times vertical speed",
        rivals: &["vertical_drag", "propwash", "body_lift"],
        manoeuvre: ("climbs and descents at different throttle", &["climb", "descent", "dive", "punch"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        flow.lift = flow.lift - k[0] * flow.throttle * flow.velocity[2];
    }
}
