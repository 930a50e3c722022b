//! A policy learns to fly round the square for some seconds, is scored, kept, and read again.
//!
//!     cargo run --release --example train

use racer::{Error, Flow, Policy, Setup, evaluate, train};

fn main() -> Result<(), Error> {
    let setup = Setup::new(&[
        "track=square",
        "budget.steps=3_000_000",
        "budget.snapshots=2",
        "ppo.environments=512",
        "ppo.rollout=64",
        "eval.agents=64",
    ])?;

    // Called after every update; what it answers says whether to go on.
    let mut shown = 0.0;
    let trained = train(&setup, |progress| {
        if progress.share >= shown {
            let million = progress.steps as f64 / 1e6;
            let gates = progress.metric("episode/gates").unwrap_or_default();
            println!("{million:.1} M steps: {gates:.1} gates an episode");
            shown += 0.25;
        }
        Flow::Continue
    })?;

    let (policy, report) = trained.best()?;
    if let Some(pad) = &report.fixed {
        let (gates, laps) = (pad.gates_passed.mean, 100.0 * pad.lap_completion);
        println!("from the pad: {gates:.1} gates, {laps:.0} % of vehicles complete a lap");
    }

    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("policy.safetensors");
    policy.save(&file)?;
    let again = evaluate(&Policy::load(&file)?, policy.vehicle(), 64)?;
    println!("kept and read again, it flies the same: {}", again.completion() == report.completion());
    Ok(())
}
