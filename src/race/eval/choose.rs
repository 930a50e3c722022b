//! Which of two policies is the better one, and which is good enough.

use super::Report;

/// Fixed-start lap completion from which a policy may be deployed (paper section 5.1).
pub const DEPLOYABLE: f64 = 0.95;

impl Report {
    /// Share of the fixed-start agents that completed a lap; 0 where they did not fly.
    pub fn completion(&self) -> f64 {
        self.fixed.as_ref().map_or(0.0, |fixed| fixed.lap_completion)
    }

    /// Larger for better policies, entry by entry: fixed-start lap completion (the paper's choice), then the median lap
    /// time, then gates passed, which tells policies apart that do not lap.
    pub fn rank(&self) -> [f64; 3] {
        let Some(fixed) = &self.fixed else { return [f64::NEG_INFINITY; 3] };
        let lap_time = fixed.lap_time_s.map_or(f64::INFINITY, |time| time.median);
        [fixed.lap_completion, -lap_time, fixed.gates_passed.mean]
    }
}

/// Place of the best of `reports`; of equals the last, which was trained longest. `None` of none.
pub fn best(reports: &[Report]) -> Option<usize> {
    let order = |a: &[f64; 3], b: &[f64; 3]| {
        let unequal = a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
        unequal.unwrap_or(std::cmp::Ordering::Equal)
    };
    let ranks = reports.iter().map(Report::rank).enumerate();
    ranks.max_by(|(_, a), (_, b)| order(a, b)).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::race::eval::score::{Benchmark, GatesPassed, LapTime};

    fn report(lap_completion: f64, median: Option<f64>, mean: f64) -> Report {
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
        Report { fixed: Some(fixed), random: None }
    }

    #[test]
    fn completion_decides_then_time_then_gates() {
        let none = report(0.0, None, 3.0);
        let further = report(0.0, None, 5.0);
        let slow = report(0.9, Some(9.0), 14.0);
        let fast = report(0.9, Some(8.0), 14.0);
        let sure = report(0.95, Some(10.0), 14.0);
        assert_eq!(best(&[none.clone(), further.clone(), none]), Some(1));
        assert_eq!(best(&[slow, fast.clone(), further]), Some(1));
        assert_eq!(best(&[fast, sure.clone(), sure]), Some(2));
        assert_eq!(best(&[]), None);
    }
}
