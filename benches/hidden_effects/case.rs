//! What is hidden in which flight.

use crate::args::{Args, Tier};
use crate::truth::Vehicle;
use crate::truth::effects::{Hidden, catalogue, clutter, drifted, log_range, outside, unmatched};
use crate::truth::hidden::Setting;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Kinds of truth, which are scored apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    None,
    /// Nothing hidden, but a parameter of the base vehicle is not the flown one's.
    Drift,
    One,
    Two,
    Unmatched,
    Clutter,
    Outside,
    /// Something that nobody would notice.
    Small,
    Real,
}

impl Group {
    pub fn name(self) -> &'static str {
        match self {
            Group::None => "none",
            Group::Drift => "drift",
            Group::One => "one",
            Group::Two => "two",
            Group::Unmatched => "unmatched",
            Group::Clutter => "clutter",
            Group::Outside => "outside",
            Group::Small => "small",
            Group::Real => "real",
        }
    }
}

/// A flight to be drawn, and its truth.
#[derive(Clone, Debug)]
pub struct Case {
    pub number: usize,
    pub group: Group,
    /// What the program is told, and what flies.
    pub base: Vehicle,
    pub flown: Vehicle,
    /// The dominant one last where there are more than two.
    pub hidden: Vec<Hidden>,
    pub setting: Setting,
}

impl Case {
    /// Case `number` of a run; each is drawn on its own, so that one can be made again.
    pub fn draw(number: usize, args: &Args) -> Self {
        let seed = args.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (number as u64).wrapping_mul(0xd134_2543_de82_ef95);
        let mut rng = StdRng::seed_from_u64(seed);
        let base = Vehicle::draw(rng.random());
        let setting = Setting {
            seed: rng.random(),
            seconds: args.seconds,
            noise: log_range(&mut rng, 0.5, 2.0),
            imu_hz: log_range(&mut rng, 100.0, 1000.0).round(),
            style: args.style_of(number),
        };
        let group = match &args.only {
            Some(only) => group_of(only),
            None => any_group(args.tier, &mut rng),
        };
        let hidden = match &args.only {
            Some(only) => named(only, &base, args, &mut rng),
            None => drawn(group, &base, args.seconds, &mut rng),
        };
        let flown = if group == Group::Drift { drifted(&base, &mut rng) } else { base.clone() };
        Case { number, group, base, flown, hidden, setting }
    }
}

fn any_group(tier: Tier, rng: &mut StdRng) -> Group {
    let matched = |rng: &mut StdRng| match rng.random::<f64>() {
        x if x < 0.2 => Group::None,
        x if x < 0.3 => Group::Drift,
        x if x < 0.8 => Group::One,
        x if x < 0.95 => Group::Two,
        _ => Group::Outside,
    };
    match tier {
        Tier::Matched | Tier::Real | Tier::Other => matched(rng),
        Tier::Unmatched => Group::Unmatched,
        Tier::Clutter => Group::Clutter,
        Tier::Outside => Group::Outside,
        Tier::All => match rng.random::<f64>() {
            x if x < 0.5 => matched(rng),
            x if x < 0.7 => Group::Unmatched,
            x if x < 0.85 => Group::Clutter,
            _ => Group::Outside,
        },
    }
}

fn drawn(group: Group, vehicle: &Vehicle, seconds: f64, rng: &mut StdRng) -> Vec<Hidden> {
    match group {
        Group::None | Group::Drift | Group::Small | Group::Real => Vec::new(),
        Group::One => vec![Hidden::draw(catalogue::any(rng), vehicle, rng)],
        Group::Two => catalogue::pair(rng).map(|id| Hidden::draw(id, vehicle, rng)).into(),
        Group::Unmatched => vec![unmatched::any(vehicle, rng)],
        Group::Clutter => clutter(vehicle, rng),
        Group::Outside => vec![outside::any(seconds, rng)],
    }
}

fn group_of(only: &str) -> Group {
    match only {
        "none" => Group::None,
        "drift" => Group::Drift,
        kind if unmatched::KINDS.contains(&kind) => Group::Unmatched,
        kind if outside::KINDS.contains(&kind) => Group::Outside,
        _ => Group::One,
    }
}

fn named(only: &str, vehicle: &Vehicle, args: &Args, rng: &mut StdRng) -> Vec<Hidden> {
    match group_of(only) {
        Group::Unmatched => vec![unmatched::draw(only, vehicle, rng)],
        Group::Outside => vec![outside::draw(only, args.seconds, rng)],
        Group::One => vec![match args.size {
            Some(size) => Hidden::sized(only, size, vehicle, rng),
            None => Hidden::draw(only, vehicle, rng),
        }],
        _ => Vec::new(),
    }
}
