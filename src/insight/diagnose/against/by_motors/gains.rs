//! Other gains of the flight controller's rate loop, by what it sends to the motors. The rates themselves hardly show
//! them: motors that are slow, or at an end of their range, turn the vehicle as they can.

use super::moved::{Moved, Words, change, sure};
use crate::insight::criteria::changed::{
    CHANGED_GAIN, GAIN_ANSWERED, GAIN_DEVIATIONS, GAIN_ERROR, GAIN_TURNED, GAINS_APART, GAINS_DEVIATIONS,
    SAME_AUTHORITY, SAME_LAG, SAME_LOOP_DELAY_S,
};
use crate::insight::diagnose::against::change::Change;
use crate::insight::diagnose::motor_loop::{AXES, MotorLoop, RateGain};

/// The compact model's number that follows from these gains.
const RESPONSE: &str = "rate_response";

/// What changed of the gains, in the place of the response of roll and pitch in `changes`. Yaw's stays: its gains are
/// not looked at.
pub fn replace_response(loops: &[MotorLoop; 2], changes: &mut Vec<Change>) {
    let Some(gains) = changed(loops) else { return };
    let response = changes.extract_if(.., |c| c.cause == RESPONSE);
    let impact = response.filter_map(|c| c.impact).last();
    changes.push(Change { impact, ..gains });
}

/// Gains of roll and pitch that both moved one way, where nothing else of the loop did.
fn changed(loops: &[MotorLoop; 2]) -> Option<Change> {
    let [before, after] = [loops[0].gains?, loops[1].gains?];
    let pairs: [[RateGain; 2]; AXES] = [0, 1].map(|k| [before[k], after[k]]);
    let moved: [Moved; AXES] = [0, 1].map(|k| (k, pairs[k].map(|g| (g.gain, error(&g)))));
    if !(one_way(&moved) && (0..AXES).all(|k| told(loops, &pairs[k], k))) {
        return None;
    }
    let words = Words {
        cause: "rate_gains",
        name: "gains of the rate loop",
        members: vec!["rate_gains"],
        sentence: "the flight controller answers an error of roll and pitch with more or less: its gains",
        number: ("gain", "of a full output, per rad/s"),
    };
    Some(change(words, &moved))
}

/// Whether the gains moved by one share, as far as they tell, that is evident and matters. What else moves a gain that
/// is read from outputs seldom moves that of the other axis alike.
fn one_way(moved: &[Moved; AXES]) -> bool {
    let by = moved.map(|(_, [before, after])| (after.0 / before.0).ln());
    let weights = [0, 1].map(|k| (sure(&moved[k]) / by[k]).powi(2));
    let known: f64 = weights.iter().sum();
    let mean = (by[0] * weights[0] + by[1] * weights[1]) / known;
    let apart = (by[0] - by[1]) / weights.iter().map(|w| 1.0 / w).sum::<f64>().sqrt();
    by[0] * by[1] > 0.0
        && moved.iter().all(|m| sure(m).abs() > GAIN_DEVIATIONS.get())
        && apart.abs() < GAINS_APART.get()
        && mean.abs() > (1.0 + CHANGED_GAIN.get()).ln()
        && mean.abs() * known.sqrt() > GAINS_DEVIATIONS.get()
}

/// Standard deviation of a gain, with what the spread over the time of a flight does not show.
fn error(g: &RateGain) -> f64 {
    g.sd.hypot(GAIN_ERROR.get() * g.gain)
}

/// Whether both sets tell the gain, and have the same vehicle and the same delay about it: where another authority,
/// other motors or another filter are at work the outputs are others with the same gains.
fn told(loops: &[MotorLoop; 2], gains: &[RateGain; 2], k: usize) -> bool {
    let plants = [loops[0].plants[k], loops[1].plants[k]];
    let same = |[x, y]: [f64; 2], within: f64| (x / y).ln().abs() < (1.0 + within).ln();
    plants.iter().all(|p| p.turned > GAIN_TURNED.get())
        && gains.iter().all(|g| g.answered > GAIN_ANSWERED.get())
        && same(plants.map(|p| p.authority), SAME_AUTHORITY.get())
        && same(plants.map(|p| p.lag_s), SAME_LAG.get())
        && (gains[0].delay_s - gains[1].delay_s).abs() < SAME_LOOP_DELAY_S.get()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::insight::diagnose::motor_loop::TurningPlant;

    /// With these gains of roll and pitch.
    fn set(gains: [f64; AXES]) -> MotorLoop {
        let plant = TurningPlant { pattern: 0, lag_s: 0.03, authority: 400.0, sd: 4.0, turned: 0.98 };
        let gains = gains.map(|gain| RateGain { gain, sd: 0.003, delay_s: 0.0, answered: 0.99 });
        MotorLoop { plants: [plant; 3], gains: Some(gains), volts: 24.0 }
    }

    fn after(change: impl Fn(&mut TurningPlant, &mut RateGain)) -> MotorLoop {
        let mut set = set([0.09, 0.08]);
        change(&mut set.plants[0], &mut set.gains.as_mut().expect("gains")[0]);
        set
    }

    #[test]
    fn named_where_both_axes_say_it_and_the_vehicle_is_the_same() {
        let before = || set([0.15, 0.13]);
        let found = changed(&[before(), set([0.09, 0.08])]).expect("gains");
        assert!((found.difference["gain.roll"].value + 0.06).abs() < 1e-12 && found.deviations > 7.0, "{found:?}");
        assert!(changed(&[before(), set([0.11, 0.095])]).is_some(), "28 % of both");
        assert!(changed(&[before(), set([0.125, 0.11])]).is_none(), "17 % of both");
        assert!(changed(&[before(), set([0.09, 0.12])]).is_none(), "one axis alone");
        assert!(changed(&[before(), set([0.09, 0.2])]).is_none(), "one up, one down");
        for other in [
            after(|plant, _| plant.authority = 300.0),
            after(|plant, _| plant.lag_s = 0.02),
            after(|plant, _| plant.turned = 0.5),
            after(|_, gain| gain.delay_s = 0.008),
            after(|_, gain| gain.answered = 0.9),
            after(|_, gain| gain.sd = 0.08),
        ] {
            assert!(changed(&[before(), other.clone()]).is_none(), "{other:?}");
        }
    }
}
