//! Causes that have the same mean, decided by what else they would leave.

use super::fit;
use super::model;
use super::problem::Problem;
use super::random;
use super::select::{Added, Selection};
use crate::base::stats::mean;
use crate::model::constants::CONTROL_S;
use crate::model::effects;

/// A gyro that comes late, after commands and after the odometry by the same time, is stamped late: one cause, not two of the same size.
pub fn clocks(problem: &Problem, selection: &mut Selection) {
    /// Agreement of the two times, s, and as a share.
    const SAME: [f64; 2] = [6e-4, 0.05];
    /// And of a lag of the velocity that comes from it.
    const LAG: f64 = 0.5;
    let [Some(delay), Some(offset)] = ["rate_delay", "stream_offset"].map(effects::card) else { return };
    let moved = mean(&problem.records.iter().map(|r| r.moved).collect::<Vec<_>>());
    let [asked, stamped] = [delay, offset].map(|card| model::span(card).start);
    let Some(i) = selection.added.iter().position(|a| a.card.id == delay.id || a.card.id == offset.id) else { return };
    let mut x = selection.point.x.clone();
    let late = x[asked] + x[stamped];
    let both = selection.added.iter().filter(|a| a.card.id == delay.id || a.card.id == offset.id).count() > 1;
    if moved == 0.0 || both || (late - moved).abs() > SAME[0] + SAME[1] * moved.abs() {
        return;
    }
    (x[asked], x[stamped]) = (0.0, late);
    let mut free = selection.point.free.clone();
    free.retain(|k| *k != asked && *k != stamped);
    free.push(stamped);
    selection.added[i] = Added { card: offset, ties: Vec::new() };
    // The odometry was moved to a gyro that was late itself: its velocity seems late by as much, and is none.
    selection.added.retain(|a| a.card.id != "velocity_lag" || (x[model::span(a.card).start] / moved - 1.0).abs() > LAG);
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
}

/// Lost commands and a short delay have the same mean: what single stick movements leave decides.
pub fn chance(problem: &Problem, selection: &mut Selection) -> Option<random::Lost> {
    let dropout = effects::card("command_dropout")?;
    let lost = random::lost_commands(problem, selection);
    let are_lost = random::are_lost(&lost, dropout);
    let at = |card: &effects::Card| model::span(card).start;
    let mut x = selection.point.x.clone();
    let mut free = selection.point.free.clone();
    // A delay that lost commands account for is none.
    let explained = |a: &Added, x: &[f64]| a.card.id == "rate_delay" && x[at(a.card)] < 3.0 * lost.share * CONTROL_S;
    if are_lost {
        let gone: Vec<Added> =
            selection.added.iter().filter(|a| explained(a, &x) || a.card.id == dropout.id).cloned().collect();
        for a in &gone {
            model::span(a.card).for_each(|k| x[k] = 0.0);
            free.retain(|k| !model::span(a.card).contains(k));
            selection.added.retain(|other| other.card.id != a.card.id);
        }
        selection.added.push(Added { card: dropout, ties: Vec::new() });
        // Counted, not fitted: its mean is a delay that the time constants take up.
        x[at(dropout)] = lost.share;
    } else if let Some(i) = selection.added.iter().position(|a| a.card.id == dropout.id) {
        // Its mean is there, its variance is not: the rival that has the same mean.
        let other = selection.added[i].ties.first().copied().or(effects::card("rate_delay"));
        let other = other.filter(|o| selection.added.iter().all(|a| a.card.id != o.id));
        let mean = std::mem::take(&mut x[at(dropout)]) * CONTROL_S;
        free.retain(|k| *k != at(dropout));
        selection.added.remove(i);
        if let Some(other) = other {
            x[at(other)] = mean;
            free.extend(model::span(other));
            selection.added.insert(i, Added { card: other, ties: Vec::new() });
        }
    } else {
        selection.added.iter_mut().for_each(|a| a.ties.retain(|c| c.id != dropout.id));
        return None;
    }
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
    are_lost.then_some(lost)
}
