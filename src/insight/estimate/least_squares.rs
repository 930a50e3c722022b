//! Gauss-Newton steps within bounds, and within half-spaces.

use super::halfspace::{Halfspace, minimum};
use super::inverse::inverse;
use nalgebra::{DMatrix, DVector};

/// A number and the range that it has to stay in.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// Squares, linearised at a point.
pub struct Normal<'a> {
    /// J'J of all numbers.
    pub matrix: &'a DMatrix<f64>,
    /// J'(measured - predicted), and the pull of whatever else the numbers are held by.
    pub downhill: Vec<f64>,
    /// What is added to the diagonal: one over the variance that each number is known with beforehand.
    pub ridge: Vec<f64>,
    /// What the numbers have to satisfy besides their bounds.
    pub within: &'a [Halfspace],
}

/// How a step that does not lower the squares is made shorter.
pub enum Shorter<'a> {
    /// Levenberg and Marquardt: by more weight on the diagonal, remembered from one step to the next. It bends toward
    /// the steepest way down, which costs a new solution each time: for few numbers far from the minimum.
    Damped(&'a mut f64),
    /// By half, down to a sixteenth: for steps whose squares cost a prediction of whole flights. No step at all where
    /// one is expected to lower them by less than so much.
    Halved(f64),
    /// Damped in as few tries, for such steps of numbers that stand in for one another: a way that hardly anything
    /// tells is given up first, where half of it would still be too far. No step at all as there.
    Seldom(f64),
}

/// Damping beyond which no step is left, and the least that is kept.
const DAMPING: [f64; 2] = [1e-9, 100.0];

/// Times that a step is halved and tried.
const HALVINGS: i32 = 5;

/// Damping of the few tries: none; what leaves a step but for what hardly anything tells; and what shortens all of it.
const SELDOM: [f64; 6] = [0.0, 1e-5, 1e-3, 0.1, 1.0, 15.0];

impl Normal<'_> {
    /// The step to the minimum, with `damping` times its own information on each number's diagonal. Numbers at a bound
    /// that they push against, and those that nothing tells, stay.
    pub fn step(&self, at: &[Bounded], damping: f64) -> Option<Vec<f64>> {
        if !self.within.is_empty() {
            return self.step_within(at, damping);
        }
        let own = |j: usize| self.matrix[(j, j)];
        let mut moving: Vec<usize> = (0..at.len()).filter(|&j| own(j) + self.ridge[j] > 0.0).collect();
        loop {
            let n = moving.len();
            let part = DMatrix::from_fn(n, n, |a, b| self.matrix[(moving[a], moving[b])]);
            let ridge: Vec<f64> = moving.iter().map(|&j| self.ridge[j] + damping * own(j)).collect();
            let step = inverse(&part, &ridge)? * DVector::from_fn(n, |a, _| self.downhill[moving[a]]);
            let stuck = |a: usize| {
                let Bounded { value, low, high } = at[moving[a]];
                value <= low && step[a] < 0.0 || value >= high && step[a] > 0.0
            };
            let still: Vec<usize> = (0..n).filter(|&a| !stuck(a)).map(|a| moving[a]).collect();
            if still.len() == n {
                let mut out = vec![0.0; at.len()];
                moving.iter().zip(step.iter()).for_each(|(&j, by)| out[j] = *by);
                return Some(out);
            }
            moving = still;
        }
    }

    /// The same where half-spaces hold the numbers together; the bounds are half-spaces too.
    fn step_within(&self, at: &[Bounded], damping: f64) -> Option<Vec<f64>> {
        let told = |&j: &usize| self.matrix[(j, j)] + self.ridge[j] > 0.0 && at[j].low < at[j].high;
        let moving: Vec<usize> = (0..at.len()).filter(told).collect();
        let n = moving.len();
        let part = DMatrix::from_fn(n, n, |a, b| self.matrix[(moving[a], moving[b])]);
        let ridge: Vec<f64> = moving.iter().map(|&j| self.ridge[j] + damping * self.matrix[(j, j)]).collect();
        let downhill: Vec<f64> = moving.iter().map(|&j| self.downhill[j]).collect();
        let here: Vec<f64> = at.iter().map(|b| b.value).collect();
        let mut rows: Vec<Halfspace> = Vec::new();
        for (a, &j) in moving.iter().enumerate() {
            rows.push(Halfspace::bound(a, n, 1.0, at[j].low - at[j].value));
            rows.push(Halfspace::bound(a, n, -1.0, at[j].value - at[j].high));
        }
        let reduced =
            |h: &Halfspace| Halfspace { row: moving.iter().map(|&j| h.row[j]).collect(), least: -h.room(&here) };
        rows.extend(self.within.iter().map(reduced));
        let step = minimum(&part, &ridge, &downhill, &rows)?;
        let mut out = vec![0.0; at.len()];
        moving.iter().zip(step).for_each(|(&j, by)| out[j] = by);
        Some(out)
    }

    /// The first step that brings the squares below `before`: the values that it leads to, their squares, and what
    /// `squares`, which makes both, says besides. `None` where no part of it does.
    pub fn descend<T>(
        &self,
        at: &[Bounded],
        shorter: Shorter,
        before: f64,
        mut squares: impl FnMut(&[f64]) -> (f64, T),
    ) -> Option<(Vec<f64>, f64, T)> {
        let mut lower = |step: &[f64], share: f64| {
            let moved = |(n, by): (&Bounded, &f64)| (n.value + share * by).clamp(n.low, n.high);
            let values: Vec<f64> = at.iter().zip(step).map(moved).collect();
            let (now, rest) = squares(&values);
            (now < before).then_some((values, now, rest))
        };
        let expected = |step: &[f64]| step.iter().zip(&self.downhill).map(|(by, down)| by * down).sum::<f64>();
        match shorter {
            Shorter::Halved(least) => {
                let step = self.step(at, 0.0)?;
                let times = if expected(&step) < least { 0 } else { HALVINGS };
                (0..times).find_map(|halvings| lower(&step, 0.5f64.powi(halvings)))
            }
            Shorter::Seldom(least) => {
                let steps = SELDOM.iter().map_while(|damping| self.step(at, *damping));
                steps.take_while(|step| expected(step) >= least).find_map(|step| lower(&step, 1.0))
            }
            Shorter::Damped(damping) => {
                while *damping < DAMPING[1] {
                    if let Some(found) = self.step(at, *damping).and_then(|step| lower(&step, 1.0)) {
                        *damping = (*damping * 0.1).max(DAMPING[0]);
                        return Some(found);
                    }
                    *damping *= 10.0;
                }
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x - 1)^2 + (x + y - 4)^2, once with room for its minimum at (1, 3), once with y at most 2.
    #[test]
    fn a_step_reaches_the_minimum_within_its_bounds() {
        let matrix = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 1.0]);
        let cost = |v: &[f64]| ((v[0] - 1.0).powi(2) + (v[0] + v[1] - 4.0).powi(2), ());
        for (y, high, wanted) in [(0.0, 9.0, [1.0, 3.0]), (2.0, 2.0, [1.5, 2.0])] {
            let at = [Bounded { value: 0.0, low: -9.0, high: 9.0 }, Bounded { value: y, low: 0.0, high }];
            let normal = Normal { matrix: &matrix, downhill: vec![5.0 - y, 4.0 - y], ridge: vec![0.0; 2], within: &[] };
            let before = cost(&[0.0, y]).0;
            let mut damping = 1e-9;
            for shorter in [Shorter::Halved(0.0), Shorter::Seldom(0.0), Shorter::Damped(&mut damping)] {
                let (values, ..) = normal.descend(&at, shorter, before, cost).unwrap();
                assert!((0..2).all(|k| (values[k] - wanted[k]).abs() < 1e-6), "{values:?}");
            }
        }
    }

    #[test]
    fn a_step_that_never_pays_is_none_and_one_that_cannot_is_not_tried() {
        let matrix = DMatrix::from_element(1, 1, 1.0);
        let normal = Normal { matrix: &matrix, downhill: vec![1.0], ridge: vec![0.0], within: &[] };
        let at = [Bounded { value: 0.0, low: -1.0, high: 1.0 }];
        let looks = |shorter: Shorter| {
            let mut looked = 0_usize;
            let found = normal.descend(&at, shorter, 1.0, |_| {
                looked += 1;
                (2.0, ())
            });
            assert_eq!(found, None);
            looked
        };
        assert_eq!([0.9, 1.1].map(|least| looks(Shorter::Halved(least))), [HALVINGS as usize, 0]);
        // The third try expects 1 / 1.001, the fourth 1 / 1.1.
        assert_eq!([0.0, 0.95, 1.1].map(|least| looks(Shorter::Seldom(least))), [SELDOM.len(), 3, 0]);
    }

    /// Of two numbers that stand in for one another the sum alone is told: the step that it asks for is taken, though
    /// the whole step goes far off, to where the line is none.
    #[test]
    fn what_hardly_anything_tells_is_given_up_before_what_is_told() {
        let (sum, apart) = (1.0, 1e-6);
        let matrix = DMatrix::from_row_slice(2, 2, &[sum + apart, sum - apart, sum - apart, sum + apart]);
        // Downhill along both by 0.1, and along their difference by a little, which asks for a step of 50.
        let normal =
            Normal { matrix: &matrix, downhill: vec![0.1 + 1e-4, 0.1 - 1e-4], ridge: vec![0.0; 2], within: &[] };
        let at = [Bounded { value: 0.0, low: -99.0, high: 99.0 }; 2];
        let cost = |v: &[f64]| ((v[0] + v[1] - 0.1).powi(2) + (v[0] - v[1]).powi(4), ());
        let before = cost(&[0.0; 2]).0;
        let (values, now, ()) = normal.descend(&at, Shorter::Seldom(0.0), before, cost).unwrap();
        assert!(now < 0.2 * before, "{now} at {values:?}");
    }
}
