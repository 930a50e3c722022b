//! Sets of time spans.

/// From, to, s.
pub type Span = [f64; 2];

/// Joins spans that touch or overlap; empty ones go.
pub fn joined(mut spans: Vec<Span>) -> Vec<Span> {
    spans.retain(|s| s[1] > s[0]);
    spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut out: Vec<Span> = Vec::with_capacity(spans.len());
    for span in spans {
        match out.last_mut() {
            Some(last) if span[0] <= last[1] => last[1] = last[1].max(span[1]),
            _ => out.push(span),
        }
    }
    out
}

/// What of `whole` lies outside of all `holes`.
pub fn without(whole: Span, holes: &[Span]) -> Vec<Span> {
    let mut out = Vec::new();
    let mut from = whole[0];
    for hole in joined(holes.to_vec()) {
        out.push([from, hole[0].min(whole[1])]);
        from = from.max(hole[1]);
    }
    out.push([from, whole[1]]);
    joined(out)
}

/// Every moment in `times` at which `condition` holds, with `margin` seconds on either side.
pub fn around(times: &[f64], condition: impl Fn(usize) -> bool, margin: f64) -> Vec<Span> {
    joined((0..times.len()).filter(|&i| condition(i)).map(|i| [times[i] - margin, times[i] + margin]).collect())
}

/// Whether `t` lies in one of the ascending, disjoint `spans`.
pub fn contain(spans: &[Span], t: f64) -> bool {
    spans.partition_point(|span| span[0] <= t).checked_sub(1).is_some_and(|i| t <= spans[i][1])
}

/// Seconds covered by disjoint spans.
pub fn length(spans: &[Span]) -> f64 {
    // Of nothing the sum has a minus.
    spans.iter().map(|span| span[1] - span[0]).sum::<f64>() + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_split_and_join() {
        let left = without([0.0, 10.0], &[[2.0, 3.0], [2.5, 4.0], [9.0, 12.0], [-1.0, 0.5]]);
        assert_eq!(left, [[0.5, 2.0], [4.0, 9.0]]);
        assert!(contain(&left, 1.0) && !contain(&left, 3.0) && contain(&left, 9.0) && !contain(&left, 0.0));
        assert_eq!(length(&left), 6.5);
        assert_eq!(around(&[0.0, 1.0, 2.0, 9.0], |i| i != 3, 0.5), [[-0.5, 2.5]]);
        assert!(without([0.0, 1.0], &[[-1.0, 2.0]]).is_empty());
    }
}
