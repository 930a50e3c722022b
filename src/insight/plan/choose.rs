//! The shortest flight that tells every pair that can be told: manoeuvres are added by what they bring a second, and
//! taken away again where all stays told.

use super::pair::CausePair;
use super::simulate::FlownKind;
use crate::flight::pilot::Manoeuvre;
use crate::insight::criteria::planned::WORTH_FLYING;
use rayon::prelude::*;

/// How often each kind is flown.
pub struct Choice {
    pub counts: Vec<f64>,
    /// Whether the flight tells each pair.
    pub tells: Vec<bool>,
    /// Length with take-off and landing, s.
    pub seconds: f64,
}

/// What every plan has: where nothing goes any way over ground, the check of the log cannot tell the velocity's frame.
const ALWAYS: Manoeuvre = Manoeuvre::Circle;

/// So many of a kind are tried at once: a single one that tells much outweighs all others, and makes the sum less sure.
const TIMES: [f64; 3] = [1.0, 4.0, 12.0];

/// Chooses among `kinds`; take-off and landing last `around_s`, all together at most `longest_s`.
pub fn choose(pairs: &[CausePair], kinds: &[FlownKind], around_s: f64, longest_s: f64) -> Choice {
    let hopeful: Vec<&CausePair> = pairs.par_iter().filter(|pair| pair.is_ever_told(kinds.len())).collect();
    let always: Vec<f64> = kinds.iter().map(|kind| f64::from(u8::from(kind.kind == ALWAYS))).collect();
    let mut counts = always.clone();
    let length = |counts: &[f64]| around_s + counts.iter().zip(kinds).map(|(n, kind)| n * kind.seconds).sum::<f64>();
    loop {
        let open: Vec<(&CausePair, f64)> = hopeful.iter().map(|pair| (*pair, pair.planned(&counts))).collect();
        let open: Vec<(&CausePair, f64)> = open.into_iter().filter(|(pair, now)| *now < pair.wanted).collect();
        let one = |(place, times): (usize, f64)| {
            let mut more = counts.clone();
            more[place] += times;
            // Each pair counts by the share of what it lacks.
            let brought = open.iter().map(|(pair, now)| (pair.planned(&more).min(pair.wanted) - now) / pair.wanted);
            (place, times, brought.sum::<f64>() / times)
        };
        let affordable = |(place, times): &(usize, f64)| length(&counts) + times * kinds[*place].seconds <= longest_s;
        let all: Vec<(usize, f64)> = (0..kinds.len()).flat_map(|place| TIMES.map(|times| (place, times))).collect();
        let tried = all.into_par_iter().filter(affordable).map(one).filter(|(.., each)| *each > WORTH_FLYING.get());
        let rate = |(place, _, each): &(usize, f64, f64)| each / kinds[*place].seconds;
        let best = tried.max_by(|a, b| rate(a).total_cmp(&rate(b)).then(b.0.cmp(&a.0)).then(b.1.total_cmp(&a.1)));
        let Some((place, times, _)) = best else { break };
        counts[place] += times;
    }
    // What was useful at first may not be needed beside what came later; what one flight tells in part is worth it too.
    let least = |pair: &CausePair| match pair.planned(&counts) {
        told if told >= pair.wanted => pair.wanted,
        part => part - WORTH_FLYING.get() * pair.wanted,
    };
    let least: Vec<f64> = hopeful.par_iter().map(|pair| least(pair)).collect();
    let keeps = |counts: &[f64]| hopeful.par_iter().zip(&least).all(|(pair, least)| pair.planned(counts) >= *least);
    for place in 0..kinds.len() {
        while counts[place] > always[place] {
            counts[place] -= 1.0;
            if !keeps(&counts) {
                counts[place] += 1.0;
                break;
            }
        }
    }
    let tells: Vec<bool> = pairs.par_iter().map(|pair| pair.planned(&counts) >= pair.wanted).collect();
    if counts == always && !tells.contains(&true) {
        counts.fill(0.0);
    }
    Choice { tells, seconds: length(&counts), counts }
}

#[cfg(test)]
mod tests {
    use super::super::pair::{Stretches, Way};
    use super::*;
    use nalgebra::DMatrix;

    /// Two causes that the dive tells apart, by some standard deviations each time, and the circle does not.
    fn pair(wanted: f64) -> CausePair {
        let alike = DMatrix::from_element(2, 2, 20.0);
        let apart = DMatrix::from_diagonal_element(2, 2, 20.0);
        let of = |gram: &DMatrix<f64>, n: usize| Stretches::new(vec![gram.clone(); n], 2);
        let kinds = vec![(of(&alike, 2), 1.0), (of(&apart, 2), 1.0)];
        let (known, around) = (of(&alike, 20), Stretches::new(Vec::new(), 2));
        let way = Way { prior: vec![1e-6], noise: 4.0, known, around, kinds };
        CausePair { causes: [0, 1], wanted, ways: vec![way] }
    }

    fn chosen(wanted: f64, longest_s: f64) -> Choice {
        let kinds = [ALWAYS, Manoeuvre::Dive].map(|kind| FlownKind { kind, times: 1, seconds: 8.0 });
        choose(&[pair(wanted)], &kinds, 20.0, longest_s)
    }

    #[test]
    fn no_more_is_flown_than_tells_and_what_is_told_in_part_is_flown() {
        let whole = chosen(3.0, 300.0);
        assert!(whole.tells == [true] && whole.counts[1] > 0.0, "{:?}", whole.counts);
        let less = [1.0, whole.counts[1] - 1.0];
        assert!(pair(3.0).planned(&less) < 3.0, "{:?}", whole.counts);
        // A shorter pack does not carry it: what it carries is not taken away again.
        let part = chosen(3.0, whole.seconds - 8.0);
        assert!(part.tells == [false] && part.counts[1] > 0.0, "{:?}", part.counts);
    }
}
