//! Lost commands: their mean is that of a delay, and their variance that of nothing else. Large stick movements are
//! looked at one by one: of each, how much of the error is there that its loss would leave.

use super::Selection;
use crate::base::stats::{NORMAL_95, robust_sd};
use crate::insight::criteria::chance::{
    EARLY_DEVIATIONS, EARLY_SHARE, LOST_COMMANDS, LOST_HALF, LOST_MOST, LOST_OVER_EARLY, LOST_OVER_HALF,
    LOST_SHARE_MOST, LOST_WHOLE, MOVEMENT_BEFORE, MOVEMENT_DEVIATIONS,
};
use crate::insight::criteria::material::MATERIAL_SIZE;
use crate::insight::criteria::planned::PLANNED_MARGIN;
use crate::insight::diagnose::prediction::channels::RATE;
use crate::insight::diagnose::prediction::numbers::TAU;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::dynamics::extended;
use crate::model::dynamics::response::alpha;
use crate::model::effects::Card;

/// What large stick movements say.
#[derive(Clone, Copy, Debug)]
pub struct Lost {
    /// Share of the commands that is lost, with its 95 % interval.
    pub share: f64,
    pub interval: [f64; 2],
    /// Movements whose whole error is there, and those with about half of it: a loss is all or nothing.
    pub whole: usize,
    pub half: usize,
    /// Movements that were answered before they were due: a loss never is, a link whose delay varies is as often early
    /// as late.
    pub early: usize,
    /// Movements that would have shown a loss.
    pub looked_at: usize,
}

impl Lost {
    /// Share of lost commands from which enough would have been seen in nine of ten flights: their number spreads by
    /// its root.
    pub fn seen_from(&self) -> f64 {
        let half = 0.5 * PLANNED_MARGIN.get();
        (half + half.hypot(LOST_COMMANDS.get().sqrt())).powi(2) / self.looked_at.max(1) as f64
    }

    /// Whether commands get lost, by a share that matters for the effect of this card.
    pub fn matters(&self, card: &Card) -> bool {
        let whole = self.whole as f64;
        whole >= LOST_COMMANDS.get()
            && whole > LOST_OVER_HALF.get() * self.half as f64
            && whole > LOST_OVER_EARLY.get() * self.early as f64
            && self.share > MATERIAL_SIZE.get() * card.parameters[0].typical[0]
            && self.share < LOST_SHARE_MOST.get()
    }
}

/// Holds the rate residuals against the error that each lost command would leave: the change of the command, for one
/// period, behind the lag.
pub fn lost_commands(problem: &Problem, selection: &Selection) -> Lost {
    let x = &selection.point.x;
    let p = problem.model.parameters(x);
    let late = extended::command_delays(&p);
    let mut answers = Vec::new();
    for k in 0..3 {
        let (rows, residual) = (&problem.rows[RATE + k], &selection.point.residual[RATE + k]);
        let noise = robust_sd(residual);
        let axis = StickAxis { k, noise, tau: x[TAU.start + k], late: late[k], max_rate: p.compact.max_rate[k] };
        for (f, record) in problem.records.iter().enumerate() {
            let mut by_bin = vec![f64::NAN; record.bins.len()];
            let own = rows.iter().zip(residual).filter(|(row, _)| row.flight as usize == f);
            own.for_each(|(row, r)| by_bin[row.index as usize] = *r);
            let middle = |b: &[usize; 2]| 0.5 * (record.time[b[0]] + record.time[b[1] - 1]);
            let middles: Vec<f64> = record.bins.iter().map(middle).collect();
            answers.extend(record.sent.windows(3).filter_map(|three| axis.answer(three, &middles, &by_bin)));
        }
    }
    let count = |of: &dyn Fn(&StickAnswer) -> bool| answers.iter().filter(|a| of(a)).count();
    let whole = count(&|a| (LOST_WHOLE.get()..LOST_MOST.get()).contains(&a.missing));
    let half = count(&|a| (LOST_HALF.get()..LOST_WHOLE.get()).contains(&a.missing));
    let looked_at = answers.len();
    let n = looked_at.max(1) as f64;
    let share = (whole + half) as f64 / n;
    let spread = NORMAL_95 * (share * (1.0 - share) / n).sqrt();
    Lost { share, interval: [share - spread, share + spread], whole, half, early: count(&|a| a.early), looked_at }
}

/// How a movement was answered.
struct StickAnswer {
    /// Share of the error of a loss that is there.
    missing: f64,
    early: bool,
}

/// One axis of the rates.
struct StickAxis {
    k: usize,
    /// Of its residual, rad/s.
    noise: f64,
    /// Time constant and delay, s; rate at full command, rad/s.
    tau: f64,
    late: f64,
    max_rate: f64,
}

impl StickAxis {
    /// How the last but one of three commands was answered, by the residual of bins around `middles`; none where its
    /// loss would not show.
    fn answer(&self, three: &[(f64, [f64; 4])], middles: &[f64], by_bin: &[f64]) -> Option<StickAnswer> {
        let &[before, now, next] = three else { return None };
        let change = (next.1[self.k] - now.1[self.k]) * self.max_rate;
        let clear = MOVEMENT_DEVIATIONS.get() * self.noise;
        // What the loss of the command before would leave reaches into this one.
        let earlier = (now.1[self.k] - before.1[self.k]) * self.max_rate;
        if change.abs() < clear || earlier.abs() > MOVEMENT_BEFORE.get() * change.abs() {
            return None;
        }
        let (begin, held) = (next.0 + self.late, next.0 - now.0);
        let rise = |t: f64| if t > 0.0 { alpha(self.tau, t) } else { 0.0 };
        let first = middles.partition_point(|t| *t < begin);
        let (mut along, mut square) = (0.0, 0.0);
        for bin in first..middles.len().min(first + 3) {
            let since = middles[bin] - begin;
            let shape = change * (rise(since) - rise(since - held));
            along -= shape * by_bin[bin];
            square += shape * shape;
        }
        if square < clear.powi(2) || !along.is_finite() {
            return None;
        }
        let due = middles.partition_point(|t| *t < begin - held);
        let (mut ahead, mut most) = (0.0, 0.0);
        for bin in due..first {
            let shape = change * rise(middles[bin] - (begin - held));
            ahead += shape * by_bin[bin];
            most += shape * shape;
        }
        let early = most > (EARLY_DEVIATIONS.get() * self.noise).powi(2) && ahead > EARLY_SHARE.get() * most;
        Some(StickAnswer { missing: along / square, early })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::effects::{Role, acting};

    #[test]
    fn no_link_loses_two_commands_of_five() {
        let card = acting(Role::CommandsLost).next().expect("one");
        let lost = |share| Lost { share, interval: [share, share], whole: 12, half: 2, early: 0, looked_at: 200 };
        assert!(lost(0.1).matters(card) && !lost(0.39).matters(card));
    }

    #[test]
    fn enough_losses_are_seen_in_nine_of_ten_flights() {
        let lost = Lost { share: 0.1, interval: [0.1; 2], whole: 12, half: 2, early: 0, looked_at: 200 };
        let expected = 200.0 * lost.seen_from();
        assert!((expected - PLANNED_MARGIN.get() * expected.sqrt() - LOST_COMMANDS.get()).abs() < 1e-9);
    }
}
