//! What a training goes on from, and what ends it: numbers that are not finite.

use super::update::Losses;
use crate::learn::nn::Network;
use crate::learn::nn::adam::Adam;

/// A training between two iterations. Whatever goes on from it goes on bit for bit.
#[derive(Clone, Debug)]
pub struct TrainingState<S> {
    /// Iterations and environment steps done.
    pub iterations: usize,
    pub steps: u64,
    /// Seconds of the budget used.
    pub seconds: f64,
    /// Policies taken.
    pub snapshots: usize,
    /// Times that it has gone back.
    pub setbacks: u32,
    pub network: Network<f32>,
    /// The average of the last of them.
    pub average: Network<f32>,
    pub adam: Adam<f32>,
    /// The rows of a rollout in the order of the last shuffle, from which the next begins.
    pub order: Vec<u32>,
    /// 16 environments each.
    pub environments: Vec<S>,
}

/// Times that a training goes back before it gives up.
pub const MOST_SETBACKS: u32 = 3;
/// What a setback makes of the learning rate.
const SETBACK: f64 = 0.1;

/// Share of the configured learning rate after so many setbacks.
pub fn rate_after(setbacks: u32) -> f64 {
    SETBACK.powi(setbacks as i32)
}

/// A training that met a number that is not finite, and what is done about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Setback {
    /// What is not finite.
    pub what: &'static str,
    /// Environment steps when it was found, and those that it goes back to.
    pub steps: u64,
    pub back_to: u64,
    /// Times that it has gone back, this one included; beyond [`MOST_SETBACKS`] it has given up.
    pub times: u32,
}

impl Setback {
    /// Whether the training ends here.
    pub fn is_last(&self) -> bool {
        self.times > MOST_SETBACKS
    }
}

/// What is not finite after an iteration, if anything: one such number spreads to all others.
pub fn not_finite(losses: &Losses, network: &Network<f32>, adam: &Adam<f32>) -> Option<&'static str> {
    let all = |x: &[f32]| x.iter().all(|x| x.is_finite());
    match () {
        () if !all(&network.parameters) => Some("a weight"),
        () if !losses.gradient_norm.is_finite() => Some("the gradient"),
        () if !losses.total.is_finite() => Some("the loss"),
        () if !all(&adam.first) || !all(&adam.second) => Some("a moment of the gradient"),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_is_not_finite_is_found() {
        let network = Network::<f32>::zeros(3);
        let adam = Adam::new(network.parameters.len());
        let losses = Losses::default();
        assert_eq!(not_finite(&losses, &network, &adam), None);
        assert_eq!(not_finite(&Losses { total: f64::NAN, ..losses }, &network, &adam), Some("the loss"));
        assert_eq!(
            not_finite(&Losses { gradient_norm: f64::INFINITY, ..losses }, &network, &adam),
            Some("the gradient")
        );
        let mut wrong = network.clone();
        wrong.parameters[7] = f32::NEG_INFINITY;
        assert_eq!(not_finite(&losses, &wrong, &adam), Some("a weight"));
        let mut moments = adam;
        moments.second[5] = f32::INFINITY;
        assert_eq!(not_finite(&losses, &network, &moments), Some("a moment of the gradient"));
    }
}
