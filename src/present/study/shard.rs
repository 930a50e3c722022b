//! A study's runs dealt out to machines that share nothing but the study's folder.

use std::fmt;

/// Part `k` of `n`, counted from 1: every n-th run from the k-th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub k: usize,
    pub n: usize,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Shard = Shard { k: 1, n: 1 };

    /// Reads `K/N`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
        match numbers {
            Some((k, n)) if 1 <= k && k <= n => Ok(Self { k, n }),
            _ => Err("expected K/N with 1 <= K <= N, such as 1/4".into()),
        }
    }

    /// Whether the run in this place, counted from 0, belongs to this part.
    pub fn has(&self, run: usize) -> bool {
        run % self.n == self.k - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.k, self.n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_belongs_to_one_part() {
        for n in 1..9 {
            for run in 0..40 {
                assert_eq!((1..=n).filter(|&k| Shard { k, n }.has(run)).count(), 1);
            }
        }
        assert_eq!(Shard::parse("2/3"), Ok(Shard { k: 2, n: 3 }));
        for bad in ["0/3", "4/3", "2", "a/b", "1/0", "-1/2"] {
            assert!(Shard::parse(bad).is_err(), "{bad}");
        }
    }
}
