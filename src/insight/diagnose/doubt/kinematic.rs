//! Sensors answer to kinematics: what attitude and velocity, against the integrated gyro and accelerometer, say of a
//! sensor's error without any model of the vehicle.

use crate::insight::criteria::unseen::{KINEMATIC_DEVIATIONS, KINEMATIC_SHARE};
use crate::insight::diagnose::agreement::kinematic;
use crate::insight::diagnose::fitted::FittedSelection;
use crate::insight::diagnose::numbers::span;
use crate::insight::diagnose::problem::ChannelValues;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::jackknife::jackknife;
use crate::model::effects::{self, Card, EffectKind, ResidualChannel};
use nalgebra::DVector;

/// Effects of sensors that the fit holds and that kinematics by themselves do not show.
pub fn missing(fitted: &FittedSelection) -> Vec<&'static Card> {
    let (problem, point) = (fitted.problem, fitted.point());
    let seen = |card: &Card| [ResidualChannel::Turn, ResidualChannel::Push].iter().any(|c| card.channels.contains(c));
    let sensed = |card: &&Card| card.kind == EffectKind::Sensor && seen(card);
    let cards: Vec<&'static Card> = effects::cards().filter(sensed).collect();
    let numbers: Vec<usize> = cards.iter().flat_map(|card| span(card)).collect();
    let places: Vec<usize> = (0..point.free.len()).filter(|&i| numbers.contains(&point.free[i])).collect();
    let residual = kinematic(&fitted.selection.whitener.apply(&point.residual, &problem.rows));
    let columns: Vec<ChannelValues> = places.iter().map(|&i| kinematic(&point.white[i])).collect();
    let all: Vec<&ChannelValues> = columns.iter().chain([&residual]).collect();
    let grams = Grams::new(&all, &problem.rows, problem.blocks);
    let n = places.len();
    let own: Vec<usize> = (0..n).collect();
    let prior: Vec<f64> = places.iter().map(|&i| problem.model.numbers[point.free[i]].trust.powi(-2)).collect();
    let square = Grams::pick(&grams.sum, &own, &own);
    let Some(inner) = crate::insight::estimate::inverse::inverse(&square, &prior) else { return Vec::new() };
    let Some((covariance, _)) = jackknife(&grams, &own, n, &prior, 1) else { return Vec::new() };
    let moved = inner * Grams::pick(&grams.sum, &own, &[n]);
    let unshown = |card: &&&'static Card| {
        let mine: Vec<usize> = (0..n).filter(|&i| span(card).contains(&point.free[places[i]])).collect();
        let size = DVector::from_iterator(mine.len(), mine.iter().map(|&i| point.x[point.free[places[i]]]));
        let square = size.norm_squared();
        if square == 0.0 {
            return false;
        }
        // Of the fitted size, along itself, what kinematics make of it.
        let along: f64 = mine.iter().zip(size.iter()).map(|(&i, s)| (s + moved[(i, 0)]) * s).sum();
        let spread = Grams::pick(&covariance, &mine, &mine);
        let sd = (size.transpose() * spread * &size)[(0, 0)].max(0.0).sqrt() / square;
        along / square + KINEMATIC_DEVIATIONS.get() * sd < KINEMATIC_SHARE.get()
    };
    cards.iter().filter(unshown).copied().collect()
}
