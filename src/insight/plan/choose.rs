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
    let told =
        |counts: &[f64]| -> Vec<bool> { pairs.par_iter().map(|pair| pair.planned(counts) >= pair.wanted).collect() };
    let tells = told(&counts);
    // What was useful at first may not be needed beside what came later.
    for place in 0..kinds.len() {
        while counts[place] > always[place] {
            counts[place] -= 1.0;
            if told(&counts) != tells {
                counts[place] += 1.0;
                break;
            }
        }
    }
    if counts == always && !tells.contains(&true) {
        counts.fill(0.0);
    }
    Choice { tells, seconds: length(&counts), counts }
}
