//! The policy's file: read back, flown from, refused where anything in it is another convention.

use racer::base::lane::Level;
use racer::race::env::reset::StartPlace;
use racer::race::eval::{EvalConfig, benchmark};
use racer::race::onboard::Surroundings;
use racer::race::snapshot::self_test::{self, LEAST, SelfTestRows};
use racer::race::snapshot::{About, Snapshot};
use serde_json::Value;
use std::path::Path;

/// A policy that laps the square, written by an older racer.
fn older() -> Snapshot {
    Snapshot::read(Path::new("tests/golden/policy-73e7003.safetensors")).unwrap()
}

/// What a flight computer does with the policy is what the evaluation does.
#[test]
fn the_flight_side_flies_the_lap_of_the_evaluation() {
    let snapshot = older();
    let About { track, vehicle, eval, .. } = &snapshot.about;
    let flight = self_test::fly(&snapshot.network, track, vehicle, eval.max_steps);
    let config = EvalConfig { agents: 1, ..eval.clone() };
    let (scored, _) =
        benchmark(Level::best(), &snapshot.race(None), track, &snapshot.network, StartPlace::Pad, &config);
    let (ours, evaluated) = (flight.lap_s.expect("a lap"), scored.lap_time_s.expect("a lap").median);
    assert!((ours - evaluated).abs() < 1e-4, "{ours} and {evaluated} s");
}

#[test]
fn a_file_says_what_flying_it_takes_and_repeats() {
    let snapshot = older();
    let content = snapshot.content().unwrap();
    let bytes = content.to_bytes().unwrap();
    assert_eq!(bytes, snapshot.to_bytes().unwrap());
    assert!(bytes.len() < 110_000, "{} bytes", bytes.len());
    let metadata: Value = serde_json::from_str(&content.metadata).unwrap();
    let test = &metadata["flying"]["self_test"];
    assert_eq!(test["steps"], LEAST);
    assert!(test["switches"].as_u64().unwrap() >= 2, "{test}");
    assert!((test["lap_s"].as_f64().unwrap() - 1.784).abs() < 1e-3, "{test}");
    // What the policy sees in the nominal lap is inside the range that the file names.
    let groups = metadata["flying"]["observation"].as_array().unwrap();
    let ends = |key: &str| -> Vec<f32> {
        groups.iter().flat_map(|group| group[key].as_array().unwrap()).map(|x| x.as_f64().unwrap() as f32).collect()
    };
    let (low, high) = (ends("low"), ends("high"));
    for row in &content.rows.observation {
        for (k, &x) in row.iter().enumerate() {
            assert!(low[k] <= x && x <= high[k], "entry {k}: {x} is outside {} to {}", low[k], high[k]);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("policy.safetensors");
    snapshot.write(&path).unwrap();
    let read = Snapshot::read(&path).unwrap();
    assert_eq!((read.network, read.about), (snapshot.network, snapshot.about));
}

/// Every convention that can be got wrong is noticed.
#[test]
fn the_self_test_fails_for_every_wrong_convention() {
    let snapshot = older();
    let rows = snapshot.content().unwrap().rows;
    let around = Surroundings::of(&snapshot.about.track, &snapshot.about.vehicle);
    rows.check(&snapshot.network, &around).unwrap();
    let refused = |what: &str, rows: &SelfTestRows, around: &Surroundings| {
        assert!(rows.check(&snapshot.network, around).is_err(), "{what} is not noticed");
    };
    let turned = |change: &dyn Fn(&mut [f32; self_test::STATE])| {
        let mut rows = rows.clone();
        rows.state.iter_mut().for_each(change);
        rows
    };
    refused("a quaternion with w last", &turned(&|row| row[6..10].rotate_left(1)), &around);
    refused("a quaternion from world to body", &turned(&|row| row[7..10].iter_mut().for_each(|x| *x = -*x)), &around);
    refused("a world with z down", &turned(&|row| [1, 2, 4, 5].iter().for_each(|&k| row[k] = -row[k])), &around);
    refused("north before east", &turned(&|row| (row.swap(0, 1), row.swap(3, 4)).0), &around);
    refused("a pitch rate of the other sign", &turned(&|row| row[11] = -row[11]), &around);
    refused("a yaw rate of the other sign", &turned(&|row| row[12] = -row[12]), &around);
    refused("a state one step late", &turned_by_one(&rows), &around);
    let mut other = around.clone();
    other.gates.iter_mut().for_each(|gate| gate.axes = std::array::from_fn(|i| gate.axes.map(|axis| axis[i])));
    refused("transposed gates", &rows, &other);
    let mut other = around.clone();
    other.gates.iter_mut().for_each(|gate| gate.next.reverse());
    refused("next gates in the other order", &rows, &other);
    let mut other = around.clone();
    other.gates.iter_mut().for_each(|gate| gate.radius = 0.0);
    refused("no switch of the gate", &rows, &other);
    refused("no lag of the commands", &rows, &Surroundings { share: [1.0; 4], ..around.clone() });
    refused("another full rate", &rows, &Surroundings { full_rate: [1.0; 3], ..around.clone() });
    let mut other = around.clone();
    other.thrust_n.reverse();
    refused("thrust coefficients in the other order", &rows, &other);
}

fn turned_by_one(rows: &SelfTestRows) -> SelfTestRows {
    let mut late = rows.clone();
    late.state.rotate_right(1);
    late
}
