//! Durations, counted in bins that grow with them: an hour at 100 Hz in a few hundred numbers.

/// Bins to a doubling, and the upper end of the first bin, s.
const PER_DOUBLING: f64 = 8.0;
const LEAST_S: f64 = 1e-6;
const BINS: usize = 256;

/// How many durations were how long.
#[derive(Clone, Debug)]
pub struct Histogram {
    bins: [u64; BINS],
    pub count: u64,
    pub longest_s: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { bins: [0; BINS], count: 0, longest_s: 0.0 }
    }
}

impl Histogram {
    /// Counts one, s. Less than nothing counts as nothing.
    pub fn add(&mut self, seconds: f64) {
        let bin = ((seconds / LEAST_S).max(1.0).log2() * PER_DOUBLING).ceil() as usize;
        self.bins[bin.min(BINS - 1)] += 1;
        self.count += 1;
        self.longest_s = self.longest_s.max(seconds);
    }

    /// The duration that a share of all do not exceed, s, to a twelfth; none of none.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let wanted = (share * self.count as f64).ceil().max(1.0) as u64;
        let mut seen = 0;
        let bin = self.bins.iter().position(|count| {
            seen += count;
            seen >= wanted
        })?;
        Some((LEAST_S * (bin as f64 / PER_DOUBLING).exp2()).min(self.longest_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_what_was_counted() {
        let mut histogram = Histogram::default();
        assert_eq!(histogram.quantile(0.5), None);
        (1..=1000).for_each(|i| histogram.add(f64::from(i) * 1e-5));
        for (share, exact) in [(0.5, 5e-3), (0.99, 9.9e-3), (0.999, 9.99e-3)] {
            let found = histogram.quantile(share).unwrap();
            assert!(found >= exact * 0.999 && found < exact * 1.1, "{share}: {found}");
        }
        assert_eq!((histogram.count, histogram.quantile(1.0)), (1000, Some(1e-2)));
    }
}
