//! The reward, term by term (paper section 4.4).

use crate::base::check::{Check, Invalid};
use crate::base::lane::Lane;
use serde::{Deserialize, Serialize};

/// Weights of the reward's terms. All are positive; the sign is in the term.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RewardConfig {
    /// Per metre that the distance to the target gate's centre shrinks.
    pub progress: f64,
    /// For each gate passed.
    pub gate: f64,
    /// Cost of a step: pressure on the lap time.
    pub time: f64,
    /// Cost of a step per metre below `altitude_m`.
    pub altitude: f64,
    /// Height below which the altitude cost grows, m.
    pub altitude_m: f64,
    /// Cost of running into the gate time-out.
    pub timeout: f64,
    /// Cost of a step of looking away from the target gate, times (1 - cos angle) exp(-distance / facing_m).
    pub facing: f64,
    /// Distance over which the facing term fades, m.
    pub facing_m: f64,
    /// lambda_da of Eq. 11: cost of the squared change of the squashed sampled action.
    pub action_change: f64,
}

impl Check for RewardConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, value) in [
            ("progress", self.progress),
            ("gate", self.gate),
            ("time", self.time),
            ("altitude", self.altitude),
            ("timeout", self.timeout),
            ("facing", self.facing),
            ("action_change", self.action_change),
        ] {
            Invalid::unless(
                value.is_finite() && value >= 0.0,
                key,
                value,
                "zero or more",
                "weights are costs or gains; the sign is in the term",
            )?;
        }
        for (key, value) in [("altitude_m", self.altitude_m), ("facing_m", self.facing_m)] {
            Invalid::unless(value.is_finite() && value > 0.0, key, value, "a length above 0 m", "")?;
        }
        Ok(())
    }
}

/// The one list of the reward's terms.
macro_rules! list {
    ($($name:ident),*) => {
        /// The reward's terms, signed and weighted; their sum is the reward.
        pub struct Terms<L> {
            $(pub $name: L),*
        }

        /// Names of the terms, in the order in which they are logged.
        pub const TERMS: [&str; [$(stringify!($name)),*].len()] = [$(stringify!($name)),*];

        impl<L> Terms<L> {
            /// In the order of [`TERMS`].
            #[inline(always)]
            pub fn in_order(self) -> [L; TERMS.len()] {
                [$(self.$name),*]
            }
        }
    };
}

list!(progress, gate, time, altitude, timeout, facing, action_change);

/// What one step brought, seen by the reward.
pub struct RewardInputs<L: Lane> {
    /// Distance to the target gate's centre before and after the step, m.
    pub distance: [L; 2],
    /// Lanes that passed their gate, and lanes that ran into the time-out.
    pub passed: L::Mask,
    pub timed_out: L::Mask,
    /// Height after the step, m.
    pub height: L,
    /// Cosine of the angle between the body's x axis and the way to the gate.
    pub facing: L,
    /// Squared change of the squashed sampled action.
    pub action_change: L,
}

/// The terms of one step.
#[inline(always)]
pub fn terms<L: Lane>(c: &RewardConfig, s: &RewardInputs<L>) -> Terms<L> {
    let zero = L::zero();
    let low = (L::of(c.altitude_m) - s.height).max(zero);
    let near = (s.distance[1] * L::of(-1.0 / c.facing_m)).exp();
    Terms {
        progress: (s.distance[0] - s.distance[1]) * L::of(c.progress),
        gate: L::select(s.passed, L::of(c.gate), zero),
        time: L::of(-c.time),
        altitude: low * L::of(-c.altitude),
        timeout: L::select(s.timed_out, L::of(-c.timeout), zero),
        facing: (L::one() - s.facing) * near * L::of(-c.facing),
        action_change: s.action_change * L::of(-c.action_change),
    }
}
