//! Voltage lost to slow polarisation: V1' = (v s^2 - V1) / tau.

use super::{Card, Cell, Channel, Effect, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "voltage_relaxation",
        name: "slow recovery of the voltage",
        sentence: "after a long pull the voltage takes seconds to come back",
        kind: Kind::Battery,
        parameters: &[
            Parameter { name: "v_full", unit: "V", low: 0.0, high: 4.0, typical: [0.2, 1.5] },
            Parameter { name: "tau", unit: "s", low: 0.0, high: 90.0, typical: [1.0, 30.0] },
        ],
        channels: &[Channel::Voltage],
        signature: "the voltage follows the load of the past seconds and recovers slowly at rest",
        rivals: &["voltage_sag"],
        manoeuvre: ("a long pull, then rest", &["punch", "chop", "climb", "descent"]),
        shown: None,
    };

    #[inline(always)]
    fn cell<R: Real>(k: &[R], cell: &mut Cell<R>) {
        let follow = R::one() - (-(cell.dt / k[1].max(R::of(0.05)))).exp();
        cell.polarisation = follow.mul_add(k[0] * cell.load - cell.polarisation, cell.polarisation);
        cell.drop = cell.drop + cell.polarisation;
    }
}
