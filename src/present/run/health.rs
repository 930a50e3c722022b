//! Whether a training is healthy: numbers of its log against bounds, and in words what is wrong beyond them.

use super::metrics::LogRow;
use crate::base::stats;
use serde::Serialize;

/// A number of the log, where it should be, and what it means where it is not.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bound {
    pub column: &'static str,
    pub name: &'static str,
    pub low: f64,
    pub high: f64,
    pub below: &'static str,
    pub above: &'static str,
}

/// The bounds, for means over the last part of a training. KL and clipping are those of Huang et al. (2022, "The 37
/// implementation details of PPO"), with room: they judge means of many updates. The others are where trainings of this
/// program stopped improving (RESULTS.md).
pub const BOUNDS: [Bound; 6] = [
    Bound {
        column: "ppo/action_std",
        name: "standard deviation of the action, before its tanh",
        low: 0.02,
        high: 3.0,
        below: "exploration has ended: nothing new is tried; raise ppo.entropy",
        above: "it runs away: most commands are full stick to either side; lower ppo.entropy, or set \
                ppo.entropy_squashed",
    },
    Bound {
        column: "ppo/action_magnitude",
        name: "mean |tanh(mean action)|\u{b2}, of at most 4",
        low: 1e-4,
        // About where a third of a lap's commands are at their limits.
        high: 2.0,
        below: "the policy does nothing: its commands hardly leave the middle of the stick",
        above: "much of the lap is flown at full stick: raise ppo.saturation, ppo.action_magnitude or \
                env.reward.action_change",
    },
    Bound {
        column: "ppo/approx_kl",
        name: "change of the policy in one update (KL)",
        low: 0.0,
        high: 0.1,
        below: "",
        above: "updates are too large for their data: lower ppo.learning_rate or ppo.epochs",
    },
    Bound {
        column: "ppo/clip_fraction",
        name: "share of clipped samples",
        low: 0.001,
        high: 0.5,
        below: "updates hardly change the policy: raise ppo.learning_rate",
        above: "most samples teach nothing: lower ppo.learning_rate or ppo.epochs",
    },
    Bound {
        column: "ppo/explained_variance",
        name: "share of the returns' variance that the critic explains",
        low: 0.5,
        high: 1.0,
        below: "the critic does not know what is coming: raise ppo.value_coefficient, or lower ppo.learning_rate",
        above: "",
    },
    Bound {
        column: "ppo/advantage_std",
        name: "standard deviation of the advantages, in reward",
        low: 1e-3,
        high: 1e3,
        below: "all actions are worth the same: check that the reward tells them apart",
        above: "a reward is out of proportion: check env.reward",
    },
];

/// A number judged.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct JudgedNumber {
    pub bound: Bound,
    /// None where the log has no such number.
    pub found: Option<f64>,
}

impl JudgedNumber {
    /// What is wrong with it, if anything.
    pub fn complaint(&self) -> Option<&'static str> {
        let Bound { low, high, below, above, .. } = self.bound;
        match self.found? {
            x if x < low => Some(below),
            x if x <= high => None,
            _ => Some(above),
        }
    }
}

/// Judges the last tenth of a log, whose rows have a number for each of [`BOUNDS`].
pub fn judge(rows: &[[Option<f64>; BOUNDS.len()]]) -> [JudgedNumber; BOUNDS.len()] {
    let last = &rows[rows.len() - rows.len().div_ceil(10).min(rows.len())..];
    std::array::from_fn(|i| {
        let values: Vec<f64> = last.iter().filter_map(|row| row[i]).collect();
        JudgedNumber { bound: BOUNDS[i], found: (!values.is_empty()).then(|| stats::mean(&values)) }
    })
}

/// Watches a training and warns of each number once.
#[derive(Debug, Default)]
pub struct Watched {
    rows: Vec<[Option<f64>; BOUNDS.len()]>,
    warned: [bool; BOUNDS.len()],
}

/// Updates that are judged together while training, and the share of the budget before which nothing is: a policy that
/// has not begun to learn is no ill one.
const TOGETHER: usize = 100;
const BEGIN: f64 = 0.2;

impl Watched {
    /// Takes in a row; what there is to warn of.
    pub fn after(&mut self, row: &LogRow, share: f64) -> Vec<String> {
        self.rows.push(BOUNDS.map(|bound| row.get(bound.column)));
        if self.rows.len() < TOGETHER {
            return Vec::new();
        }
        let rows = std::mem::take(&mut self.rows);
        let mut warnings = Vec::new();
        for (i, warned) in self.warned.iter_mut().enumerate().filter(|_| share >= BEGIN) {
            let values: Vec<f64> = rows.iter().filter_map(|row| row[i]).collect();
            let judged = JudgedNumber { bound: BOUNDS[i], found: (!values.is_empty()).then(|| stats::mean(&values)) };
            if let (Some(complaint), Some(found), false) = (judged.complaint(), judged.found, *warned) {
                *warned = true;
                let Bound { column, name, .. } = judged.bound;
                let million = row.steps as f64 / 1e6;
                warnings.push(format!(
                    "warning: after {million:.1} M steps {column} is {found:.3}, the {name}: {complaint}"
                ));
            }
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::SystemTime;

    const HEALTHY: [f64; BOUNDS.len()] = [0.5, 0.3, 0.01, 0.2, 0.9, 2.0];

    #[test]
    fn what_is_healthy_is_not_complained_about_and_what_is_not_is_told_once() {
        let all = |values: [f64; BOUNDS.len()]| judge(&[values.map(Some); 30]);
        assert!(all(HEALTHY).iter().all(|judged| judged.complaint().is_none()));
        let mut ill = HEALTHY;
        (ill[0], ill[4]) = (50.0, -0.1);
        let complaints: Vec<_> = all(ill).iter().filter_map(JudgedNumber::complaint).collect();
        assert!(complaints.len() == 2 && complaints[0].contains("runs away") && complaints[1].contains("critic"));
        assert!(judge(&[]).iter().all(|judged| judged.found.is_none()));

        let values: Vec<_> = BOUNDS.iter().zip(ill).map(|(bound, x)| (bound.column.to_string(), x)).collect();
        let row = LogRow { wall: SystemTime::UNIX_EPOCH, steps: 1, values };
        let mut watched = Watched::default();
        let early: usize = (0..TOGETHER).map(|_| watched.after(&row, 0.1).len()).sum();
        let late: Vec<String> = (0..3 * TOGETHER).flat_map(|_| watched.after(&row, 0.5)).collect();
        assert_eq!((early, late.len()), (0, 2));
        assert!(late[0].contains("ppo/action_std is 50.000"), "{late:?}");
    }
}
