//! What flights could show of an effect, whatever they do show.

use super::candidates::Candidate;
use super::rank::Ranking;
use crate::insight::criteria::evident::SURE_DEVIATIONS;
use crate::insight::criteria::flown::{ABSORBED_SHARE, SEEN_DEVIATIONS};
use crate::insight::criteria::planned::PLANNED_MARGIN;
use crate::insight::criteria::replicated::{
    AGREEING_STRETCHES, RARE_DEVIATIONS, RARE_SHARE, RARE_STRETCHES, STRETCH_DEVIATIONS,
};
use crate::insight::diagnose::fitting::score::ScoreTest;
use crate::model::effects::Card;

/// What flights could show of an effect beside what is fitted.
#[derive(Clone, Debug)]
pub struct Reach {
    pub card: &'static Card,
    /// Size of its main parameter from which it would be evident in nine of ten flights.
    pub smallest: f64,
    /// Share of the information on it that what is fitted leaves.
    pub kept: f64,
    /// The rival most like it, and how much (correlation of what is left).
    pub nearest: Option<(&'static str, f64)>,
    /// Whether it would show beside the base alone: then it is what was found that takes it up.
    pub behind: bool,
}

impl Reach {
    /// Whether what is fitted takes it up.
    pub fn absorbed(&self) -> bool {
        self.kept < ABSORBED_SHARE.get()
    }

    /// Whether no usual size of it would show.
    pub fn beyond(&self) -> bool {
        self.absorbed() || self.smallest > self.card.parameters[0].typical[1]
    }

    /// What flights could show beside the base becomes what they could beside all that was found, of what was not.
    pub fn renew(beside_base: &mut [Reach], beside_all: Vec<Reach>) {
        for last in beside_all {
            if let Some(first) = beside_base.iter_mut().find(|first| first.card.id == last.card.id) {
                *first = Reach { behind: last.beyond() && !first.beyond(), ..last };
            }
        }
    }
}

/// What the flights could show of each effect of `found`, which are ranked.
pub fn reach(ranking: &Ranking, found: &[Candidate]) -> Vec<Reach> {
    let mut all: Vec<Reach> = Vec::new();
    for (j, s) in ranking.scores.iter().enumerate() {
        let (Some(s), card) = (s, found[j].card()) else { continue };
        if all.iter().any(|r| r.card.id == card.id) {
            continue;
        }
        let near = |i: usize| {
            // Information on the first that the second leaves, as a share.
            let left = ranking.beside(j, i)?.information[0] / s.information[0];
            Some((found[i].card().id, (1.0 - left).clamp(0.0, 1.0).sqrt()))
        };
        let rivals = (0..found.len()).filter(|&i| card.rivals.contains(&found[i].card().id));
        let nearest = rivals.filter_map(near).max_by(|a, b| a.1.total_cmp(&b.1));
        let smallest = found[j].direction.start[0].1.abs() * smallest(s);
        let kept = s.information[0] / s.raw[0].max(1e-300);
        all.push(Reach { card, smallest, kept, nearest, behind: false });
    }
    all
}

/// The same of a direction, in its own size.
fn smallest(score: &ScoreTest) -> f64 {
    let (each, pulls): (Vec<f64>, Vec<f64>) = score.blocks.iter().map(|(i, u)| (i[(0, 0)], u[(0, 0)])).unzip();
    let all: f64 = each.iter().sum();
    let size = pulls.iter().sum::<f64>() / all.max(1e-300);
    let apart: f64 = pulls.iter().zip(&each).map(|(u, i)| (u - size * i).powi(2)).sum();
    evident_from(each, apart / all.max(1e-300))
}

/// Size from which an effect is evident, in nine of ten flights, of which each stretch of time has so much information
/// on a size of 1, where what stretches say of it spreads by `spread` times the variance of white noise.
fn evident_from(mut information: Vec<f64>, spread: f64) -> f64 {
    information.iter_mut().for_each(|i| *i = i.max(0.0));
    information.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = information.iter().sum();
    let deviations = |sizes: f64, information: f64| sizes / information.max(1e-300).sqrt();
    let spread = spread.max(1.0).sqrt();
    // Many stretches agree: so many by themselves, or all a little.
    let agreeing = AGREEING_STRETCHES.get();
    let alone = |count: f64| {
        information.get(count as usize - 1).map_or(f64::INFINITY, |i| deviations(STRETCH_DEVIATIONS.get(), *i))
    };
    let told = all * all / information.iter().map(|i| i * i).sum::<f64>().max(1e-300);
    let little = if told > agreeing {
        deviations(spread * (agreeing / (1.0 - agreeing / told)).sqrt(), all)
    } else {
        f64::INFINITY
    };
    let often = alone(agreeing).min(little).max(deviations(spread * SURE_DEVIATIONS.get(), all));
    // Or the few that hold what is told of it, and surely.
    let mut held = 0.0;
    let holding = information
        .iter()
        .take_while(|i| {
            held += **i;
            held - **i < RARE_SHARE.get() * all
        })
        .count();
    let few = (holding as f64).max(RARE_STRETCHES.get());
    let rarely = alone(few).max(deviations(spread * RARE_DEVIATIONS.get(), all));
    let evident = often.min(rarely).max(deviations(SEEN_DEVIATIONS.get(), all));
    evident + deviations(spread * PLANNED_MARGIN.get(), all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_few_stretches_tell_has_to_be_larger() {
        let even = |stretches: usize| evident_from(vec![100.0 / stretches as f64; stretches], 1.0);
        let deviations = |stretches| 10.0 * even(stretches) - PLANNED_MARGIN.get();
        assert!((deviations(100) - 5.0).abs() < 1e-9, "to be seen at all");
        assert!((deviations(20) - 7.75).abs() < 0.01, "fifteen of twenty: {}", deviations(20));
        assert!((deviations(4) - 6.0).abs() < 1e-9, "four that are rarely flown");
        assert!(even(3).is_infinite(), "three are none");
        assert!(evident_from(vec![1.0; 100], 4.0) > 1.5 * even(100), "where stretches differ");
    }
}
