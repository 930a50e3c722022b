//! Rows of one number for each motor or rotor.

use super::Stream;

/// The most motors that a row has room for.
pub const MOTORS: usize = 8;

/// A row of the numbers of the first motors; of others NaN.
pub fn row(numbers: &[f64]) -> [f64; MOTORS] {
    std::array::from_fn(|k| numbers.get(k).copied().unwrap_or(f64::NAN))
}

/// Mean over the motors of a row that have a number; NaN where none has.
pub fn mean(row: &[f64; MOTORS]) -> f64 {
    let known = || row.iter().filter(|x| x.is_finite());
    known().sum::<f64>() / known().count() as f64
}

impl Stream<MOTORS> {
    /// Up to the last motor that any row has a number of.
    pub fn count(&self) -> usize {
        (0..MOTORS).rev().find(|&k| self.rows.iter().any(|row| row[k].is_finite())).map_or(0, |last| last + 1)
    }

    /// Mean over the motors, row by row.
    pub fn means(&self) -> Vec<f64> {
        self.rows.iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motors_that_there_are() {
        let mut stream = Stream::default();
        assert_eq!(stream.count(), 0);
        stream.push(0.0, row(&[1.0, f64::NAN, 3.0]));
        stream.push(1.0, row(&[]));
        assert_eq!(stream.count(), 3);
        assert_eq!(stream.means()[0], 2.0);
        assert!(stream.means()[1].is_nan());
    }
}
