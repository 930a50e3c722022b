//! `--against`: two flights of one vehicle of the third truth, half of them without a change between the two.

use crate::args::Args;
use crate::rows::Row;
use crate::run::{self, Folder, VEHICLE};
use crate::share::Share;
use crate::truth::effects::{Hidden, log_range};
use crate::truth::hidden::Setting;
use crate::truth::other::{Airframe, causes, fly};
use racer::base::stats::quantile;
use racer::flight::Log;
use racer::insight::diagnose::against::{Change, by_motors};
use racer::insight::diagnose::motor_loop::{motor_loop, together};
use racer::insight::quality::check;
use racer::model::vehicle::Vehicle;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::path::Path;
use std::time::Instant;

const EARLIER: &str = "earlier.mcap";
const LATER: &str = "later.mcap";
const OUT: &str = "out.json";

/// What a workshop does to the airframe: its name, right names, and the share that it changes a number by.
const WORK: [(&str, &[&str], [f64; 2]); 6] = [
    ("propellers", &["thrust", "mass_or_density"], [0.06, 0.2]),
    ("guards", &["drag"], [0.3, 0.8]),
    (
        "slow_motors",
        &["thrust_response", "thrust_delay", "rate_response", "rate_delay", "rate_second_order"],
        [0.3, 0.8],
    ),
    ("gains", &["rate_gains", "rate_response", "yaw_response", "rate_delay", "rate_second_order"], [0.25, 0.5]),
    ("rate_profile", &["full_stick_rates"], [0.1, 0.3]),
    ("old_pack", &["discharge"], [0.3, 0.8]),
];

/// Names that are right besides those of the catalogue: the compact model's own number is what changed.
const ALSO: [(&str, &[&str]); 9] = [
    ("payload", &["thrust"]),
    ("thin_air", &["thrust"]),
    ("motor_braking", &["thrust_response"]),
    ("esc_slew", &["thrust_response"]),
    ("throttle_filter", &["thrust_response"]),
    ("stick_filter", &["rate_response"]),
    ("low_authority", &["rate_response", "turning_authority"]),
    ("weak_yaw", &["yaw_response", "turning_authority"]),
    ("drag_linear", &["drag"]),
];

/// Causes that have no direction of their own, so that both flights have the same; and those that are no change: what
/// has no mean, and a gyro's constant error of a size that every switching on brings.
const ALIKE: [&str; 12] = [
    "drag_root",
    "drag_linear",
    "inflow_root",
    "climb_power",
    "nose_lift",
    "nose_drag",
    "throttle_link",
    "stick_filter",
    "super_rate",
    "load_power",
    "vibration_speed",
    "velocity_delay",
];
const NO_CHANGE: [&str; 3] = ["stirred_air", "link_jitter", "gyro_warm"];

/// What differs between the flights of a pair.
#[derive(Debug)]
struct Changed {
    id: String,
    size: f64,
    right: Vec<String>,
    /// Whether the earlier flight has it: it was mended.
    mended: bool,
}

/// A pair, and what the program said.
#[derive(Debug)]
pub struct Pair {
    changed: Option<Changed>,
    both: String,
    /// Names with their status, and the members of the first; or how it failed.
    said: Result<Vec<(String, String)>, String>,
    members: Vec<String>,
    /// Whether it said that a right name could not have shown in these flights.
    could_not_show: bool,
    seconds: f64,
}

/// Draws, flies and judges pair `number`.
pub fn case(number: usize, args: &Args) -> Pair {
    let seed = args.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (number as u64).wrapping_mul(0x94d0_49bb_1331_11eb);
    let mut rng = StdRng::seed_from_u64(seed);
    let airframe = Airframe::draw(rng.random());
    let noise = log_range(&mut rng, 0.5, 1.5);
    let imu_hz = [250.0, 500.0, 1000.0][rng.random_range(0..3)];
    let style = args.style_of(number);
    let mut setting = || Setting { seed: rng.random(), seconds: args.seconds, noise, imu_hz, style };
    let settings = [setting(), setting()];
    let both: Vec<Hidden> = if rng.random_bool(0.5) {
        vec![causes::draw(ALIKE[rng.random_range(0..ALIKE.len())], 1.0, &mut rng)]
    } else {
        Vec::new()
    };
    let mut airframes = [airframe.clone(), airframe.clone()];
    let mut hidden = [both.clone(), both.clone()];
    let changed = (number % 2 == 1 || args.only.is_some()).then(|| {
        let mended = rng.random_bool(0.5);
        let at = usize::from(!mended);
        let (id, size, right) = change(args, &both, &mut airframes[at], &mut hidden[at], &mut rng);
        Changed { id, size, right, mended }
    });
    let folder = Folder::new(args, &format!("{number:04}"));
    let logs: Vec<Log> = (0..2).map(|i| fly(&airframes[i], &hidden[i], &settings[i])).collect();
    let nominal = Vehicle { name: "base".into(), ..airframe.nominal().in_racer() };
    let start = Instant::now();
    let answer = if args.by_motors { Ok(by_motors(&logs)) } else { ask(args, &folder.path, &logs, &nominal) };
    let both = both.iter().map(|h| format!("{}={:.3}", h.id, h.size)).collect::<Vec<_>>().join(" ");
    let Said { names, members, hidden } = answer.as_ref().cloned().unwrap_or_default();
    let could_not_show = changed.as_ref().is_some_and(|c| c.right.iter().all(|name| hidden.contains(name)));
    let (said, seconds) = (answer.map(|_| names), start.elapsed().as_secs_f64());
    let pair = Pair { changed, both, said, members, could_not_show, seconds };
    if args.keep.is_some() {
        let truth = format!("{}\n{pair:#?}\n{airframe:#?}\n{settings:#?}\n", pair.line());
        std::fs::write(folder.path.join("truth.txt"), truth).expect("the truth to keep");
    }
    pair
}

/// Changes one flight: its airframe or what is hidden in it. The name, the size and the right names.
fn change(
    args: &Args,
    both: &[Hidden],
    airframe: &mut Airframe,
    hidden: &mut Vec<Hidden>,
    rng: &mut StdRng,
) -> (String, f64, Vec<String>) {
    let own = |names: &[&str]| names.iter().map(|name| name.to_string()).collect::<Vec<_>>();
    let work = WORK.iter().find(|(id, ..)| args.only.as_deref() == Some(id));
    let by_chance = args.only.is_none() && rng.random_bool(0.35);
    let work = work.or(by_chance.then(|| &WORK[rng.random_range(0..WORK.len())]));
    if let Some((id, right, [low, high])) = work {
        let share = log_range(rng, *low, *high);
        match *id {
            "propellers" => airframe.full_n *= 1.0 - share,
            "guards" => airframe.drag_coefficient *= 1.0 + share,
            "slow_motors" => airframe.motor_s *= 1.0 + share,
            "gains" => airframe.bandwidth = airframe.bandwidth.map(|b| b * (1.0 - share)),
            "rate_profile" => airframe.max_rate = airframe.max_rate.map(|r| r * (1.0 - share)),
            _ => airframe.discharge *= 1.0 + share,
        }
        return (id.to_string(), share, own(right));
    }
    let drawn = loop {
        let id = args.only.clone().unwrap_or_else(|| causes::any(rng).id.to_string());
        let drawn = causes::draw(&id, 1.0, rng);
        let same = both.iter().any(|b| b.right.iter().any(|name| drawn.right.contains(name)));
        if args.only.is_some() || !same && !NO_CHANGE.contains(&id.as_str()) {
            break drawn;
        }
    };
    let mut right: Vec<String> = drawn.right.iter().map(|name| name.to_string()).collect();
    right.extend(ALSO.iter().filter(|(id, _)| *id == drawn.id).flat_map(|(_, names)| own(names)));
    let (id, size) = (drawn.id.clone(), drawn.size);
    hidden.push(drawn);
    (id, size, right)
}

/// Names with their status, the members of the first, and what could not have shown.
#[derive(Clone, Debug, Default)]
struct Said {
    names: Vec<(String, String)>,
    members: Vec<String>,
    hidden: Vec<String>,
}

/// What the motors alone tell.
fn by_motors(logs: &[Log]) -> Said {
    let set = |log: &Log| {
        let quality = check(log);
        together(&[motor_loop(&quality.log, &quality.usable)])
    };
    let mut changes = Vec::new();
    if let (Some(before), Some(after)) = (set(&logs[0]), set(&logs[1])) {
        by_motors::add(&[before, after], &mut changes);
    }
    changes.sort_by(|a, b| b.deviations.total_cmp(&a.deviations));
    let status = |c: &Change| if c.members.len() > 1 { "named_set" } else { "named" };
    let names = changes.iter().map(|c| (c.cause.to_string(), status(c).to_string())).collect();
    let members = changes.first().map_or(Vec::new(), |c| c.members.iter().map(|m| m.to_string()).collect());
    Said { names, members, hidden: Vec::new() }
}

fn ask(args: &Args, folder: &Path, logs: &[Log], base: &Vehicle) -> Result<Said, String> {
    for (name, log) in [EARLIER, LATER].into_iter().zip(logs) {
        let bytes = racer::flight::write::mcap(log).map_err(|error| error.to_string())?;
        std::fs::write(folder.join(name), bytes).map_err(|error| error.to_string())?;
    }
    std::fs::write(folder.join(VEHICLE), toml::to_string(base).expect("a vehicle is TOML")).expect("the vehicle");
    let _ = std::fs::remove_file(folder.join(OUT));
    run::run(args, folder, &["diagnose", LATER, "--against", EARLIER, "--vehicle", VEHICLE, "--json", OUT])?;
    let text = std::fs::read_to_string(folder.join(OUT)).map_err(|error| error.to_string())?;
    let json: Value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let list = json["changes"]["changes"].as_array().ok_or("no changes in the answer")?;
    let text = |v: &Value| v.as_str().unwrap_or_default().to_string();
    let names = list.iter().map(|c| (text(&c["cause"]), text(&c["status"]))).collect();
    let members = list.first().and_then(|c| c["members"].as_array()).map(|m| m.iter().map(text).collect());
    let would_show = json["changes"]["would_show"].as_array().ok_or("no smallest changes in the answer")?;
    let too_small = |w: &&Value| w["large"].as_f64().is_some_and(|large| w["smallest"].as_f64().unwrap_or(0.0) > large);
    let hidden = would_show.iter().filter(too_small).map(|w| text(&w["cause"])).collect();
    Ok(Said { names, members: members.unwrap_or_default(), hidden })
}

impl Pair {
    fn named(&self) -> Vec<&str> {
        let said = self.said.iter().flatten().filter(|(_, status)| status != "suspected");
        said.map(|(name, _)| name.as_str()).collect()
    }

    fn is_right(&self, name: &str) -> bool {
        self.changed.as_ref().is_some_and(|c| c.right.iter().any(|right| right == name))
    }

    fn first_is_right(&self) -> bool {
        self.named().first().is_some_and(|first| self.is_right(first))
    }

    fn first_set_holds(&self) -> bool {
        !self.named().is_empty() && self.members.iter().any(|member| self.is_right(member))
    }
}

impl Row for Pair {
    const COLUMNS: &'static [&'static str] =
        &["changed", "size", "mended", "both", "said", "first_right", "first_or_set", "could_not_show", "seconds"];

    fn fields(&self) -> Vec<String> {
        let (id, size, mended) =
            self.changed.as_ref().map_or((String::new(), 0.0, false), |c| (c.id.clone(), c.size, c.mended));
        let said: Vec<String> = self.said.iter().flatten().map(|(name, status)| format!("{name}:{status}")).collect();
        let flag = |yes: bool| usize::from(yes).to_string();
        vec![
            id,
            format!("{size:.4}"),
            flag(mended),
            self.both.clone(),
            self.said.as_ref().err().cloned().unwrap_or(said.join(" ")),
            flag(self.first_is_right()),
            flag(self.first_is_right() || self.first_set_holds()),
            flag(self.could_not_show),
            format!("{:.1}", self.seconds),
        ]
    }

    fn line(&self) -> String {
        let truth = self.changed.as_ref().map_or("unchanged".into(), |c| {
            format!("{} {:.3}{}", c.id, c.size, if c.mended { " (mended)" } else { "" })
        });
        let said = match &self.said {
            Ok(said) => {
                let one = |(name, status): &(String, String)| match status.as_str() {
                    "suspected" => format!("{name}?"),
                    "named_set" => format!("{name} (set)"),
                    _ => name.clone(),
                };
                said.iter().map(one).collect::<Vec<_>>().join(" ")
            }
            Err(error) => format!("FAILED: {error}"),
        };
        let judgement = match (&self.changed, self.named().is_empty()) {
            (None, true) => "right",
            (None, false) => "FALSE CHANGE",
            (Some(_), true) if self.could_not_show => "could not show",
            (Some(_), true) => "MISSED",
            _ if self.first_is_right() => "right",
            _ if self.first_set_holds() => "in the set",
            _ => "WRONG FIRST",
        };
        format!("{truth}  both: {}  ->  {said}  {judgement}  {:.1} s", self.both, self.seconds)
    }
}

/// Prints the shares.
pub fn print(all: &[Pair]) {
    println!("\n{} pairs of flights", all.len());
    let share = |name: &str, about: &dyn Fn(&Pair) -> bool, yes: &dyn Fn(&Pair) -> bool| {
        println!("  {name:<52}{}", Share::count(all.iter().filter(|p| about(p)).map(yes)).text());
    };
    let changed = |p: &Pair| p.changed.is_some();
    let same = |p: &Pair| p.changed.is_none();
    share("the program failed", &|_| true, &|p| p.said.is_err());
    share("unchanged: a false change", &same, &|p| !p.named().is_empty());
    share("changed: the change first", &changed, &Pair::first_is_right);
    share("changed: first, or in its set", &changed, &|p| p.first_is_right() || p.first_set_holds());
    share("changed, of what could show: the change first", &|p| changed(p) && !p.could_not_show, &Pair::first_is_right);
    share("changed: told that something changed", &changed, &|p| !p.named().is_empty());
    share("changed: a wrong name first", &changed, &|p| {
        !p.named().is_empty() && !p.first_is_right() && !p.first_set_holds()
    });
    let times: Vec<f64> = all.iter().map(|p| p.seconds).collect();
    println!("run time: median {:.1} s, worst {:.1} s", quantile(&times, 0.5), quantile(&times, 1.0));
}
