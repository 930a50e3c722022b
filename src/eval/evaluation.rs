//! The two benchmarks of a policy, and which of two policies is the better one.

use super::EvalConfig;
use super::fly::fly;
use super::score::{Benchmark, score};
use crate::env::Race;
use crate::env::reset::Place;
use crate::lane::Level;
use crate::nn::Network;
use crate::track::Track;
use serde::{Deserialize, Serialize};

/// Fixed-start lap completion from which a policy may be deployed (paper section 5.1).
pub const DEPLOYABLE: f64 = 0.95;

/// Where agents start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Starts {
    /// On the pad.
    Fixed,
    /// Along the track, as in training.
    Random,
    Both,
}

/// A policy's benchmarks, of those that were asked for.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Evaluation {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed: Option<Benchmark>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub random: Option<Benchmark>,
}

impl Evaluation {
    /// Flies `network` on `track` from `starts`; `race` is one as it is scored ([`Race::scored`]). Runs on the current rayon
    /// pool; the result does not depend on it.
    pub fn of(
        level: Level,
        race: &Race,
        track: &Track,
        network: &Network<f32>,
        starts: Starts,
        config: &EvalConfig,
    ) -> Self {
        let from = |place: Place, without: Starts| {
            let flights = || fly(level, race, network, place, config.agents, config.max_steps as u32);
            (starts != without).then(|| score(track, &flights()))
        };
        Self { fixed: from(Place::Pad, Starts::Random), random: from(Place::Spline, Starts::Fixed) }
    }

    /// Share of the fixed-start agents that completed a lap; 0 where they did not fly.
    pub fn completion(&self) -> f64 {
        self.fixed.as_ref().map_or(0.0, |fixed| fixed.lap_completion)
    }

    /// Larger for better policies, entry by entry: fixed-start lap completion (the paper's choice), then the median lap time,
    /// then gates passed, for policies that do not lap.
    pub fn rank(&self) -> [f64; 3] {
        let Some(fixed) = &self.fixed else { return [f64::NEG_INFINITY; 3] };
        let lap_time = fixed.lap_time_s.map_or(f64::INFINITY, |time| time.median);
        [fixed.lap_completion, -lap_time, fixed.gates_passed.mean]
    }
}

/// Place of the best of `evaluations`; of equals the last, which was trained longest. `None` of none.
pub fn best(evaluations: &[Evaluation]) -> Option<usize> {
    let order = |a: &[f64; 3], b: &[f64; 3]| {
        let unequal = a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
        unequal.unwrap_or(std::cmp::Ordering::Equal)
    };
    let ranks = evaluations.iter().map(Evaluation::rank).enumerate();
    ranks.max_by(|(_, a), (_, b)| order(a, b)).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::score::{GatesPassed, LapTime};

    fn evaluation(lap_completion: f64, median: Option<f64>, mean: f64) -> Evaluation {
        let fixed = Benchmark {
            agents: 100,
            lap_completion,
            lap_time_s: median.map(|median| LapTime { median, p05: median, p95: median, best: median }),
            gates_passed: GatesPassed { median: mean, mean },
            top_speed_m_s: 0.0,
            saturated_share: 0.0,
            mean_action_change_sq: 0.0,
            failures_by_gate: Default::default(),
            sections: Default::default(),
        };
        Evaluation { fixed: Some(fixed), random: None }
    }

    #[test]
    fn completion_decides_then_time_then_gates() {
        let none = evaluation(0.0, None, 3.0);
        let further = evaluation(0.0, None, 5.0);
        let slow = evaluation(0.9, Some(9.0), 14.0);
        let fast = evaluation(0.9, Some(8.0), 14.0);
        let sure = evaluation(0.95, Some(10.0), 14.0);
        assert_eq!(best(&[none.clone(), further.clone(), none.clone()]), Some(1));
        assert_eq!(best(&[slow, fast.clone(), further]), Some(1));
        assert_eq!(best(&[fast, sure.clone(), sure]), Some(2));
        assert_eq!(best(&[]), None);
    }
}
