//! What steps of time do to a response, computed once for those that are of one length.

use crate::model::dynamics::response::{Computed, ResponseSteps, SecondOrder};

/// Steps of time that differ by less are of one length, s: clocks are rounded by more.
const SAME_S: f64 = 1e-10;
/// Lengths that are kept of an axis, each at its place by the microsecond: a prime, for most are round.
const KEPT: usize = 61;

/// The steps of the first `AXES` axes.
pub struct KeptSteps<const AXES: usize> {
    left: [[KeptStep<f64>; KEPT]; AXES],
    second_order: [[KeptStep<SecondOrder<f64>>; KEPT]; AXES],
}

/// What a step of `dt` seconds does where the response has the numbers `by`.
#[derive(Clone, Copy)]
struct KeptStep<T> {
    dt: f64,
    by: [f64; 2],
    does: T,
}

impl<T: Copy> KeptStep<T> {
    #[inline(always)]
    fn of(kept: &mut [Self; KEPT], by: [f64; 2], dt: f64, does: impl FnOnce() -> T) -> T {
        let step = &mut kept[(dt * 1e6) as usize % KEPT];
        if (step.dt - dt).abs() > SAME_S || step.by != by {
            *step = Self { dt, by, does: does() };
        }
        step.does
    }
}

impl<const AXES: usize> Default for KeptSteps<AXES> {
    /// None yet.
    fn default() -> Self {
        let by = [f64::NAN; 2];
        let still = Computed.second_order(0, 1.0, 1.0, 0.0);
        Self {
            left: [[KeptStep { dt: 0.0, by, does: 1.0 }; KEPT]; AXES],
            second_order: [[KeptStep { dt: 0.0, by, does: still }; KEPT]; AXES],
        }
    }
}

impl<const AXES: usize> ResponseSteps<f64> for KeptSteps<AXES> {
    #[inline(always)]
    fn left(&mut self, axis: usize, tau: f64, dt: f64) -> f64 {
        KeptStep::of(&mut self.left[axis], [tau, 0.0], dt, || Computed.left(axis, tau, dt))
    }

    #[inline(always)]
    fn second_order(&mut self, axis: usize, tau: f64, inertia: f64, dt: f64) -> SecondOrder<f64> {
        let does = || Computed.second_order(axis, tau, inertia, dt);
        KeptStep::of(&mut self.second_order[axis], [tau, inertia], dt, does)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_steps_do_what_computed_ones_do() {
        let mut kept = KeptSteps::<2>::default();
        for i in 0..1000 {
            let (axis, dt) = (i % 2, 0.001 + 1e-4 * (i % 7) as f64);
            let (tau, inertia) = if i < 500 { (0.05, 1e-4) } else { (0.04, 3e-4) };
            assert_eq!(kept.left(axis, tau, dt), Computed.left(axis, tau, dt));
            let [ours, theirs] =
                [kept.second_order(axis, tau, inertia, dt), Computed.second_order(axis, tau, inertia, dt)];
            assert_eq!(ours.after(0.3, -2.0, 1.0), theirs.after(0.3, -2.0, 1.0));
        }
    }
}
