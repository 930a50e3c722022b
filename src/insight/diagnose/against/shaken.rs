//! An accelerometer that is off by another push along the thrust may shake more or less: how a vibration goes with the
//! throttle is each vehicle's own.

use super::change::Change;
use crate::insight::diagnose::judgement::constant::shaking;
use crate::insight::diagnose::judgement::finding::Status;
use crate::model::effects::{self, Card, Role};

/// Makes such a difference a set with the vibration.
pub fn tell(changes: &mut [Change]) {
    let constant = |c: &Change| effects::card(c.cause).filter(|card| card.role == Role::ConstantError);
    for change in changes.iter_mut().filter(|c| c.status != Status::Suspected) {
        let Some(card) = constant(change) else { continue };
        let off = ["x", "y", "z"].map(|axis| change.difference.get(axis).map_or(0.0, |v| v.value));
        let new = |shakes: &&Card| !change.members.contains(&shakes.id);
        let shakes: Vec<&str> = shaking(card, off).filter(new).map(|shakes| shakes.id).collect();
        change.or(shakes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::judgement::finding::Value;
    use crate::model::effects::Quantity;

    #[test]
    fn only_an_accelerometer_along_the_thrust_may_shake() {
        let constant = |of: Quantity| {
            effects::acting(Role::ConstantError).find(|card| card.writes.contains(&of)).expect("a constant error")
        };
        let members = |of: Quantity, off: [f64; 3]| {
            let mut change = Change::sample(constant(of).id, 0.0, "m/s2");
            change.difference = ["x", "y", "z"]
                .into_iter()
                .zip(off)
                .map(|(axis, off)| (axis.to_string(), Value::measured(off, 0.01, "m/s2")))
                .collect();
            tell(std::slice::from_mut(&mut change));
            assert_eq!(change.members.len() > 1, change.status == Status::NamedSet);
            change.members.len()
        };
        assert_eq!(members(Quantity::Accelerometer, [0.02, 0.01, 0.3]), 2);
        assert_eq!(members(Quantity::Accelerometer, [0.2, 0.01, 0.3]), 1, "across");
        assert_eq!(members(Quantity::Gyro, [0.0, 0.0, 0.3]), 1, "a gyro");
    }
}
