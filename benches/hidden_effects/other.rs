//! The third truth: what is hidden in which of its flights.

use crate::args::Args;
use crate::case::Group;
use crate::extended::Extended;
use crate::judge::Judged;
use crate::rows::Row;
use crate::run::{self, Folder};
use crate::truth::effects::{Hidden, log_range};
use crate::truth::hidden::Setting;
use crate::truth::other::{Airframe, causes, fly};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Share of its smallest size that a cause has which nobody would notice.
const SMALL: f64 = 0.15;

/// Draws, flies, diagnoses and judges log `number`.
pub fn case(number: usize, args: &Args) -> Judged {
    let seed = args.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (number as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mut rng = StdRng::seed_from_u64(seed);
    let airframe = Airframe::draw(rng.random());
    let setting = Setting {
        seed: rng.random(),
        seconds: args.seconds,
        noise: log_range(&mut rng, 0.5, 1.5),
        imu_hz: [250.0, 500.0, 1000.0][rng.random_range(0..3)],
        style: args.style_of(number),
    };
    let (group, hidden) = match &args.only {
        Some(only) if only == "none" => (Group::None, Vec::new()),
        Some(only) => (Group::One, vec![causes::draw(only, args.size.unwrap_or(1.0), &mut rng)]),
        None => drawn(&mut rng),
    };
    let folder = Folder::new(args, &format!("{number:04}"));
    let log = fly(&airframe, &hidden, &setting);
    let (answer, seconds) = run::diagnose(args, &folder.path, &log, &airframe.nominal().in_racer());
    // Its rate loop is no fault, whatever is hidden besides.
    let own = causes::OWN.into_iter().filter(|name| hidden.iter().all(|h| !h.is(name)));
    let before = own.map(str::to_string).collect();
    let unseen = |setting: &Setting| fly(&airframe, &hidden, setting);
    let extended = Extended::of(args, &folder.path, &setting, unseen);
    let judged = Judged { group, hidden, before, answer, seconds, extended };
    if args.keep.is_some() {
        let truth = format!("{}\n{airframe:#?}\n{setting:#?}\n", judged.line());
        std::fs::write(folder.path.join("truth.txt"), truth).expect("the truth to keep");
    }
    judged
}

fn drawn(rng: &mut StdRng) -> (Group, Vec<Hidden>) {
    match rng.random::<f64>() {
        x if x < 0.25 => (Group::None, Vec::new()),
        x if x < 0.75 => (Group::One, vec![causes::draw(causes::any(rng).id, 1.0, rng)]),
        x if x < 0.85 => (Group::Two, causes::pair(rng).map(|kind| causes::draw(kind.id, 1.0, rng)).into()),
        x if x < 0.93 => {
            let kind = &causes::OUTSIDE[rng.random_range(0..causes::OUTSIDE.len())];
            (Group::Outside, vec![causes::draw(kind.id, 1.0, rng)])
        }
        _ => (Group::Small, vec![causes::draw(causes::small(rng).id, SMALL, rng)]),
    }
}
