//! Every hand-written derivative against central differences in double precision, term by term of the loss.

use racer::base::lane::{LANES, Portable};
use racer::base::rng::{Philox, RngStream};
use racer::learn::nn::Network;
use racer::learn::nn::aligned::Aligned;
use racer::learn::nn::bf16::Bf16;
use racer::learn::nn::gemm::Exact;
use racer::learn::policy::log_prob_of;
use racer::learn::ppo::batch::Minibatch;
use racer::learn::ppo::loss::Weights;
use racer::learn::ppo::update::Updater;
use rand::RngExt;
use rand_distr::StandardNormal;

const ROWS: usize = 5;
const INPUTS: usize = 11;

/// A network with weights of ordinary size everywhere, and a batch on which some ratios are clipped and some are not.
/// The size of the heads' weights is that of the means: small ones keep them near zero, where `old` is about the
/// log-probability.
fn example(head: f64) -> (Network<f64>, [Vec<f64>; 5]) {
    let mut rng = Philox::new(5).sequence(RngStream::Weights, 0, 0);
    let mut network = Network::<f64>::zeros(INPUTS);
    for shape in [network.actor.clone(), network.critic.clone()] {
        for index in 0..3 {
            let mut layer = network.layer(&shape, index);
            let size = if index == 2 { head } else { 0.2 };
            layer
                .weights
                .iter_mut()
                .chain(&mut layer.biases)
                .for_each(|w| *w = size * rng.sample::<f64, _>(StandardNormal));
            network.set_layer(&shape, index, &layer);
        }
    }
    let log_std = network.log_std_range();
    let log_stds = [-0.5, -0.2, -0.9, 0.1];
    network.parameters[log_std].copy_from_slice(&log_stds);
    let mut normals = |n: usize, mean: f64, sd: f64| {
        (0..n).map(|_| mean + sd * rng.sample::<f64, _>(StandardNormal)).collect::<Vec<_>>()
    };
    let rows = ROWS * LANES;
    let (x, z) = (normals(rows * INPUTS, 0.0, 1.0), normals(rows * 4, 0.0, 0.7));
    let mut old = normals(rows, 0.0, 0.3);
    for (i, old) in old.iter_mut().enumerate() {
        let of = |k: usize| z[(i / LANES * 4 + k) * LANES + i % LANES] / log_stds[k].exp();
        *old += log_prob_of([of(0), of(1), of(2), of(3)], log_stds);
    }
    let data = [x, z, old, normals(rows, 0.0, 1.0), normals(rows, 1.0, 1.0)];
    (network, data)
}

fn batch<E>([observations, z, log_prob, advantages, returns]: &[Vec<E>; 5]) -> Minibatch<'_, E> {
    Minibatch { observations, z, log_prob, advantages, returns }
}

fn check(name: &str, weights: Weights) {
    check_at(0.02, name, weights);
}

fn check_at(head: f64, name: &str, weights: Weights) {
    let (mut network, data) = example(head);
    let batch = batch(&data);
    let rows: Vec<u32> = (0..ROWS as u32).collect();
    let mut updater = Updater::new(&network);
    let losses = updater.differentiate::<Portable<f64>, Exact>(&network, &batch, &rows, &weights, None);
    let clipped = (0.05..0.95).contains(&losses.clip_fraction);
    assert!(clipped || losses.saturation > 0.01, "{name} takes no part: {losses:?}");
    let gradient = updater.gradient.to_vec();
    let largest = gradient.iter().fold(0.0f64, |m, g| m.max(g.abs()));
    assert!(largest > 1e-4, "{name} has no gradient");
    let step = 1e-6;
    // All of log_std at the end, and every nineteenth of everything else.
    let all = network.parameters.len();
    for i in (0..all - 4).step_by(19).chain(all - 4..all) {
        let here = network.parameters[i];
        let mut at = |x: f64| {
            network.parameters[i] = x;
            updater.differentiate::<Portable<f64>, Exact>(&network, &batch, &rows, &weights, None).total
        };
        let difference = (at(here + step) - at(here - step)) / (2.0 * step);
        network.parameters[i] = here;
        // Padding between layers is part of the vector but of no output; both sides are zero there.
        let error = (gradient[i] - difference).abs() / largest;
        assert!(error < 1e-6, "{name}: parameter {i}: {} by hand, {difference} by differences", gradient[i]);
    }
}

const NONE: Weights = Weights { clip: 0.2, entropy: 0.0, squashed: false, magnitude: 0.0, saturation: 0.0, value: 0.0 };

#[test]
fn surrogate() {
    check("surrogate", NONE);
}

#[test]
fn value() {
    check("value", Weights { value: 0.7, ..NONE });
}

#[test]
fn entropy_and_magnitude() {
    check("entropy", Weights { entropy: 0.3, ..NONE });
    check("entropy of the action", Weights { entropy: 0.3, squashed: true, ..NONE });
    check("magnitude", Weights { magnitude: 0.9, ..NONE });
    // Means of several units, of which only the parts beyond full stick cost.
    check_at(0.4, "saturation", Weights { saturation: 0.9, ..NONE });
}

#[test]
fn all_terms() {
    check("all", Weights { clip: 0.3, entropy: 0.01, squashed: true, magnitude: 0.15, saturation: 0.4, value: 0.5 });
}

/// Factors of eight bits point the gradient the same way, within what eight bits are.
#[test]
fn in_bf16_the_gradient_is_nearly_the_same() {
    let (network, data) = example(0.02);
    let mut parameters = Aligned::zeros(network.parameters.len());
    parameters.iter_mut().zip(network.parameters.iter()).for_each(|(to, from)| *to = *from as f32);
    let network = Network { actor: network.actor, critic: network.critic, parameters };
    let data = data.map(|x| x.into_iter().map(|x| x as f32).collect());
    let batch = batch(&data);
    let rows: Vec<u32> = (0..ROWS as u32).collect();
    let weights = Weights { clip: 0.3, entropy: 0.01, squashed: true, magnitude: 0.15, saturation: 0.4, value: 0.5 };
    let [mut exact, mut rounded] = [Updater::new(&network), Updater::new(&network)];
    let losses = [
        exact.differentiate::<Portable<f32>, Exact>(&network, &batch, &rows, &weights, None),
        rounded.differentiate::<Portable<f32>, Bf16>(&network, &batch, &rows, &weights, None),
    ];
    assert!((losses[0].total / losses[1].total - 1.0).abs() < 0.01, "{losses:?}");
    let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum::<f64>();
    let (a, b) = (&exact.gradient, &rounded.gradient);
    let along = product(a, b) / (product(a, a) * product(b, b)).sqrt();
    assert!(along > 0.999 && a[..] != b[..], "cosine {along}");
    assert!((product(b, b) / product(a, a) - 1.0).abs() < 0.02);
}
