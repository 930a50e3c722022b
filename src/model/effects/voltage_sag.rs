//! Voltage lost to the battery's inner resistance at once: V = V_oc - v s^2, v at full throttle.

use super::{Card, Cell, Channel, Effect, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "voltage_sag",
        name: "voltage sag",
        sentence: "the voltage drops the moment the throttle opens and is back when it closes",
        kind: Kind::Battery,
        parameters: &[Parameter { name: "v_full", unit: "V", low: 0.0, high: 8.0, typical: [0.8, 3.0] }],
        channels: &[Channel::Voltage],
        signature: "the voltage falls with the square of the throttle, at once",
        rivals: &["voltage_relaxation", "ocv_curve"],
        manoeuvre: ("punches with rest between them", &["punch", "chop", "throttle-steps"]),
        shown: None,
    };

    #[inline(always)]
    fn cell<R: Real>(k: &[R], cell: &mut Cell<R>) {
        cell.drop = k[0].mul_add(cell.load, cell.drop);
    }
}
