//! Settings over their seeds: median and quartiles of curves.

use super::curves::{At, Curve, Curves, Over, POINTS, interpolated};
use crate::base::stats;

/// Median and quartiles over the runs of a setting.
#[derive(Clone, Debug)]
pub struct Band {
    pub setting: usize,
    pub runs: usize,
    /// x, and lower quartile, median and upper quartile there.
    pub points: Vec<(f64, [f64; 3])>,
    /// Where the median run first passes each section, and the median there; none where that one never does.
    pub sections: Vec<Option<(f64, f64)>>,
}

/// The band of a setting over what all its runs have; `of` says which of a run's curves. `None` without a finished run.
pub fn band(curves: &Curves, setting: usize, over: Over, of: fn(&Curve) -> &[At]) -> Option<Band> {
    let runs: Vec<&Curve> = curves.runs.iter().filter(|c| c.setting == setting && !of(c).is_empty()).collect();
    let ends = |end: fn(&[At]) -> Option<&At>| runs.iter().filter_map(move |run| end(of(run)).map(|at| over.x(at)));
    let (first, last) = (ends(|c| c.first()).reduce(f64::max)?, ends(|c| c.last()).reduce(f64::min)?);
    let quartiles = |x: f64| {
        let values: Vec<f64> = runs.iter().map(|run| interpolated(of(run), over, x)).collect();
        [0.25, 0.5, 0.75].map(|q| stats::quantile(&values, q))
    };
    let x = |i: usize| first + (last - first) * i as f64 / (POINTS - 1) as f64;
    let points = (0..POINTS).map(|i| (x(i), quartiles(x(i)))).collect();
    let section = |i: usize| {
        // Runs that never pass it do so later than all others.
        let never = f64::INFINITY;
        let passed: Vec<f64> = runs.iter().map(|run| run.sections[i].map_or(never, |at| over.x(&at))).collect();
        let x = stats::median(&passed);
        (x.is_finite() && x <= last).then(|| (x, quartiles(x)[1]))
    };
    let sections = runs.first().map_or(0, |run| run.sections.len());
    Some(Band { setting, runs: runs.len(), points, sections: (0..sections).map(section).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    fn curve(values: &[(f64, f64)]) -> Curve {
        let learning: Vec<At> = values.iter().map(|&(x, value)| At { minutes: x, million_steps: x, value }).collect();
        let best = learning[0];
        Curve {
            run: 0,
            setting: 0,
            completion: Vec::new(),
            best,
            best_completion: 0.0,
            sections: vec![Some(best)],
            learning,
        }
    }

    #[test]
    fn bands_are_quartiles_where_all_runs_are() {
        let runs =
            vec![curve(&[(0.0, 0.0), (2.0, 2.0)]), curve(&[(0.0, 4.0), (4.0, 4.0)]), curve(&[(0.0, 9.0), (3.0, 9.0)])];
        let curves = Curves { what: "", runs };
        let band = band(&curves, 0, Over::Minutes, |c| &c.learning).unwrap();
        let (x, [low, median, high]) = *band.points.last().unwrap();
        assert!(
            (x - 2.0).abs() < 1e-9
                && (low - 3.0).abs() < 1e-9
                && (median - 4.0).abs() < 1e-9
                && (high - 6.5).abs() < 1e-9
        );
        assert_eq!(band.sections, [Some((0.0, 4.0))]);
        assert!(super::band(&curves, 1, Over::Minutes, |c| &c.learning).is_none());
    }
}
