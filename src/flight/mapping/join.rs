//! Numbers of one table at the times of another.

/// Neighbours further apart than this say nothing about the time between them, s.
const GAP_S: f64 = 0.25;

/// Where a wanted time lies between the rows of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    pub before: usize,
    pub after: usize,
    /// Share of `after`, 0 to 1.
    pub share: f64,
}

/// The neighbours in `stamps` of each of the `wanted` times; `None` outside and within gaps. Rows of `stamps` that are
/// out of order, or without a time, are passed over.
pub fn between(stamps: &[f64], wanted: &[f64]) -> Vec<Option<Between>> {
    let mut order: Vec<usize> = (0..stamps.len()).filter(|&i| stamps[i].is_finite()).collect();
    order.sort_by(|&a, &b| stamps[a].total_cmp(&stamps[b]));
    wanted
        .iter()
        .map(|&time| {
            let next = order.partition_point(|&i| stamps[i] < time);
            let after = *order.get(next)?;
            if stamps[after] == time {
                return Some(Between { before: after, after, share: 0.0 });
            }
            let before = *order.get(next.checked_sub(1)?)?;
            let gap = stamps[after] - stamps[before];
            (gap <= GAP_S).then(|| Between { before, after, share: (time - stamps[before]) / gap })
        })
        .collect()
}

/// Between two rows. With `sphere`, they are quaternions.
pub fn blend<const N: usize>(a: [f64; N], b: [f64; N], share: f64, sphere: bool) -> [f64; N] {
    let dot: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let sign = if sphere && dot < 0.0 { -1.0 } else { 1.0 };
    let mut row: [f64; N] = std::array::from_fn(|k| (1.0 - share) * a[k] + share * sign * b[k]);
    if sphere {
        let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        row = row.map(|x| x / length);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_ends_and_gaps() {
        let found = between(&[0.0, 0.1, f64::NAN, 0.2, 1.0], &[-0.1, 0.0, 0.05, 0.15, 0.5, 1.0, 1.1, f64::NAN]);
        assert_eq!(found[0], None);
        assert_eq!(found[1], Some(Between { before: 0, after: 0, share: 0.0 }));
        assert_eq!(found[2], Some(Between { before: 0, after: 1, share: 0.5 }));
        assert_eq!(found[3].map(|at| (at.before, at.after)), Some((1, 3)));
        assert_eq!(found[4], None, "a gap");
        assert_eq!(found[5].map(|at| at.after), Some(4));
        assert_eq!(found[6..], [None, None]);
    }

    #[test]
    fn quaternions_of_either_sign_are_the_same_attitude() {
        let middle = blend([1.0, 0.0, 0.0, 0.0], [-0.8, 0.0, 0.0, -0.6], 0.5, true);
        let expected = [(0.9f64).sqrt(), 0.0, 0.0, 0.1f64.sqrt()];
        assert!(middle.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{middle:?}");
    }
}
