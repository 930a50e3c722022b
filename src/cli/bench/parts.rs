//! The tables of `racer bench --parts` and `--threads-model`.

use crate::cli::columns;
use crate::learn::nn::TILE_SAMPLES;
use crate::learn::ppo::update::parts::StepParts;
use crate::present::bench::threads::{THREADS, ThreadsModel};
use serde_json::{Value, json};

fn named(step: &StepParts) -> [(&'static str, f64); 8] {
    [
        ("forward", step.forward),
        ("  tanh, alone", step.tanh),
        ("backward", step.backward),
        ("gather", step.gather),
        ("loss", step.loss),
        ("transposes", step.transpose),
        ("sum of gradients", step.sum),
        ("Adam", step.adam),
    ]
}

/// What a step of the optimiser costs; `flops` are its networks' operations, `peak` operations a second.
pub fn parts(model: &ThreadsModel, flops: f64, peak: f64) -> String {
    let step = &model.step;
    let row = |name: &str, s: f64| {
        vec![name.to_string(), format!("{:.1}", 1e6 * s), format!("{:.1}", 100.0 * s / step.whole)]
    };
    let mut rows: Vec<_> = named(step).iter().map(|(name, s)| row(name, *s)).collect();
    rows.push(row("multiply-adds at the peak", flops / peak));
    rows.push(row("the step", step.whole));
    let table = columns::table(&["part", "us", "% of the step"], rows, 1..3);
    format!("An optimiser step on one thread, each part repeated alone:\n{table}")
}

/// Predicted training speed.
pub fn threads(model: &ThreadsModel) -> String {
    let one = model.predicted(1);
    let row = |n: usize| {
        let seen = model.seen.iter().find(|(threads, _)| *threads == n);
        let speed = model.predicted(n);
        let seen = seen.map_or(String::new(), |(_, speed)| format!("{:.3}", speed / 1e6));
        vec![n.to_string(), format!("{:.3}", speed / 1e6), format!("{:.2}", speed / one), seen]
    };
    let table = columns::table(&["threads", "M steps/s", "times one", "measured"], THREADS.map(row).to_vec(), 0..4);
    let iteration = model.batch as f64 / one;
    let share = |s: f64| 100.0 * s / iteration;
    format!(
        "Training speed by a model. Of an iteration on one thread {:.1} % is the rollout ({} tiles of {TILE_SAMPLES} \
         environments to share), {:.1} % the {} chunks of steps to share, {:.1} % sums and Adam, shared by any \
         number, {:.1} % what one thread does alone. A doubling of the threads costs a step {:.1} us of waiting.\n\
         {table}",
        share(model.rollout),
        model.tiles,
        share(model.steps as f64 * model.step.chunked()),
        model.step.chunks,
        share(model.steps as f64 * model.step.spanned()),
        share(model.rest + model.steps as f64 * model.step.transpose),
        1e6 * model.wake,
    )
}

/// Both as JSON, times in s.
pub fn document(model: &ThreadsModel) -> Value {
    let step = &model.step;
    let parts: serde_json::Map<_, _> =
        named(step).iter().map(|(name, s)| (name.trim().replace([' ', ','], "_"), json!(s))).collect();
    let predicted: Vec<_> =
        THREADS.iter().map(|&n| json!({"threads": n, "training_steps_per_s": model.predicted(n)})).collect();
    let measured: Vec<_> =
        model.seen.iter().map(|(n, speed)| json!({"threads": n, "training_steps_per_s": speed})).collect();
    json!({
        "step_s": step.whole, "step_parts_s": parts, "chunks": step.chunks, "steps_per_iteration": model.steps,
        "rollout_s": model.rollout, "rest_s": model.rest, "wake_s_per_doubling": model.wake,
        "predicted": predicted, "measured": measured,
    })
}
