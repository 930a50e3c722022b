//! Causes that have the same mean, told apart by what else they would leave.

use super::lost::{Lost, lost_commands};
use super::{Added, Selection};
use crate::insight::criteria::evident::LEAST_GAIN;
use crate::insight::criteria::rival::{LOST_DELAY, SAME_DELAY_S, SAME_DELAY_SHARE, SAME_LAG_SHARE};
use crate::insight::diagnose::fitting::agreement;
use crate::insight::diagnose::fitting::fit::{self, FitPoint};
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::model::constants::CONTROL_S;
use crate::model::effects::{self, Card, Evidence, Role};

/// Where the first number of an effect is.
fn at(card: &Card) -> usize {
    span(card).start
}

/// A gyro that comes late, after commands and after the odometry by the same time, is stamped late: one cause, not two
/// of the same size. So is a whole IMU that is late by more than the motors are.
pub fn clocks(problem: &Problem, selection: &mut Selection) {
    for (stamped, delayed) in effects::twins(Evidence::OdometryClock) {
        clock(problem, selection, stamped, delayed);
        common(problem, selection, stamped, delayed);
    }
}

/// The same of delays that are the parts of one: what they have in common is the clock's, where the odometry was off by
/// as much or the motors had no such delay, and what one of them has besides is its own. A yaw that begins before roll
/// and pitch, as the rotors' inertia makes it, hides the clock's part of its delay and is not asked.
fn common(problem: &Problem, selection: &mut Selection, stamped: &'static Card, delayed: &'static Card) {
    let moved = problem.moved();
    let parts: Vec<&'static Card> = delayed.parts.iter().filter_map(|id| effects::card(id)).collect();
    let held = |card: &&&Card| selection.added.iter().any(|a| a.card.id == card.id);
    if parts.is_empty() || parts.iter().filter(held).count() < parts.len() {
        return;
    }
    let mut x = selection.point.x.clone();
    let least = parts.iter().map(|part| x[at(part)]).fold(f64::INFINITY, f64::min);
    if !is_moved(least, moved) && !problem.is_behind_motors(least) {
        return;
    }
    let is_led = |a: &Added| a.card.apart_from.contains(&delayed.id) && selection.point.x[at(a.card)] < 0.0;
    let is_led = selection.added.iter().any(is_led);
    x[at(stamped)] = least;
    let (gone, longer): (Vec<&'static Card>, Vec<_>) = parts.into_iter().partition(|part| is_same(x[at(part)], least));
    longer.iter().for_each(|part| x[at(part)] -= least);
    gone.iter().for_each(|part| x[at(part)] = 0.0);
    let mut free = selection.point.free.clone();
    free.retain(|k| gone.iter().all(|part| at(part) != *k));
    free.push(at(stamped));
    let point = fit::fit(problem, &selection.whitener, &x, &free);
    let left = |p: &FitPoint| match is_led {
        true => agreement::squares_but_yaw(problem, &selection.whitener, &p.residual),
        false => p.total(),
    };
    if left(&point) < left(&selection.point) + LEAST_GAIN.get() {
        selection.added.retain(|a| gone.iter().all(|part| part.id != a.card.id));
        selection.added.push(Added { card: stamped, ties: Vec::new() });
        selection.point = point;
    }
}

/// Whether the odometry was moved, and by this delay.
fn is_moved(delay: f64, moved: f64) -> bool {
    moved != 0.0 && is_same(delay, moved)
}

/// Whether two delays are the same.
fn is_same(delay: f64, other: f64) -> bool {
    (delay - other).abs() <= SAME_DELAY_S.get() + SAME_DELAY_SHARE.get() * other.abs()
}

/// The same of one pair.
fn clock(problem: &Problem, selection: &mut Selection, stamped: &'static Card, delayed: &'static Card) {
    let moved = problem.moved();
    let is_one = |a: &Added| [stamped.id, delayed.id].contains(&a.card.id);
    let Some(i) = selection.added.iter().position(is_one) else { return };
    let mut x = selection.point.x.clone();
    let late = x[at(delayed)] + x[at(stamped)];
    let both = selection.added.iter().filter(|a| is_one(a)).count() > 1;
    let is_behind = !delayed.parts.is_empty() && problem.is_behind_motors(late);
    if both || !(is_moved(late, moved) || is_behind) {
        return;
    }
    (x[at(delayed)], x[at(stamped)]) = (0.0, late);
    let mut free = selection.point.free.clone();
    free.retain(|k| *k != at(delayed) && *k != at(stamped));
    free.push(at(stamped));
    let point = fit::fit(problem, &selection.whitener, &x, &free);
    let apart = |at: &FitPoint| agreement::squares(problem, &selection.whitener, &at.residual);
    if apart(&point) > apart(&selection.point) + LEAST_GAIN.get() {
        return;
    }
    selection.added[i] = Added { card: stamped, ties: Vec::new() };
    // The odometry was moved to a gyro that was late itself: its velocity seems late by as much, and is none.
    let is_its = |a: &Added| (x[at(a.card)] / moved - 1.0).abs() <= SAME_LAG_SHARE.get();
    selection.added.retain(|a| moved == 0.0 || a.card.role != Role::VelocityLag || !is_its(a));
    selection.point = point;
}

/// Lost commands and a short delay have the same mean: what single stick movements leave decides.
pub fn chance(problem: &Problem, selection: &mut Selection) -> Option<Lost> {
    let (dropout, delayed) = effects::twins(Evidence::SingleMovements).next()?;
    let lost = lost_commands(problem, selection);
    let are_lost = lost.matters(dropout);
    let (x, free) = if are_lost {
        counted(selection, dropout, delayed, lost.share)
    } else if let Some(i) = selection.added.iter().position(|a| a.card.id == dropout.id) {
        not_lost(selection, i, delayed)
    } else {
        selection.added.iter_mut().for_each(|a| a.ties.retain(|c| c.id != dropout.id));
        return None;
    };
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
    are_lost.then_some(lost)
}

/// Numbers, and which of them are free, where this share of the commands is lost.
fn counted(selection: &mut Selection, dropout: &'static Card, delayed: &Card, share: f64) -> (Vec<f64>, Vec<usize>) {
    let mut x = selection.point.x.clone();
    let mut free = selection.point.free.clone();
    // A delay that lost commands account for is none.
    let explained = |a: &Added| a.card.id == delayed.id && x[at(a.card)] < LOST_DELAY.get() * share * CONTROL_S;
    let gone: Vec<Added> =
        selection.added.iter().filter(|a| explained(a) || a.card.id == dropout.id).cloned().collect();
    for a in &gone {
        span(a.card).for_each(|k| x[k] = 0.0);
        free.retain(|k| !span(a.card).contains(k));
        selection.added.retain(|other| other.card.id != a.card.id);
    }
    selection.added.push(Added { card: dropout, ties: Vec::new() });
    // Counted, not fitted: its mean is a delay that the time constants take up.
    x[at(dropout)] = share;
    (x, free)
}

/// The same where lost commands, added as number `i`, are none: their mean is there, their variance is not. The rival
/// that has the same mean takes their place.
fn not_lost(selection: &mut Selection, i: usize, delayed: &'static Card) -> (Vec<f64>, Vec<usize>) {
    let mut x = selection.point.x.clone();
    let mut free = selection.point.free.clone();
    let Added { card: dropout, ties } = selection.added.remove(i);
    let mean = std::mem::take(&mut x[at(dropout)]) * CONTROL_S;
    free.retain(|k| *k != at(dropout));
    let other = ties.first().copied().unwrap_or(delayed);
    if selection.added.iter().all(|a| a.card.id != other.id) {
        x[at(other)] = mean;
        free.extend(span(other));
        selection.added.insert(i, Added { card: other, ties: Vec::new() });
    }
    (x, free)
}
