//! Shares with Wilson's 95 % interval, and medians.

/// So many of so many.
#[derive(Clone, Copy, Debug, Default)]
pub struct Share {
    pub of: usize,
    pub yes: usize,
}

impl Share {
    pub fn count(answers: impl IntoIterator<Item = bool>) -> Self {
        answers.into_iter().fold(Share::default(), |s, yes| Share { of: s.of + 1, yes: s.yes + usize::from(yes) })
    }

    /// Wilson's interval at 95 %, which holds for few and for extreme shares as well.
    pub fn interval(self) -> [f64; 2] {
        if self.of == 0 {
            return [0.0, 1.0];
        }
        let (n, p, z) = (self.of as f64, self.yes as f64 / self.of as f64, 1.959_964);
        let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
        let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        [(middle - half).max(0.0), (middle + half).min(1.0)]
    }

    /// As printed: `12/40  30.0 %  (18 to 45)`.
    pub fn text(self) -> String {
        if self.of == 0 {
            return "0/0".into();
        }
        let [low, high] = self.interval().map(|x| 100.0 * x);
        let percent = 100.0 * self.yes as f64 / self.of as f64;
        format!("{:>9}  {percent:>5.1} %  ({low:.1} to {high:.1})", format!("{}/{}", self.yes, self.of))
    }
}
