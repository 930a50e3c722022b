//! No attitude turns before its gyro does. Where the odometry's turns came first, its clock was moved to a gyro that is
//! late itself, and its velocity then seems to come late by as much.

use super::finding::{Finding, Status};
use crate::insight::criteria::rival::{SAME_DELAY_S, SAME_LAG_SHARE};
use crate::model::effects::{self, Role};

/// A lag of the velocity that is what the odometry was moved by, s, may be a late gyro.
pub fn may_be(moved: f64, findings: &mut [Finding]) {
    if moved <= SAME_DELAY_S.get() || findings.iter().any(|f| f.has(Role::GyroLate)) {
        return;
    }
    let same = |f: &Finding| f.parameters.values().any(|v| (v.value / moved - 1.0).abs() <= SAME_LAG_SHARE.get());
    for finding in findings.iter_mut().filter(|f| f.has(Role::VelocityLag) && f.status != Status::Suspected && same(f))
    {
        effects::acting(Role::GyroLate).for_each(|card| finding.or(card.id));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::judgement::finding::Value;

    #[test]
    fn a_velocity_as_late_as_the_odometry_was_early_may_be_a_late_gyro() {
        let of = |role: Role| effects::acting(role).next().expect("one");
        let members = |moved: f64, beside: Option<Role>| {
            let value = Value { value: 0.006, low: 0.005, high: 0.007, unit: "s".into() };
            let lag = of(Role::VelocityLag);
            let lag = Finding { parameters: [(lag.parameters[0].name.into(), value)].into(), ..Finding::of(lag) };
            let mut findings: Vec<Finding> =
                std::iter::once(lag).chain(beside.map(|role| Finding::of(of(role)))).collect();
            may_be(moved, &mut findings);
            findings[0].members.clone()
        };
        let [lag, gyro] = [Role::VelocityLag, Role::GyroLate].map(|role| of(role).id);
        assert_eq!(members(0.0068, None), [lag, gyro]);
        assert_eq!(members(-0.0068, None), [lag], "an odometry that comes after the gyro is what all are");
        assert_eq!(members(0.03, None), [lag], "of another size");
        assert_eq!(members(0.0068, Some(Role::GyroLate)), [lag], "the gyro has a name of its own");
    }
}
