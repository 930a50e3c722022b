//! Whether a policy that was trained in the vehicle that `racer diagnose --extend` writes flies better where the effect
//! is real:
//! `cargo bench --bench retraining -- --effects rate_delay,voltage_sag,axial_inflow --minutes 2 --seeds 1`.
//!
//! An effect is hidden in an independent simulator, a flight there is logged and given to the shipped program beside
//! the vehicle without the effect, policies are trained with the same budget in that vehicle and in the extended one,
//! and both race in the independent simulator. The control is the first policy's race there without the effect.
//!
//! With `--by-motor` that simulator is a quadrotor motor by motor under its flight controller, whose compact model is
//! the base: `--by-motor --effects inflow_root=1,throttle_link=0.025,stick_filter=0.012`.
//!
//! `cargo bench --bench retraining -- --policy RUN --svg lap.svg` races a policy that is there in both simulators, and
//! draws the laps.

#[path = "retraining/args.rs"]
mod args;
#[path = "retraining/beside.rs"]
mod beside;
#[path = "retraining/program.rs"]
mod program;
#[path = "retraining/race.rs"]
mod race;
#[path = "hidden_effects/share.rs"]
mod share;
#[path = "retraining/sizes.rs"]
mod sizes;
#[path = "retraining/table.rs"]
mod table;
#[path = "../tests/truth/mod.rs"]
mod truth;
#[path = "retraining/truths.rs"]
mod truths;
#[path = "retraining/vehicles.rs"]
mod vehicles;

use args::Args;
use clap::Parser;
use program::Folder;
use racer::race::snapshot::Snapshot;
use table::Row;
use truth::hidden::{Setting, Style};
use vehicles::Truths;

fn main() {
    let args = Args::parse();
    if let Some(policy) = &args.policy {
        return beside::show(&args, policy);
    }
    println!("{}", args.summary());
    let truths = Truths::of(&args);
    let folder = Folder::new(&args);
    let mut rows = Vec::new();
    let show = |row: Row, rows: &mut Vec<Row>| {
        println!("{}", row.line());
        rows.push(row);
    };
    // The base vehicle knows no effect: one policy of a seed serves all.
    folder.write_base(&truths.base());
    let policies: Vec<(u64, Snapshot)> =
        (1..=args.seeds).map(|seed| (seed, folder.train("base.toml", &format!("base-{seed}"), seed))).collect();
    println!("{}", table::HEADER);
    for (seed, policy) in &policies {
        let flights = race::race(policy, &*truths.world(&[]), &args);
        let simulated = folder.evaluate(&format!("base-{seed}"), "base.toml", "none");
        let row = Row { effect: "none".into(), size: 0.0, seed: *seed, trained: "base", flights, simulated };
        show(row, &mut rows);
        let [there, here] = [rows[rows.len() - 1].flights[0].lap_s, race::in_racer(policy).lap_s];
        println!(
            "  the nominal agent's lap: {} s, in racer's own simulator {} s",
            table::time(there),
            table::time(here)
        );
    }
    for (id, size) in args.cases() {
        let hidden: Vec<_> = truths.hidden(&id, size).into_iter().collect();
        let setting = Setting { seed: 1, seconds: args.seconds, noise: 1.0, imu_hz: 500.0, style: Style::Excited };
        let (extended, found) = folder.diagnose(&id, &truths.fly(&hidden, &setting));
        println!("{id} {size}: {found}");
        let world = truths.world(&hidden);
        for (seed, policy) in &policies {
            let seed = *seed;
            let row = |trained, flights, simulated| Row { effect: id.clone(), size, seed, trained, flights, simulated };
            let evaluate = |run: &str| folder.evaluate(run, extended.as_ref()?, &id);
            let flights = race::race(policy, &*world, &args);
            show(row("base", flights, evaluate(&format!("base-{seed}"))), &mut rows);
            if let Some(extended) = &extended {
                let run = format!("{id}-{seed}");
                let policy = folder.train(extended, &run, seed);
                show(row("extended", race::race(&policy, &*world, &args), evaluate(&run)), &mut rows);
            }
        }
    }
    table::print(&rows);
    args.csv.iter().for_each(|path| table::write(path, &rows));
}
