//! A policy's nominal lap in racer's simulator beside the one in the independent simulator (the paper's Figure 5 has
//! the real flight there).

use crate::args::Args;
use crate::race::{self, Raced};
use crate::table;
use crate::truth::Vehicle;
use crate::truth::hidden::World;
use racer::base::stats::quantile;
use racer::present::report::beside;
use racer::race::snapshot::Snapshot;

/// Races, prints laps and distances, and draws.
///
/// # Panics
///
/// Where the policy cannot be read or the picture not be written.
pub fn show(args: &Args, policy: &str) {
    let policy = Snapshot::read(&racer::present::run::find(policy).expect("a policy").snapshot).expect("a policy");
    let there = race::race(&policy, &World::new(&Vehicle::seed_class(), &[]), &Args { agents: 1, ..args.clone() });
    let (here, there) = (race::in_racer(&policy), &there[0]);
    let title = |name: &str, raced: &Raced| format!("{name}, lap {} s", table::time(raced.lap_s));
    let names = [title("racer's simulator", &here), title("the independent simulator", there)];
    println!("{}\n{}", names[0], names[1]);
    let common = here.path.len().min(there.path.len());
    let apart: Vec<f64> = (0..common).map(|i| distance(&here.path[i], &there.path[i])).collect();
    // Where the way is, whenever it is flown.
    let across: Vec<f64> = there.path.iter().map(|p| nearest(&here.path, p)).collect();
    for (what, distances) in [("at the same time", &apart), ("between the ways", &across)] {
        let [median, most] = [0.5, 1.0].map(|share| quantile(distances, share));
        println!("{what}: median {median:.3} m, most {most:.3} m");
    }
    let paths = [(names[0].as_str(), here.path.as_slice()), (names[1].as_str(), there.path.as_slice())];
    let svg =
        beside::svg(&policy.about.track, &paths, "the nominal vehicle's lap in both simulators").expect("a picture");
    let file = args.svg.as_ref().expect("asked for with the policy");
    racer::base::fsio::write_new(file, svg.as_bytes()).expect("a new file");
}

fn distance(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn nearest(path: &[[f64; 6]], place: &[f64; 6]) -> f64 {
    path.iter().map(|p| distance(p, place)).fold(f64::INFINITY, f64::min)
}
