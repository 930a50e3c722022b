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

/// Chooses among `kinds`; take-off and landing last `around_s`, all together at most `longest_s`.
pub fn choose(pairs: &[CausePair], kinds: &[FlownKind], around_s: f64, longest_s: f64) -> Choice {
    let hopeful: Vec<&CausePair> = pairs.par_iter().filter(|pair| pair.is_ever_told(kinds.len())).collect();
    let always: Vec<f64> = kinds.iter().map(|kind| f64::from(u8::from(kind.kind == ALWAYS))).collect();
    let mut counts = always.clone();
    let length = |counts: &[f64]| around_s + counts.iter().zip(kinds).map(|(n, kind)| n * kind.seconds).sum::<f64>();
    loop {
        let open: Vec<(&CausePair, f64)> = hopeful.iter().map(|pair| (*pair, pair.planned(&counts))).collect();
        let open: Vec<(&CausePair, f64)> = open.into_iter().filter(|(pair, now)| *now < pair.wanted).collect();
        let one = |place: usize| {
            let mut more = counts.clone();
            more[place] += 1.0;
            // Each pair counts by the share of what it lacks.
            let brought = open.iter().map(|(pair, now)| (pair.planned(&more).min(pair.wanted) - now) / pair.wanted);
            (place, brought.sum::<f64>() / kinds[place].seconds)
        };
        let affordable = |place: &usize| length(&counts) + kinds[*place].seconds <= longest_s;
        let all: Vec<usize> = (0..kinds.len()).filter(affordable).collect();
        let best = all.into_par_iter().map(one).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        match best {
            Some((place, brought)) if brought * kinds[place].seconds > WORTH_FLYING.get() => counts[place] += 1.0,
            _ => break,
        }
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
