//! `--plan`: a flight of few manoeuvres leaves causes tied; the plan that the program makes of it is flown in the same
//! truth, and both flights together have to name the right cause alone.

use crate::answer::{Answer, Finding, Status};
use crate::args::Args;
use crate::judge::Judged;
use crate::rows::Row;
use crate::run::{self, Folder, LOG, VEHICLE};
use crate::truth::Vehicle;
use crate::truth::effects::{Hidden, catalogue, log_range};
use crate::truth::hidden::{Setting, Style, fly_as};
use racer::flight::Log;
use racer::flight::pilot::Manoeuvre;
use racer::flight::planned::FlightPlan;
use racer::model::effects;
use rand::rngs::StdRng;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::time::Instant;

const NEXT: &str = "next.mcap";
const PLAN: &str = "plan.toml";
const OUT: &str = "out.json";
/// Kinds of manoeuvres of the first flight, and its length, s.
const KINDS: [usize; 2] = [1, 3];
const FIRST_S: f64 = 45.0;

/// A flight, what the program made of it, and what came of its plan.
#[derive(Debug)]
pub struct Planned {
    pub hidden: Hidden,
    pub flown: Vec<&'static str>,
    pub before: Result<Answer, String>,
    /// Where the truth is among what was tied: the plan, its length (s), and what both flights showed.
    pub after: Option<Result<After, String>>,
    pub seconds: f64,
}

#[derive(Debug)]
pub struct After {
    pub plan: String,
    pub plan_s: f64,
    pub answer: Answer,
}

/// Draws, flies and judges case `number`.
pub fn case(number: usize, args: &Args) -> Planned {
    let seed = args.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (number as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mut rng = StdRng::seed_from_u64(seed);
    let vehicle = Vehicle::draw(rng.random());
    let noise = log_range(&mut rng, 0.5, 2.0);
    let imu_hz = log_range(&mut rng, 200.0, 1000.0).round();
    let mut setting = |seconds: f64| Setting { seed: rng.random(), seconds, noise, imu_hz, style: Style::Excited };
    let [first, next] = [setting(FIRST_S), setting(0.0)];
    let id = args.only.clone().unwrap_or_else(|| catalogue::any(&mut rng).into());
    let hidden = match args.size {
        Some(size) => Hidden::sized(&id, size, &vehicle, &mut rng),
        None => Hidden::draw(&id, &vehicle, &mut rng),
    };
    let mut kinds = Manoeuvre::ALL.to_vec();
    kinds.shuffle(&mut rng);
    kinds.truncate(rng.random_range(KINDS[0]..=KINDS[1]));
    let folder = Folder::new(args, &format!("{number:04}"));
    let start = Instant::now();
    let log = fly_as(&vehicle, std::slice::from_ref(&hidden), &first, |pilot| pilot.only(&kinds));
    let fly = |order: &[Manoeuvre], seconds: f64| {
        let setting = Setting { seconds, ..next };
        fly_as(&vehicle, std::slice::from_ref(&hidden), &setting, |pilot| pilot.in_order(order))
    };
    let before = ask(args, &folder.path, &log, &vehicle);
    let tied = before.as_ref().is_ok_and(|answer| is_tied(&hidden, answer));
    let after = tied.then(|| planned(args, &folder.path, &fly));
    let flown = kinds.iter().map(|kind| kind.name()).collect();
    let planned = Planned { hidden, flown, before, after, seconds: start.elapsed().as_secs_f64() };
    if args.keep.is_some() {
        std::fs::write(folder.path.join("truth.txt"), format!("{}\n{planned:#?}\n", planned.line()))
            .expect("the truth");
    }
    planned
}

/// Whether the truth is among causes that the answer does not tell apart.
fn is_tied(hidden: &Hidden, answer: &Answer) -> bool {
    let mine = |id: &str| hidden.is(id);
    let open = |f: &&Finding| {
        let rivals = effects::card(&f.effect).map(effects::rivals).unwrap_or_default();
        match f.status {
            Status::NamedSet => f.members.iter().any(|m| mine(m)),
            Status::Suspected => mine(&f.effect) || rivals.into_iter().any(mine),
            _ => false,
        }
    };
    !answer.findings.iter().any(|f| f.status == Status::Named && mine(&f.effect))
        && answer.findings.iter().any(|f| open(&f))
}

/// The first answer, and the plan beside it.
fn ask(args: &Args, folder: &Path, log: &Log, base: &Vehicle) -> Result<Answer, String> {
    let base = racer::model::vehicle::Vehicle { name: "base".into(), ..base.in_racer() };
    run::write(folder, log);
    std::fs::write(folder.join(VEHICLE), toml::to_string(&base).expect("a vehicle is TOML")).expect("the vehicle");
    diagnosed(args, folder, &["diagnose", LOG, "--vehicle", VEHICLE, "--json", OUT])
}

fn diagnosed(args: &Args, folder: &Path, arguments: &[&str]) -> Result<Answer, String> {
    let _ = std::fs::remove_file(folder.join(OUT));
    run::run(args, folder, arguments)?;
    let text = std::fs::read_to_string(folder.join(OUT)).map_err(|error| error.to_string())?;
    Answer::read(&text)
}

/// Asks for the plan, flies it, and diagnoses both flights.
fn planned(args: &Args, folder: &Path, fly: &dyn Fn(&[Manoeuvre], f64) -> Log) -> Result<After, String> {
    let _ = std::fs::remove_file(folder.join(PLAN));
    diagnosed(args, folder, &["diagnose", LOG, "--vehicle", VEHICLE, "--json", OUT, "--plan-out", PLAN])?;
    let text = std::fs::read_to_string(folder.join(OUT)).map_err(|error| error.to_string())?;
    let json: serde_json::Value = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let plan_s = json["plan"]["seconds"].as_f64().ok_or("no plan")?;
    let plan = FlightPlan::read(&folder.join(PLAN)).map_err(|error| error.to_string())?;
    let log = fly(&plan.order(), 1.3 * plan_s + 20.0);
    let bytes = racer::flight::write::mcap(&log).map_err(|error| error.to_string())?;
    std::fs::write(folder.join(NEXT), bytes).map_err(|error| error.to_string())?;
    let answer = diagnosed(args, folder, &["diagnose", LOG, NEXT, "--vehicle", VEHICLE, "--json", OUT])?;
    let one = |m: &racer::flight::planned::PlannedManoeuvre| format!("{}x{}", m.name, m.count);
    let plan = plan.manoeuvre.iter().map(one).collect::<Vec<_>>().join(" ");
    Ok(After { plan, plan_s, answer })
}

impl Planned {
    pub fn tied(&self) -> bool {
        self.after.is_some()
    }

    pub fn answer(&self) -> Option<&Answer> {
        Some(&self.after.as_ref()?.as_ref().ok()?.answer)
    }

    /// Whether both flights name the right cause, and nothing else, and not as one of several.
    pub fn apart(&self) -> bool {
        let Some(answer) = self.answer() else { return false };
        let named: Vec<&Finding> = answer.named().collect();
        !named.is_empty() && named.iter().all(|f| f.status == Status::Named && self.hidden.is(&f.effect))
    }

    /// Whether it is named, whatever else is.
    pub fn right(&self) -> bool {
        self.answer().is_some_and(|a| a.named().any(|f| f.status == Status::Named && self.hidden.is(&f.effect)))
    }

    pub fn wrong(&self) -> bool {
        let wrong = |f: &Finding| f.status == Status::Named && !self.hidden.is(&f.effect);
        self.answer().is_some_and(|a| a.named().any(wrong))
    }
}

pub fn said(answer: &Result<Answer, String>) -> String {
    answer.as_ref().map_or_else(|error| format!("FAILED: {error}"), says)
}

pub fn says(answer: &Answer) -> String {
    let said: Vec<String> = answer.findings.iter().map(Judged::say).collect();
    if said.is_empty() { format!("nothing [{}]", answer.verdict) } else { said.join(" ") }
}
