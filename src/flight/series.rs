//! Numbers of one stream at the times of another.

/// Index of the last of the ascending `times` that is not after `t`.
pub fn last_at(times: &[f64], t: f64) -> Option<usize> {
    times.partition_point(|&time| time <= t).checked_sub(1)
}

/// `values` (at ascending `times`) at each of `at`, linear in between; NaN outside, and across more than `reach`
/// seconds.
pub fn interpolated(times: &[f64], values: &[f64], at: &[f64], reach: f64) -> Vec<f64> {
    let one = |&t: &f64| {
        let Some(i) = last_at(times, t) else { return f64::NAN };
        if times[i] == t {
            return values[i];
        }
        match times.get(i + 1) {
            Some(&next) if next - times[i] <= reach => {
                values[i] + (values[i + 1] - values[i]) * (t - times[i]) / (next - times[i])
            }
            _ => f64::NAN,
        }
    };
    at.iter().map(one).collect()
}

/// `values` (at ascending `times`) at each of `at`, each held until the next; NaN before the first.
pub fn held(times: &[f64], values: &[f64], at: &[f64]) -> Vec<f64> {
    at.iter().map(|&t| last_at(times, t).map_or(f64::NAN, |i| values[i])).collect()
}

/// The usual distance of `times`, s: their median; NaN for fewer than two.
pub fn period(times: &[f64]) -> f64 {
    crate::base::stats::median(&times.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_steps() {
        let (times, values) = ([0.0, 1.0, 3.0], [0.0, 10.0, 30.0]);
        let at = [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 4.0];
        let lines = interpolated(&times, &values, &at, 1.5);
        assert!(lines[0].is_nan() && lines[4].is_nan() && lines[6].is_nan());
        assert_eq!([lines[1], lines[2], lines[3], lines[5]], [0.0, 5.0, 10.0, 30.0]);
        let steps = held(&times, &values, &at);
        assert!(steps[0].is_nan());
        assert_eq!(steps[1..], [0.0, 0.0, 10.0, 10.0, 30.0, 30.0]);
        assert_eq!(period(&times), 2.0);
    }
}
