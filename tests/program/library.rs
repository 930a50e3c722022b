//! The library as its users meet it: what it refuses, and how it ends.

use racer::{Error, Flow, Policy, Setup, Simulation, StartPlace, Vehicle, evaluate, train, train_into};

/// A training of a second.
const TINY: [&str; 7] = [
    "track=square",
    "budget.steps=8000",
    "budget.snapshots=2",
    "ppo.environments=64",
    "ppo.rollout=16",
    "ppo.minibatches=2",
    "eval.agents=16",
];

fn tiny() -> Setup {
    Setup::new(&TINY).unwrap()
}

#[test]
fn what_makes_no_sense_is_refused_with_what_to_do() {
    let error = Setup::new(&["track=sqare"]).unwrap_err();
    assert!(matches!(error, Error::BadInput(_)) && error.to_string().contains("square"), "{error}");
    let error = Setup::new(&["ppo.clip=-1"]).unwrap_err().to_string();
    assert!(error.contains("ppo.clip") && error.contains("a number above 0"), "{error}");
    let error = Vehicle::load("seed_class").unwrap().with_effect("axial_inflw", "k", 0.5).unwrap_err().to_string();
    assert!(error.contains("axial_inflw"), "{error}");
    let policy = Policy::load("nowhere").unwrap_err().to_string();
    assert!(policy.contains("nowhere"), "{policy}");
}

#[test]
fn a_simulation_steps_every_vehicle_or_says_why_not() {
    let setup = tiny();
    let mut batch = Simulation::new(&setup, 21, StartPlace::Pad).unwrap();
    assert!(Simulation::new(&setup, 0, StartPlace::Pad).is_err());
    assert!(batch.step(&[[0.0; 4]; 20]).unwrap_err().to_string().contains("21"));
    assert!(batch.step(&[[f32::NAN; 4]; 21]).unwrap_err().to_string().contains("commands[0]"));
    assert_eq!(batch.observations().len(), 21);

    // Without thrust nothing leaves the ground; at full thrust all leave the volume, and begin anew.
    let mut again = batch.clone();
    let (mut ended, start) = (0, batch.motions()[0].position_m);
    for _ in 0..300 {
        let transitions = batch.step(&[[0.0, 0.0, 0.0, 1.0]; 21]).unwrap();
        assert_eq!(transitions, again.step(&[[0.0, 0.0, 0.0, 1.0]; 21]).unwrap());
        assert!(transitions.iter().all(|t| t.reward.is_finite()));
        for (motion, _) in batch.motions().iter().zip(&transitions).filter(|(_, t)| t.ending.is_some()) {
            assert_eq!((motion.position_m, motion.gates_passed), (start, 0));
            ended += 1;
        }
    }
    assert!(ended >= 21, "{ended} flights ended");
    assert_eq!(batch.motions(), again.motions());
}

#[test]
fn a_training_is_watched_and_can_be_ended() {
    let mut updates = 0;
    let trained = train(&tiny(), |progress| {
        updates = progress.updates;
        assert!(progress.metrics().any(|name| name == "ppo/loss") && progress.metric("ppo/loss").is_some());
        Flow::Continue
    })
    .unwrap();
    assert!(!trained.stopped && trained.policies.len() == 2 && updates > 3);
    let (policy, report) = trained.best().unwrap();
    let again = evaluate(&policy, policy.vehicle(), 16).unwrap();
    assert_eq!(again.rank(), report.rank());
    assert!(evaluate(&policy, policy.vehicle(), 0).is_err());

    let stopped = train(&tiny(), |_| Flow::Stop).unwrap();
    assert!(stopped.stopped && stopped.steps < trained.steps);
}

#[test]
fn a_run_folder_is_filled_whole_or_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, part) = (folder.path().join("whole"), folder.path().join("part"));
    let (policy, _) = train_into(&whole, &tiny(), |_| Flow::Continue).unwrap();
    let read = Policy::load(&whole).unwrap();
    assert_eq!((read.steps(), &read.track().name), (policy.steps(), &policy.track().name));
    assert!(whole.join("evaluation.json").is_file() && whole.join("training.svg").is_file());
    assert!(train_into(&whole, &tiny(), |_| Flow::Continue).unwrap_err().to_string().contains("nothing existing"));

    let error = train_into(&part, &tiny(), |_| Flow::Stop).unwrap_err();
    assert!(matches!(error, Error::Interrupted(_)), "{error}");
    assert!(part.join("metrics.csv").is_file() && !part.join("policy.safetensors").exists());
}
