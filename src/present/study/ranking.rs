//! Which setting is best, and how sure its seeds make that.

use super::summary::CONFIDENCE;
use crate::base::rng::{Philox, RngStream, Sequence};
use crate::base::stats;
use rand::RngExt;
use serde::Serialize;
use std::cmp::Ordering;

/// Times that the seeds are drawn again.
const DRAWS: usize = 10_000;
/// In words, for whoever reads the table.
pub const METHOD: &str = "Score of a run: fixed-start lap completion of its best snapshot; between settings that \
complete equally many, the median lap time, then the gates passed. Settings are ordered by the means of their runs. \
Uncertainty over seeds: bootstrap, 10000 draws. Each draw takes as many runs of each setting as it has, with \
replacement, and widens their mean's distance from the setting's mean by sqrt(n / (n - 1)), which corrects the \
variance of n draws; settings are then ranked, equal ones sharing their places. Given are the share of draws in which \
a setting is best (shared likewise), and the interval that holds its rank in 95 % of draws. A setting with a single \
run is drawn without uncertainty, and nothing is given where all have one.";

/// What decides, larger for the better: fixed-start lap completion of a run, less median lap time, mean number of
/// gates.
pub type RunScore = [f64; 3];

/// Lap time of a run that completes no lap, s: longer than any, and still a number to take means of.
pub const NO_LAP_S: f64 = 1e3;

/// What is ranked.
pub struct Scored {
    pub name: String,
    pub scores: Vec<RunScore>,
}

/// A setting's place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranked {
    /// Counted from 1.
    pub rank: usize,
    pub setting: String,
    pub runs: usize,
    pub score: f64,
    /// Probability of being the best, 0..1, and 95 % interval of the rank; none without repeated seeds.
    pub best: Option<f64>,
    pub ranks: Option<[f64; 2]>,
}

/// The settings in order, best first; of equals by name. Settings without a run are left out.
pub fn ranking(mut settings: Vec<Scored>) -> Vec<Ranked> {
    settings.retain(|setting| !setting.scores.is_empty());
    settings.sort_by(|a, b| order(&mean(&b.scores), &mean(&a.scores)).then(a.name.cmp(&b.name)));
    let repeated = settings.len() > 1 && settings.iter().any(|setting| setting.scores.len() > 1);
    let (mut best, mut ranks) = (vec![0.0; settings.len()], vec![Vec::new(); settings.len()]);
    if repeated {
        // A fixed seed: the same runs always give the same table.
        let rng = Philox::new(0);
        for draw in 0..DRAWS {
            let mut rng = rng.sequence(RngStream::Bootstrap, draw as u32, 0);
            let means: Vec<RunScore> = settings.iter().map(|setting| drawn(&mut rng, &setting.scores)).collect();
            for (i, place) in places(&means).into_iter().enumerate() {
                ranks[i].push(place.rank);
                best[i] += place.best / DRAWS as f64;
            }
        }
    }
    let tail = 0.5 - 0.5 * CONFIDENCE;
    // Shared places are whole or half numbers, and so are their quantiles.
    let quantile = |ranks: &[f64], q: f64| (2.0 * stats::quantile(ranks, q)).round() / 2.0;
    let ranked = settings.iter().zip(best).zip(ranks).enumerate().map(|(i, ((setting, best), ranks))| Ranked {
        rank: i + 1,
        setting: setting.name.clone(),
        runs: setting.scores.len(),
        score: mean(&setting.scores)[0],
        best: repeated.then_some(best),
        ranks: repeated.then(|| [tail, 1.0 - tail].map(|q| quantile(&ranks, q))),
    });
    ranked.collect()
}

fn mean(scores: &[RunScore]) -> RunScore {
    [0, 1, 2].map(|k| stats::mean(&scores.iter().map(|score| score[k]).collect::<Vec<_>>()))
}

/// Greater for the better one. Sums in another order may differ in the last digits and mean the same.
fn order(a: &RunScore, b: &RunScore) -> Ordering {
    const SAME: f64 = 1e-12;
    let unequal = a.iter().zip(b).find(|(a, b)| (**a - **b).abs() > SAME);
    unequal.map_or(Ordering::Equal, |(a, b)| a.total_cmp(b))
}

/// Mean of as many scores drawn with replacement, its distance from their mean corrected for their number.
fn drawn(rng: &mut Sequence, scores: &[RunScore]) -> RunScore {
    let n = scores.len();
    let middle = mean(scores);
    if n < 2 {
        return middle;
    }
    let drawn = mean(&(0..n).map(|_| scores[rng.random_range(0..n)]).collect::<Vec<_>>());
    let wider = (n as f64 / (n - 1) as f64).sqrt();
    [0, 1, 2].map(|k| middle[k] + wider * (drawn[k] - middle[k]))
}

/// A place in one draw: the middle of those that equals share, and the share of being first.
struct SharedRank {
    rank: f64,
    best: f64,
}

fn places(means: &[RunScore]) -> Vec<SharedRank> {
    let place = |mean: &RunScore| {
        let count = |wanted: Ordering| means.iter().filter(|other| order(other, mean) == wanted).count();
        let (above, equal) = (count(Ordering::Greater), count(Ordering::Equal));
        let best = if above == 0 { 1.0 / equal as f64 } else { 0.0 };
        SharedRank { rank: above as f64 + 0.5 * (equal as f64 + 1.0), best }
    };
    means.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(name: &str, scores: &[f64]) -> Scored {
        Scored { name: name.into(), scores: scores.iter().map(|&score| [score, -8.0, 1.0]).collect() }
    }

    #[test]
    fn what_is_clear_and_what_is_not() {
        let clear =
            ranking(vec![scored("low", &[0.1, 0.12, 0.11]), scored("high", &[0.9, 0.92, 0.91]), scored("none", &[])]);
        assert_eq!(clear.iter().map(|r| r.setting.as_str()).collect::<Vec<_>>(), ["high", "low"]);
        assert!((clear[0].best.unwrap() - 1.0).abs() < 1e-6 && clear[1].ranks == Some([2.0, 2.0]));
        let alike = ranking(vec![scored("b", &[0.4, 0.6, 0.5, 0.5]), scored("a", &[0.6, 0.4, 0.5, 0.5])]);
        assert_eq!(alike[0].setting, "a");
        assert!((alike[0].best.unwrap() - 0.5).abs() < 0.02 && alike[0].ranks == Some([1.0, 2.0]), "{alike:?}");
    }

    #[test]
    fn gates_decide_where_nobody_laps() {
        let scored = |name: &str, gates: [f64; 2]| Scored {
            name: name.into(),
            scores: gates.map(|g| [0.0, -NO_LAP_S, g]).into(),
        };
        let ranking = ranking(vec![scored("a", [1.0, 2.0]), scored("b", [5.0, 6.0])]);
        assert!(ranking[0].setting == "b" && ranking[0].best > Some(0.999) && ranking[1].ranks == Some([2.0, 2.0]));
    }

    #[test]
    fn equal_settings_share_and_single_runs_tell_nothing() {
        let equal = ranking(vec![scored("a", &[1.0, 1.0]), scored("b", &[1.0, 1.0])]);
        assert!(equal.iter().all(|r| (r.best.unwrap() - 0.5).abs() < 1e-6 && r.ranks == Some([1.5, 1.5])));
        let single = ranking(vec![scored("a", &[0.2]), scored("b", &[0.3])]);
        assert!(single[0].setting == "b" && single.iter().all(|r| r.best.is_none() && r.ranks.is_none()));
    }
}
