//! Settings of the optimiser and of the training budget.

use crate::base::check::{Check, Invalid};
use crate::learn::nn::TILE_SAMPLES as TILE;
use serde::{Deserialize, Serialize};

/// How long to train. Exactly one of `minutes` and `steps` is set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BudgetConfig {
    /// Wall-clock time of rollouts, updates and snapshots, minutes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minutes: Option<f64>,
    /// Environment steps, rounded up to whole rollouts. Repeats bit for bit, which a time cannot promise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Policies kept, evenly over the budget; the last is the final one. All are evaluated afterwards and the best is
    /// chosen.
    pub snapshots: usize,
}

impl BudgetConfig {
    /// Share of the budget that `steps` environment steps in `seconds` have used, 0 to 1 and beyond. A budget of
    /// neither minutes nor steps, which `check` refuses, is used up from the start.
    pub fn share(&self, steps: u64, seconds: f64) -> f64 {
        match (self.steps, self.minutes) {
            (Some(total), _) => steps as f64 / total as f64,
            (None, Some(minutes)) => seconds / (60.0 * minutes),
            (None, None) => 1.0,
        }
    }
}

impl Check for BudgetConfig {
    fn check(&self) -> Result<(), Invalid> {
        match (self.minutes, self.steps) {
            (Some(minutes), None) => Invalid::unless_positive("minutes", minutes, "")?,
            (None, Some(steps)) => Invalid::unless(steps > 0, "steps", steps, "at least 1", "")?,
            (Some(_), Some(_)) => return Err(Invalid::new("steps", "both", "either minutes or steps", "remove one")),
            (None, None) => return Err(Invalid::new("", "neither", "minutes or steps", "set one of them")),
        }
        Invalid::unless((1..=1000).contains(&self.snapshots), "snapshots", self.snapshots, "1 to 1000", "")
    }
}

/// Factors of the optimiser's matrix products. Sums, activations, weights and their steps are singles in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ProductPrecision {
    F32,
    /// Rounded to the upper half of a single, which processors with an instruction for it multiply several times as
    /// fast; without one it is slow.
    Bf16,
}

/// Proximal policy optimisation (paper sections 4.4 and 4.5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PpoConfig {
    /// Vehicles that fly side by side; a multiple of 64. More make the gradient steadier and the updates rarer.
    pub environments: usize,
    /// Steps each flies between two updates. Longer sees further before bootstrapping.
    pub rollout: usize,
    /// Parts that a rollout is split into; each is one step of Adam.
    pub minibatches: usize,
    /// Times that each rollout is learnt from.
    pub epochs: usize,
    /// Step size of Adam at the start.
    pub learning_rate: f64,
    /// Step size at the end of the budget, to which it falls linearly. Not zero, or the last part of the budget teaches
    /// nothing.
    pub learning_rate_final: f64,
    /// Million steps after which the step size also falls as one over the steps; 0 for never. How fine the rest of
    /// learning is depends on the steps made, not on the share of the budget: without it a long training spends most of
    /// its time on steps that are too coarse to gain by.
    pub refine_after: f64,
    /// Discount of a step. 0.99 looks a second ahead: about a gate, enough to slow down for the split-S.
    pub gamma: f64,
    /// Weight of longer looks in the advantage (GAE).
    pub lambda: f64,
    /// How far the probability ratio may leave 1 before its gradient stops.
    pub clip: f64,
    /// Reward for a wide action distribution. Higher explores longer.
    pub entropy: f64,
    /// Whether the distribution that is to be wide is that of the action, whose widest is the even one; else that of
    /// the Gaussian before its tanh, which widens for ever and saturates the commands of long trainings.
    pub entropy_squashed: bool,
    /// Share of `entropy` at the end of the budget; falls linearly.
    pub entropy_end: f64,
    /// Weight of the critic's squared error.
    pub value_coefficient: f64,
    /// Gradients of a minibatch with a larger norm are scaled down to it.
    pub max_gradient_norm: f64,
    /// Adam's denominator offset.
    pub adam_epsilon: f64,
    /// lambda_a of Eq. 12: cost of the squared mean action, in the actor's loss. Higher flies with smaller commands.
    pub action_magnitude: f64,
    /// Cost of the squared part of a mean, before its tanh, beyond nine tenths of the stick, in the actor's loss.
    /// Without it commands drift to full stick in long trainings, where no gradient brings them back. It grows from
    /// nothing at `refine_after`.
    pub saturation: f64,
    /// Share of `action_magnitude` and of the reward's `action_change` to begin with; below 1 the policy learns to fly
    /// before it learns to fly smoothly. They grow by the same factor from step to step.
    pub penalty_begin: f64,
    /// Share of the budget after which they are whole.
    pub penalty_full: f64,
    /// Logarithm of the action noise at the start, before the tanh.
    pub log_std_initial: f64,
    /// Share of the iterations so far over which the weights of the policy that is kept are averaged; 0 keeps them as
    /// the last iteration left them. The noise of single minibatches, which costs laps, averages out.
    pub average: f64,
    /// "f32", or "bf16": factors of the optimiser's matrix products, which some processors multiply several times as
    /// fast. A policy is trained in singles but for that, and flies in singles.
    pub precision: ProductPrecision,
}

impl PpoConfig {
    /// Share of the penalties at `share` of the budget.
    pub fn penalty(&self, share: f64) -> f64 {
        let done = if self.penalty_full > 0.0 { (share / self.penalty_full).clamp(0.0, 1.0) } else { 1.0 };
        self.penalty_begin.powf(1.0 - done)
    }

    /// Step size of Adam after `steps`, at `share` of the budget.
    pub fn learning_rate_at(&self, steps: u64, share: f64) -> f64 {
        let falling = self.learning_rate + (self.learning_rate_final - self.learning_rate) * share.clamp(0.0, 1.0);
        falling * self.coarse(steps)
    }

    /// Weight of the saturation after `steps`: what refining takes from the step size. A policy that is still learning
    /// to fly needs the whole stick.
    pub fn saturation_at(&self, steps: u64) -> f64 {
        if self.refine_after > 0.0 { self.saturation * (1.0 - self.coarse(steps)) } else { self.saturation }
    }

    /// What [`Self::refine_after`] leaves of the step size.
    fn coarse(&self, steps: u64) -> f64 {
        if self.refine_after > 0.0 { (1e6 * self.refine_after / steps.max(1) as f64).min(1.0) } else { 1.0 }
    }

    /// Weight of the entropy at `share` of the budget.
    pub fn entropy_at(&self, share: f64) -> f64 {
        self.entropy * (1.0 + (self.entropy_end - 1.0) * share.clamp(0.0, 1.0))
    }

    /// How far the average of the weights moves to those of an iteration, of so many done.
    pub fn renewed(&self, iterations: usize) -> f32 {
        (1.0 / (self.average * iterations as f64).max(1.0)) as f32
    }

    /// Environment steps of one rollout.
    pub fn samples(&self) -> usize {
        self.environments * self.rollout
    }

    fn check_batch(&self) -> Result<(), Invalid> {
        let &Self { environments, rollout, minibatches, .. } = self;
        if environments == 0 || environments % TILE != 0 {
            let low = (environments / TILE * TILE).max(TILE);
            let advice = match environments {
                0..TILE => format!("use {TILE}"),
                _ => format!("the nearest are {low} and {}", low + TILE),
            };
            return Err(Invalid::new("environments", environments, &format!("a multiple of {TILE}"), &advice));
        }
        let Some(samples) = environments.checked_mul(rollout).filter(|&samples| samples <= 1 << 28) else {
            let found = format!("{environments} environments x {rollout} steps");
            return Err(Invalid::new("rollout", found, "at most 2^28 samples a rollout", "lower one of them"));
        };
        // Whole tiles are dealt out to the minibatches.
        let tiles = samples / TILE;
        let works = |minibatches: &usize| tiles.is_multiple_of(*minibatches) && *minibatches > 0;
        if !works(&minibatches) {
            let below = (1..minibatches.min(tiles + 1)).rev().find(works);
            let above = (minibatches.saturating_add(1)..=tiles).find(works);
            let nearest: Vec<_> = [below, above].into_iter().flatten().map(|n| n.to_string()).collect();
            let expected = format!("a divisor of {samples} samples that leaves minibatches of a multiple of {TILE}");
            let advice = format!("the nearest are {}", nearest.join(" and "));
            return Err(Invalid::new("minibatches", minibatches, &expected, &advice));
        }
        Ok(())
    }
}

impl Check for PpoConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, value) in [("rollout", self.rollout), ("epochs", self.epochs)] {
            Invalid::unless((1..=10_000).contains(&value), key, value, "1 to 10000", "")?;
        }
        self.check_batch()?;
        for (key, value) in [
            ("learning_rate", self.learning_rate),
            ("learning_rate_final", self.learning_rate_final),
            ("clip", self.clip),
            ("max_gradient_norm", self.max_gradient_norm),
            ("adam_epsilon", self.adam_epsilon),
        ] {
            Invalid::unless_positive(key, value, "")?;
        }
        for (key, value) in [
            ("refine_after", self.refine_after),
            ("entropy", self.entropy),
            ("value_coefficient", self.value_coefficient),
            ("action_magnitude", self.action_magnitude),
            ("saturation", self.saturation),
        ] {
            Invalid::unless_not_negative(key, value, "")?;
        }
        let begins = self.penalty_begin > 0.0 && self.penalty_begin <= 1.0;
        Invalid::unless(begins, "penalty_begin", self.penalty_begin, "above 0, at most 1", "1 is no growth")?;
        for (key, value) in [
            ("gamma", self.gamma),
            ("lambda", self.lambda),
            ("penalty_full", self.penalty_full),
            ("average", self.average),
            ("entropy_end", self.entropy_end),
        ] {
            Invalid::unless((0.0..=1.0).contains(&value), key, value, "0 to 1", "")?;
        }
        let wide = (-5.0..=2.0).contains(&self.log_std_initial);
        Invalid::unless(wide, "log_std_initial", self.log_std_initial, "-5 to 2", "-0.5 is a good start")
    }
}

#[cfg(test)]
mod tests {
    use crate::race::config::Config;

    #[test]
    fn penalties_grow_by_the_same_factor_and_are_then_whole() {
        let mut ppo = Config::load("a2rl", &[]).unwrap().ppo;
        assert_eq!([0.0, 0.3, 1.0].map(|share| ppo.penalty(share)), [1.0; 3]);
        (ppo.penalty_begin, ppo.penalty_full) = (0.01, 0.5);
        let [begin, quarter, half, late] = [0.0, 0.25, 0.5, 0.9].map(|share| ppo.penalty(share));
        assert!((begin - 0.01).abs() < 1e-12 && (quarter - 0.1).abs() < 1e-12 && half == 1.0 && late == 1.0);
        ppo.penalty_full = 0.0;
        assert_eq!(ppo.penalty(0.0), 1.0);
    }

    #[test]
    fn a_long_training_becomes_finer_with_its_steps_and_a_short_one_with_its_budget() {
        let mut ppo = Config::load("a2rl", &[]).unwrap().ppo;
        let linear = |share: f64| ppo.learning_rate + (ppo.learning_rate_final - ppo.learning_rate) * share;
        assert_eq!([0.0, 0.5, 1.0].map(|share| ppo.learning_rate_at(20_000_000, share)), [0.0, 0.5, 1.0].map(linear));
        let left = ppo.learning_rate_at(200_000_000, 0.5) / linear(0.5);
        assert!((left - 0.1).abs() < 1e-12, "{left}");
        let [early, late] = [20_000_000, 200_000_000].map(|steps| ppo.saturation_at(steps));
        assert!(early == 0.0 && (late / ppo.saturation - 0.9).abs() < 1e-12, "{early}, {late}");
        ppo.refine_after = 0.0;
        assert_eq!(ppo.learning_rate_at(200_000_000, 0.5), ppo.learning_rate_at(0, 0.5));
    }
}
