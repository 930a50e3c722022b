//! What `racer diagnose` finds of effects that an independent simulator hid: `cargo bench --bench hidden_effects -- --n
//! 300`.
//!
//! Each log is drawn, flown, written under a neutral name beside the vehicle without effects, and given to the shipped
//! program; its JSON is all that is scored. The truth never touches the folder before the program has ended.

#[path = "hidden_effects/answer.rs"]
mod answer;
#[path = "hidden_effects/args.rs"]
mod args;
#[path = "hidden_effects/case.rs"]
mod case;
#[path = "hidden_effects/criteria.rs"]
mod criteria;
#[path = "hidden_effects/judge.rs"]
mod judge;
#[path = "hidden_effects/other.rs"]
mod other;
#[path = "hidden_effects/pairs.rs"]
mod pairs;
#[path = "hidden_effects/plan.rs"]
mod plan;
#[path = "hidden_effects/plan_table.rs"]
mod plan_table;
#[path = "hidden_effects/real.rs"]
mod real;
#[path = "hidden_effects/run.rs"]
mod run;
#[path = "hidden_effects/share.rs"]
mod share;
#[path = "hidden_effects/tables.rs"]
mod tables;
#[path = "../tests/truth/mod.rs"]
mod truth;

use args::{Args, Tier};
use case::Case;
use clap::Parser;
use judge::Judged;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

fn main() {
    let args = Args::parse();
    println!("{}", args.summary());
    if let Some(wanted) = &args.criteria {
        return criteria::measure(&args, wanted);
    }
    if args.against {
        let pairs = each(&args, |number| pairs::case(number, &args), pairs::Pair::line);
        pairs::print(&pairs);
        return args.csv.iter().for_each(|path| pairs::write(path, &pairs));
    }
    if args.plan {
        let planned = each(&args, |number| plan::case(number, &args), plan::Planned::line);
        plan_table::print(&planned);
        return args.csv.iter().for_each(|path| plan_table::write(path, &planned));
    }
    let mut judged = Vec::new();
    if args.tier != Tier::Real {
        judged = drawn(&args);
    }
    if matches!(args.tier, Tier::Real | Tier::All) && args.only.is_none() {
        judged.extend(real::all(&args));
    }
    tables::print(&judged);
    if let Some(path) = &args.csv {
        other::write(path, &judged);
    }
}

/// All drawn cases.
fn drawn(args: &Args) -> Vec<Judged> {
    let one = |number| match args.tier {
        Tier::Other => other::case(number, args),
        _ => run::case(&Case::draw(number, args), args),
    };
    each(args, one, Judged::line)
}

/// `--n` cases, `--jobs` at a time, each printed as a line when it is done.
fn each<T: Send>(args: &Args, one: impl Fn(usize) -> T + Sync, line: impl Fn(&T) -> String + Sync) -> Vec<T> {
    let next = AtomicUsize::new(args.from);
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..args.jobs.max(1) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= args.from + args.n {
                        return;
                    }
                    let judged = one(number);
                    println!("{number:>5}  {}", line(&judged));
                    done.lock().expect("no thread panics with it").push((number, judged));
                }
            });
        }
    });
    let mut done = done.into_inner().expect("all threads have ended");
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, judged)| judged).collect()
}
