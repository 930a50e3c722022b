//! Whether the clocks of commands and sensors run apart: the offset between simulated and measured rates, followed
//! through the flight. A fit would not find it, because after a minute the two have nothing in common any more.

use crate::base::stats::median;
use crate::insight::criteria::consistent::{CLOCK_BINS, CLOCK_CORRELATION, CLOCK_SKEW_MOST};
use crate::insight::diagnose::prediction::channels::RATE;
use crate::insight::diagnose::prediction::problem::{ChannelValues, Predictions, Problem};
use crate::insight::diagnose::prediction::record::BIN_S;

/// Length of the stretches that are compared, s.
const WINDOW_S: f64 = 6.0;

/// Skew of the sensors' clock, as a share, if the rates can tell; from the prediction `state` and what was measured
/// less it.
pub fn estimate(problem: &Problem, state: &Predictions, residual: &ChannelValues) -> Option<f64> {
    let (most, like_enough) = (CLOCK_SKEW_MOST.get(), CLOCK_CORRELATION.get());
    let mut slopes = Vec::new();
    for f in 0..state.len() {
        let rows = &problem.rows[RATE];
        let bins = problem.records[f].bins.len();
        if bins < CLOCK_BINS.count() || state[f].channels[RATE].is_empty() {
            continue;
        }
        // By axis and bin: predicted and measured.
        let mut series = [[vec![0.0; bins], vec![0.0; bins]], [vec![0.0; bins], vec![0.0; bins]]];
        for (axis, pair) in series.iter_mut().enumerate() {
            for (i, row) in rows.iter().enumerate().filter(|(_, row)| row.flight as usize == f) {
                let predicted = state[f].channels[RATE + axis][row.index as usize];
                pair[0][row.index as usize] = predicted;
                pair[1][row.index as usize] = predicted + residual[RATE + axis][i];
            }
        }
        let window = (WINDOW_S / BIN_S) as usize;
        let begin = problem.records[f].time[problem.records[f].bins[0][0]];
        let (mut skew, mut points): (f64, Vec<(f64, f64)>) = (0.0, Vec::new());
        let mut reach = most * (begin + 2.0 * WINDOW_S) / BIN_S;
        for from in (0..bins.saturating_sub(window)).step_by(window) {
            let time = problem.records[f].time[problem.records[f].bins[from + window / 2][0]];
            let expected = (skew * time / BIN_S) as i64;
            let range = expected - reach as i64..=expected + reach as i64;
            let like = |lag| alike(&series, from, window, lag);
            let best = range.map(|lag| (like(lag), lag)).max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((most, lag)) = best.filter(|(most, _)| *most > like_enough) {
                let between = summit(like(lag - 1), most, like(lag + 1));
                points.push((time, (lag as f64 + between) * BIN_S));
                let ratios: Vec<f64> = points.iter().filter(|p| p.0 > 0.3 * time).map(|p| p.1 / p.0).collect();
                skew = median(&ratios);
                // Known to a bin or two over the time so far; ahead lies one more window.
                reach = (4.0 + most * WINDOW_S / BIN_S * 0.3).min(most * WINDOW_S / BIN_S);
            }
        }
        // A delay shifts all windows alike: what grows is told by windows half a flight apart.
        let half = points.len() / 2;
        let grown = |(a, b): (&(f64, f64), &(f64, f64))| (b.1 - a.1) / (b.0 - a.0);
        if half > 5 {
            slopes.push(median(&points.iter().zip(&points[half..]).map(grown).collect::<Vec<_>>()));
        }
    }
    (!slopes.is_empty()).then(|| median(&slopes))
}

/// Where a parabola through values at -1, 0 and 1, of which that at 0 is the highest, is highest.
fn summit(before: f64, at: f64, after: f64) -> f64 {
    let bend = before - 2.0 * at + after;
    if bend < -1e-9 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// Correlation of what is predicted in a window with what was measured `lag` bins later, over both axes.
fn alike(series: &[[Vec<f64>; 2]; 2], from: usize, window: usize, lag: i64) -> f64 {
    let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
    for [predicted, measured] in series {
        for i in (from..from + window).step_by(2) {
            let j = i as i64 + lag;
            if j < 0 || j as usize >= measured.len() {
                return -1.0;
            }
            let (x, y) = (predicted[i], measured[j as usize]);
            (xy, xx, yy) = (xy + x * y, xx + x * x, yy + y * y);
        }
    }
    if xx > 0.0 && yy > 0.0 { xy / (xx * yy).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::summit;

    #[test]
    fn a_parabola_is_highest_between_its_points() {
        let of = |x: f64| 1.0 - (x - 0.3).powi(2);
        assert!((summit(of(-1.0), of(0.0), of(1.0)) - 0.3).abs() < 1e-12);
        assert_eq!(summit(1.0, 1.0, 1.0), 0.0);
    }
}
