//! In how many stretches of flight an effect shows.

use crate::insight::criteria::evident::SURE_DEVIATIONS;
use crate::insight::criteria::replicated::{
    AGREEING_STRETCHES, GROUND_VISITS, RARE_DEVIATIONS, RARE_SHARE, RARE_STRETCHES, STRETCH_DEVIATIONS,
    UNANIMOUS_SHARE, VISITS_APART,
};
use crate::insight::diagnose::fitting::score::score;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::effects::Card;
use nalgebra::DVector;

/// How often an effect was seen, and how many standard deviations its size is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Replicated {
    pub count: f64,
    /// Stretches that show it by themselves, and their share of the information.
    alone: f64,
    held: f64,
    sure: f64,
    /// Times that it was visited, where it goes with the height: a visit's errors are its own.
    visits: usize,
}

impl Replicated {
    /// Whether many stretches of flight agree.
    pub fn agreed(&self) -> bool {
        self.count >= AGREEING_STRETCHES.get()
    }

    /// Whether nearly all that tells it agrees, be it of a size that differs: over the ground, with the height's error.
    pub fn unanimous(&self) -> bool {
        self.agreed() && self.held >= UNANIMOUS_SHARE.get() && self.sized()
    }

    /// Whether its size is told, be it within a factor.
    pub fn sized(&self) -> bool {
        self.sure >= STRETCH_DEVIATIONS.get()
    }

    /// Whether it is no more than a chance of many.
    pub fn weak(&self) -> bool {
        !self.evident() && (!self.agreed() || !self.sized())
    }

    pub fn evident(&self) -> bool {
        let rarely =
            self.alone >= RARE_STRETCHES.get() && self.held >= RARE_SHARE.get() && self.sure >= RARE_DEVIATIONS.get();
        let visited = self.visits as f64 >= GROUND_VISITS.get() && self.agreed() && self.held >= UNANIMOUS_SHARE.get();
        self.agreed() && self.sure >= SURE_DEVIATIONS.get() || rarely || visited
    }
}

/// How many stretches of flight agree on the effect. Either all do a little (the robust score of leaving it out counts
/// them), or a few do by themselves, beyond two standard deviations, less those that contradict; with how sure all
/// together are.
pub fn stretches(fitted: &FittedSelection, card: &Card) -> Replicated {
    let own = fitted.places(card);
    if own.is_empty() {
        return Replicated::default();
    }
    let n = fitted.point().free.len();
    let rest = fitted.rest(&own);
    // The residual as it was without the effect.
    let mut grams = fitted.grams.clone();
    let sizes: Vec<(usize, f64)> = own.iter().map(|&i| (i, fitted.point().x[fitted.point().free[i]])).collect();
    for gram in grams.blocks.iter_mut().chain([&mut grams.sum]) {
        for &(i, size) in &sizes {
            for j in 0..=n {
                let along = gram[(i, j)] * size;
                gram[(n, j)] += along;
            }
            for j in 0..=n {
                let along = gram[(j, i)] * size;
                gram[(j, n)] += along;
            }
        }
    }
    let Some(score) = score(&grams, &rest, &own, n, &vec![0.0; n + 1]) else { return Replicated::default() };
    let size = DVector::from_iterator(own.len(), sizes.iter().map(|(_, size)| *size));
    let shows = STRETCH_DEVIATIONS.get();
    let (mut alone, mut held, mut all): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let mut shown: Vec<usize> = Vec::new();
    for (at, block) in score.blocks.iter().enumerate() {
        // Along the fitted direction: what this stretch alone makes of its size, in standard deviations.
        let (left, right) = block;
        let information = (size.transpose() * left * &size)[(0, 0)].max(1e-12);
        let agrees = size.dot(&right.column(0)) / information.sqrt();
        all += information;
        if agrees > shows {
            (alone, held) = (alone + 1.0, held + information);
            shown.push(at);
        } else if agrees < -shows {
            (alone, held) = (alone - 1.0, held - information);
        }
    }
    let covariance = Grams::pick(&fitted.covariance, &own, &own);
    let sure = inverse(&covariance, &vec![0.0; own.len()]).map_or(0.0, |c| (size.transpose() * c * &size)[(0, 0)]);
    let apart = shown.windows(2).filter(|pair| (pair[1] - pair[0]) as f64 > VISITS_APART.get()).count();
    let visits = if card.by_height && !shown.is_empty() { 1 + apart } else { 0 };
    let count = alone.max(score.evidence / own.len() as f64);
    Replicated { count, alone, held: held / all, sure: sure.max(0.0).sqrt(), visits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nearly_all_stretches_show_needs_no_sure_size() {
        // Two hovers near the ground, of twice the size the one as the other.
        let hovers = Replicated { count: 48.0, alone: 48.0, held: 0.93, sure: 3.4, visits: 0 };
        assert!(hovers.unanimous() && !hovers.evident());
        for not in [
            Replicated { held: 0.7, ..hovers },
            Replicated { sure: 1.6, ..hovers },
            Replicated { count: 8.0, alone: 8.0, ..hovers },
        ] {
            assert!(!not.unanimous(), "{not:?}");
        }
        assert!(Replicated { visits: 2, sure: 1.2, ..hovers }.evident(), "both hovers show it");
        assert!(
            !Replicated { visits: 1, ..hovers }.evident() && !Replicated { visits: 2, held: 0.7, ..hovers }.evident()
        );
    }
}
