//! The PPO loss of a block of 16 samples and its derivatives by the networks' outputs (paper Eq. 12).
//!
//! total = surrogate - entropy_coefficient entropy + magnitude_coefficient E|tanh(mean)|^2
//!         + saturation_coefficient E|mean beyond full stick|^2 + value_coefficient value

use super::squash::{Squash, squash};
use crate::base::lane::{Lane, build, each, sum_of_squares};
use crate::learn::policy::{ACTIONS, log_prob_of};

/// Mean before the tanh from which a command counts as full stick: atanh 0.9. Beyond it the tanh hardly changes, so
/// that neither the command's cost nor its entropy brings a mean back that has gone far.
const FULL_STICK: f64 = 1.472_219_489_583_220_2;

/// Weights of the loss's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Ratios leave no gradient beyond 1 +- clip.
    pub clip: f64,
    pub entropy: f64,
    /// Whether the entropy is that of the action, after its tanh, or of the Gaussian before it.
    pub squashed: bool,
    /// lambda_a of Eq. 12.
    pub magnitude: f64,
    /// Of the squared parts of the mean beyond [`FULL_STICK`].
    pub saturation: f64,
    pub value: f64,
}

/// One block of samples.
pub struct Samples<L> {
    pub mean: [L; ACTIONS],
    pub log_std: [L; ACTIONS],
    pub value: L,
    /// Unsquashed action that was taken, and its log-probability then.
    pub z: [L; ACTIONS],
    pub old_log_prob: L,
    pub advantage: L,
    pub ret: L,
}

/// Sums over lanes are left to the caller: everything here is per lane.
pub struct LossGradient<L> {
    /// Derivatives of the total by mean, log_std (without that of the Gaussian's entropy, which is
    /// constant) and value.
    pub d_mean: [L; ACTIONS],
    pub d_log_std: [L; ACTIONS],
    pub d_value: L,
    /// The terms of [`TERMS`].
    pub terms: [L; TERMS.len()],
}

/// Per-sample terms, in the order of [`LossGradient::terms`]; half squared errors for `value`.
pub const TERMS: [&str; 7] = ["surrogate", "value", "magnitude", "saturation", "approx_kl", "clip_fraction", "squash"];

/// Loss and derivatives; `share` is 1 over the minibatch's samples and scales the derivatives.
#[inline(always)]
pub fn loss<L: Lane>(w: &Weights, s: &Samples<L>, share: L) -> LossGradient<L> {
    let one = L::one();
    let inverse = each!(s.log_std, |x| (-x).exp());
    let noise: [L; ACTIONS] = build!(|k| (s.z[k] - s.mean[k]) * inverse[k]);
    let log_ratio = log_prob_of(noise, s.log_std) - s.old_log_prob;
    let ratio = log_ratio.exp();
    let free = ratio * s.advantage;
    let clipped = ratio.clamp(L::of(1.0 - w.clip), L::of(1.0 + w.clip)) * s.advantage;
    // The gradient flows where the free product is the smaller.
    let d_log_prob = L::select(free.le(clipped), -free, L::zero()) * share;

    let squashed = each!(s.mean, |x| x.tanh());
    let magnitude = sum_of_squares(squashed);
    let pull = share * L::of(2.0 * w.magnitude);
    let limit = L::of(FULL_STICK);
    let beyond = each!(s.mean, |x| x - x.clamp(-limit, limit));
    let back = share * L::of(2.0 * w.saturation);
    let error = s.value - s.ret;
    let (squash, cost) = (squashes(w, s), share * L::of(-w.entropy));
    LossGradient {
        d_mean: build!(|k| {
            let slope = (-squashed[k]).mul_add(squashed[k], one);
            let costs = beyond[k].mul_add(back, cost * squash[k].d_mean);
            (d_log_prob * noise[k]).mul_add(inverse[k], (squashed[k] * slope).mul_add(pull, costs))
        }),
        d_log_std: build!(|k| d_log_prob.mul_add(noise[k].mul_add(noise[k], -one), cost * squash[k].d_log_std)),
        d_value: error * share * L::of(w.value),
        terms: [
            -free.min(clipped),
            error * error * L::of(0.5),
            magnitude,
            sum_of_squares(beyond),
            (ratio - one) - log_ratio,
            L::select(L::of(w.clip).lt((ratio - one).abs()), one, L::zero()),
            (squash[0].value + squash[1].value) + (squash[2].value + squash[3].value),
        ],
    }
}

/// What the tanh adds to the entropy, command by command; nothing where the entropy is the Gaussian's.
#[inline(always)]
fn squashes<L: Lane>(w: &Weights, s: &Samples<L>) -> [Squash<L>; ACTIONS] {
    if w.squashed {
        // Apart, so that its quadrature takes no registers where it is not wanted.
        L::vectorize(
            #[inline(always)]
            || build!(|k| squash(s.mean[k], s.log_std[k].exp())),
        )
    } else {
        let zero = L::zero();
        [Squash { value: zero, d_mean: zero, d_log_std: zero }; ACTIONS]
    }
}
