//! A motor or propeller that gives less than the others. Behind a flight controller's integrator the rates hardly show
//! it; what the motors are driven with does: over seconds their thrusts are in balance, so that one of four is driven
//! harder than the rest. A centre of mass that is off drives two of them harder.

use crate::base::stats::{NORMAL_95, mean, mean_half_width, median};
use crate::flight::spans::{Span, contain};
use crate::flight::{Log, MOTORS, Stream};
use crate::insight::criteria::evident::SURE_DEVIATIONS;
use crate::insight::criteria::material::WEAK_MOTOR;
use crate::insight::criteria::rival::ALONE_SHARE;
use crate::insight::diagnose::motor_loop::FOUR;
use crate::insight::prepare::rotors::columns;

/// Thrusts are in balance over this time, s.
const BALANCE_S: f64 = 2.0;
/// Such times that are taken for independent of each other, together.
const GROUP: usize = 3;

/// The square of what each motor is driven with, over the mean of all four.
pub type Driven = [f64; FOUR];

/// What the motors of a log are driven with, each two seconds of its `usable` flight: rotor speeds, else the motors'
/// commands; nothing where it has neither, or not of four.
pub fn driven(log: &Log, usable: &[Span]) -> Vec<Driven> {
    of(&log.rotors, usable).or_else(|| of(&log.motors, usable)).unwrap_or_default()
}

fn of(stream: &Stream<MOTORS>, usable: &[Span]) -> Option<Vec<Driven>> {
    let columns = columns(stream).filter(|columns| columns.len() == FOUR)?;
    let mut out = Vec::new();
    let mut from = 0;
    while from < stream.len() {
        let end = stream.time_s[from] + BALANCE_S;
        let to = stream.time_s.partition_point(|t| *t < end);
        let flown = (from..to).all(|i| contain(usable, stream.time_s[i]));
        let squares: [f64; FOUR] =
            std::array::from_fn(|k| mean(&columns[k][from..to].iter().map(|u| u * u).collect::<Vec<_>>()));
        let whole = mean(&squares);
        if flown && whole > 0.0 && squares.iter().all(|s| s.is_finite()) {
            out.push(squares.map(|s| s / whole));
        }
        from = to;
    }
    Some(out)
}

/// A motor that gives less than the other three.
#[derive(Clone, Copy, Debug)]
pub struct Weak {
    /// Counted from 0 in the order of the log.
    pub motor: usize,
    /// Share of its thrust that it lacks, and half of the 95 % interval.
    pub loss: f64,
    pub half: f64,
}

/// The motor that is driven harder than `usual` while the other three are not; none where no single one is, beyond
/// chance and by more than motors differ anyway.
pub fn weak(driven: &[Driven], usual: Driven) -> Option<Weak> {
    let relative: Vec<Driven> = driven.iter().map(|d| std::array::from_fn(|k| d[k] / usual[k])).collect();
    let whole = middle(&relative)?;
    let off: Driven = whole.map(|m| m - mean(&whole));
    let motor = (0..FOUR).max_by(|a, b| off[*a].total_cmp(&off[*b]))?;
    // One motor alone is off by so much, and the others by a third of it the other way.
    let alone = off[motor].powi(2) / (0.75 * off.iter().map(|o| o * o).sum::<f64>()).max(1e-300);
    let lacks = |d: &Driven| 1.0 - (d.iter().sum::<f64>() - d[motor]) / (FOUR - 1) as f64 / d[motor];
    let groups: Vec<f64> = relative.chunks(GROUP).filter_map(middle).map(|d| lacks(&d)).collect();
    let loss = lacks(&whole);
    let half = mean_half_width(&groups, 0.95)?;
    let sure = loss > SURE_DEVIATIONS.get() * half / NORMAL_95;
    (sure && alone > ALONE_SHARE.get() && loss > WEAK_MOTOR.get()).then_some(Weak { motor, loss, half })
}

/// What each motor is usually driven with.
pub fn middle(driven: &[Driven]) -> Option<Driven> {
    let of = |k: usize| median(&driven.iter().map(|d| d[k]).collect::<Vec<_>>());
    (!driven.is_empty()).then(|| std::array::from_fn(of))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two minutes in which each motor differs a little from moment to moment.
    fn flown(middle: Driven) -> Vec<Driven> {
        let wave = |i: usize, k: usize| 1.0 + 0.03 * ((i * (7 + k)) as f64).sin();
        (0..60).map(|i| std::array::from_fn(|k| middle[k] * wave(i, k))).collect()
    }

    #[test]
    fn one_of_four_is_weak_and_two_are_a_mass_that_is_off() {
        let third = weak(&flown([0.97, 0.97, 1.09, 0.97]), [1.0; 4]).expect("a weak motor");
        assert!(third.motor == 2 && (third.loss - 0.11).abs() < 0.02, "{third:?}");
        assert!(weak(&flown([0.95, 1.05, 0.95, 1.05]), [1.0; 4]).is_none());
        assert!(weak(&flown([1.0; 4]), [1.0; 4]).is_none());
        assert!(weak(&flown([0.97, 0.97, 1.09, 0.97]), [0.97, 0.97, 1.09, 0.97]).is_none(), "as usual");
    }
}
