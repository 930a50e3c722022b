//! What the extended model remembers beyond the compact model's state.

use crate::base::lane::{Lane, Mask, Real, build, set_lanes};
use crate::model::constants::CONTROL_S;

/// Commands kept: a delay may be this many control periods less one.
pub const LINE: usize = 14;

/// What lies between two steps besides the state.
#[derive(Clone, Copy, Debug)]
pub struct EffectMemory<R> {
    /// The last commands, newest first.
    pub line: [[R; 4]; LINE],
    /// Time since the newest one, s.
    pub phase: R,
    /// Change of the filtered rate commands, 1/s.
    pub slope: [R; 3],
    /// Voltage lost to slow polarisation, V.
    pub polarisation: R,
}

impl EffectMemory<f64> {
    /// Before the first step of a flight that begins with `command`, which was held for long without load.
    pub fn before(command: [f64; 4]) -> Self {
        EffectMemory { line: [command; LINE], phase: CONTROL_S, slope: [0.0; 3], polarisation: 0.0 }
    }
}

impl<R: Copy> EffectMemory<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> EffectMemory<S> {
        EffectMemory {
            line: self.line.map(|command| command.map(&mut f)),
            phase: f(self.phase),
            slope: self.slope.map(&mut f),
            polarisation: f(self.polarisation),
        }
    }
}

impl<L: Lane> EffectMemory<L> {
    /// Replaces the memory of one lane.
    pub fn set_lane(&mut self, lane: usize, new: &EffectMemory<L::Elem>) {
        set_lanes(self.line.as_flattened_mut(), lane, new.line.as_flattened());
        self.phase.set(lane, new.phase);
        set_lanes(&mut self.slope, lane, &new.slope);
        self.polarisation.set(lane, new.polarisation);
    }
}

impl<R: Real> EffectMemory<R> {
    /// Takes in the held command `action`, of which roll, pitch, yaw and thrust arrive `delay` seconds late. What is
    /// never late needs no memory, and is not remembered.
    #[inline(always)]
    pub fn hold(&mut self, action: [R; 4], delay: [R; 4]) -> Held<R> {
        let mut late = R::zero().lt(delay[0]);
        for delay in &delay[1..] {
            late = late | R::zero().lt(*delay);
        }
        let late = late.any();
        if late {
            self.push();
        }
        self.line[0] = action;
        Held { delay, late }
    }

    /// Makes room for another command where a control period has gone by since the last.
    #[inline(always)]
    fn push(&mut self) {
        let due = R::of(CONTROL_S - 1e-5).le(self.phase);
        for age in (1..LINE).rev() {
            for k in 0..4 {
                self.line[age][k] = R::select(due, self.line[age - 1][k], self.line[age][k]);
            }
        }
        self.phase = R::select(due, R::zero(), self.phase);
    }

    /// What arrives on average during the next `h` seconds.
    #[inline(always)]
    pub fn arriving(&mut self, held: &Held<R>, h: R) -> [R; 4] {
        if !held.late {
            return self.line[0];
        }
        self.phase = self.phase + h;
        build!(|k| self.arrived(k, held.delay[k], h))
    }

    /// The mean of what arrived of command `k`, `late` seconds late, during the last `h` seconds.
    #[inline(always)]
    fn arrived(&self, k: usize, late: R, h: R) -> R {
        let (from, to) = (self.phase - h - late, self.phase - late);
        let mut sum = self.line[0][k] * (to.max(R::zero()) - from.max(R::zero()));
        for (age, command) in self.line.iter().enumerate().skip(1) {
            // Held from `begins` to one period later; the oldest was held before, too.
            let ends = R::of(-CONTROL_S * (age as f64 - 1.0));
            let begins = R::of(if age + 1 == LINE { -1e3 } else { -CONTROL_S * age as f64 });
            sum = command[k].mul_add((to.min(ends).max(begins)) - from.min(ends).max(begins), sum);
        }
        sum / h
    }
}

/// How a held command arrives.
#[derive(Clone, Copy, Debug)]
pub struct Held<R> {
    /// Of roll, pitch, yaw, thrust, s.
    delay: [R; 4],
    /// Whether any arrives late, in any lane.
    late: bool,
}
