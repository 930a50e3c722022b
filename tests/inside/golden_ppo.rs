//! One whole PPO step and one GAE example against numbers from an independent automatic differentiation in f64.

use racer::base::lane::{LANES, Level, Portable, Real};
use racer::learn::nn::gemm::Exact;
use racer::learn::nn::{Layer, Network};
use racer::learn::ppo::batch::Minibatch;
use racer::learn::ppo::config::ProductPrecision;
use racer::learn::ppo::gae;
use racer::learn::ppo::loss::Weights;
use racer::learn::ppo::update::{Hyper, Losses, Updater};
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("../golden/ppo.json")).expect("JSON")
}

/// What the same minibatch gives with the entropy of the action.
fn squashed() -> Value {
    serde_json::from_str(include_str!("../golden/ppo-squashed.json")).expect("JSON")
}

/// All numbers of a nested array, in order.
fn flat(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(flat).collect(),
        Value::Bool(yes) => vec![f64::from(*yes)],
        other => vec![other.as_f64().expect("a number")],
    }
}

/// `[sample][feature]` as rows of 16 samples, `[row][feature][16]`.
fn rows(value: &Value) -> Vec<f64> {
    let x = flat(value);
    let features = x.len() / value.as_array().expect("samples").len();
    let at = |i: usize| (i / LANES / features * LANES + i % LANES) * features + i / LANES % features;
    (0..x.len()).map(|i| x[at(i)]).collect()
}

fn network(parameters: &Value) -> Network<f64> {
    let inputs = parameters["actor"][0]["w"].as_array().expect("inputs").len();
    let mut network = Network::zeros(inputs);
    for (shape, name) in [(network.actor.clone(), "actor"), (network.critic.clone(), "critic")] {
        for index in 0..3 {
            let layer = &parameters[name][index];
            network.set_layer(&shape, index, &Layer { weights: flat(&layer["w"]), biases: flat(&layer["b"]) });
        }
    }
    let at = network.log_std_range();
    network.parameters[at].copy_from_slice(&flat(&parameters["log_std"]));
    network
}

fn hyper(golden: &Value, squashed: bool) -> Hyper {
    let get = |name: &str| golden["hyper"][name].as_f64().expect("a number");
    Hyper {
        precision: ProductPrecision::F32,
        weights: Weights {
            clip: get("clip"),
            entropy: get("entropy_coefficient"),
            squashed,
            magnitude: get("magnitude_coefficient"),
            saturation: 0.0,
            value: get("value_coefficient"),
        },
        learning_rate: get("learning_rate"),
        max_gradient_norm: get("max_gradient_norm"),
        adam_epsilon: get("adam_epsilon"),
    }
}

/// One step on the golden minibatch in the precision of `E`: losses, gradient, parameters afterwards, all in f64.
fn step<E, F>(cast: fn(f64) -> E, squashed: bool, run: F) -> (Losses, Vec<f64>, Vec<f64>)
where
    E: Real<Mask = bool> + PartialOrd + Default + Into<f64>,
    F: FnOnce(&mut Updater<E>, &mut Network<E>, &Minibatch<E>, &[u32], &Hyper) -> Losses,
{
    let golden = golden();
    let convert = |x: Vec<f64>| -> Vec<E> { x.into_iter().map(cast).collect() };
    let exact = network(&golden["parameters"]);
    let mut network = Network::zeros(exact.inputs());
    network.parameters.iter_mut().zip(exact.parameters.iter()).for_each(|(to, &from)| *to = cast(from));
    let [observations, z, log_prob, advantages, returns] =
        ["observations", "z", "old_log_prob", "advantages", "returns"].map(|name| convert(rows(&golden[name])));
    let batch = Minibatch {
        observations: &observations,
        z: &z,
        log_prob: &log_prob,
        advantages: &advantages,
        returns: &returns,
    };
    let order: Vec<u32> = (0..(advantages.len() / LANES) as u32).collect();
    let mut updater = Updater::new(&network);
    let losses = run(&mut updater, &mut network, &batch, &order, &hyper(&golden, squashed));
    let widen = |x: &[E]| x.iter().map(|&x| x.into()).collect();
    (losses, widen(&updater.gradient), widen(&network.parameters))
}

/// Checks everything that `golden` says about a step, to `tolerance` relative to the largest number of its kind.
fn check(name: &str, golden: &Value, (losses, gradient, parameters): (Losses, Vec<f64>, Vec<f64>), tolerance: f64) {
    let get = |name: &str| golden["losses"][name].as_f64().expect("a number");
    for (term, found) in [
        ("total", losses.total),
        ("surrogate", losses.surrogate),
        ("value", losses.value),
        ("entropy", losses.entropy),
        ("magnitude", losses.magnitude),
        ("approx_kl", losses.approx_kl),
        ("clip_fraction", losses.clip_fraction),
    ] {
        // The file gives ten digits.
        assert!((found - get(term)).abs() < tolerance.max(1e-9), "{name}: {term} {found} instead of {}", get(term));
    }
    let norm = golden["gradient_norm"].as_f64().expect("a number");
    assert!((losses.gradient_norm / norm - 1.0).abs() < tolerance.max(1e-9), "{name}: norm {}", losses.gradient_norm);
    let kinds = [("gradients", &gradient), ("parameters_after", &parameters)];
    for (kind, found) in kinds.into_iter().filter(|(kind, _)| golden.get(kind).is_some()) {
        let expected = network(&golden[kind]).parameters;
        let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for (i, (found, expected)) in found.iter().zip(expected.iter()).enumerate() {
            let error = (found - expected).abs() / largest;
            assert!(error < tolerance.max(1e-9), "{name}: {kind}[{i}] {found} instead of {expected}");
        }
    }
}

#[test]
fn a_step_in_double_precision() {
    // The files give ten digits and eight.
    for (golden, entropy_of_the_action, tolerance) in [(golden(), false, 1e-9), (squashed(), true, 1e-7)] {
        let found = step(
            |x| x,
            entropy_of_the_action,
            |u, network, batch, rows, hyper| u.step_with::<Portable<f64>, Exact>(network, batch, rows, hyper),
        );
        check("f64", &golden, found, tolerance);
    }
}

#[test]
fn a_step_on_every_level() {
    for level in Level::available() {
        for (golden, entropy_of_the_action) in [(golden(), false), (squashed(), true)] {
            let found = step(
                |x| x as f32,
                entropy_of_the_action,
                |u, network, batch, rows, hyper| u.step(level, network, batch, rows, hyper),
            );
            check(&level.to_string(), &golden, found, 2e-5);
        }
    }
}

#[test]
fn advantages_with_termination_and_truncation() {
    let golden = &golden()["gae"];
    let lanes = golden["last_values"].as_array().expect("lanes").len();
    let block = |value: &Value| -> Vec<f32> {
        let x = flat(value);
        let at = |i: usize| (i % LANES < lanes).then(|| x[i / LANES * lanes + i % LANES] as f32);
        (0..x.len() / lanes * LANES).map(|i| at(i).unwrap_or(0.0)).collect()
    };
    let bits = |value: &Value| -> Vec<u16> {
        let row = |row: &Value| flat(row).iter().enumerate().map(|(i, &yes)| (yes as u16) << i).sum::<u16>();
        value.as_array().expect("rows").iter().map(row).collect()
    };
    let expected = block(&golden["advantages"]);
    let steps = gae::Steps {
        blocks: 1,
        rewards: &block(&golden["rewards"]),
        values: &block(&golden["values"]),
        terminated: &bits(&golden["terminated"]),
        truncated: &bits(&golden["truncated"]),
        final_values: &block(&golden["final_values"]),
        last_values: &block(&golden["last_values"]),
    };
    let [gamma, lambda] = ["gamma", "lambda_"].map(|name| golden[name].as_f64().expect("a number") as f32);
    for level in Level::available() {
        let (mut advantages, mut returns) = (vec![0.0; expected.len()], vec![0.0; expected.len()]);
        gae::advantages(level, &steps, gamma, lambda, &mut advantages, &mut returns);
        for i in (0..expected.len()).filter(|i| i % LANES < lanes) {
            assert!((advantages[i] - expected[i]).abs() < 1e-5, "{level}: row {} lane {}", i / LANES, i % LANES);
            assert!((returns[i] - advantages[i] - steps.values[i]).abs() < 1e-6);
        }
    }
}
