//! A metric over the runs of a setting.

use super::metric::Metric;
use super::result::RunResult;
use crate::base::stats;
use serde::Serialize;

/// Confidence of every interval in a study.
pub const CONFIDENCE: f64 = 0.95;

/// Mean and spread over the runs that have the metric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeedSummary {
    /// Runs that have it.
    pub n: usize,
    pub mean: f64,
    /// None of a single run.
    pub sd: Option<f64>,
    pub min: f64,
    pub max: f64,
    /// 95 % interval of the mean (Student's t), shares kept within 0..1; none of a single run.
    pub interval: Option<[f64; 2]>,
}

impl SeedSummary {
    /// None where no run has it.
    pub fn of(metric: &Metric, runs: &[&RunResult]) -> Option<Self> {
        let x: Vec<f64> = runs.iter().filter_map(|run| metric.of(run)).collect();
        if x.is_empty() {
            return None;
        }
        let mean = stats::mean(&x);
        let possible = |x: f64| if metric.share { x.clamp(0.0, 1.0) } else { x };
        Some(Self {
            n: x.len(),
            mean,
            sd: stats::sd(&x),
            min: x.iter().copied().fold(f64::INFINITY, f64::min),
            max: x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            interval: stats::mean_half_width(&x, CONFIDENCE).map(|half| [mean - half, mean + half].map(possible)),
        })
    }
}
