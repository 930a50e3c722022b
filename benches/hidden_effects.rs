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
#[path = "hidden_effects/extended.rs"]
mod extended;
#[path = "hidden_effects/judge.rs"]
mod judge;
#[path = "hidden_effects/judged_row.rs"]
mod judged_row;
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
#[path = "hidden_effects/rows.rs"]
mod rows;
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
use rows::{Row, Rows};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

fn main() {
    let args = Args::parse();
    println!("{}", args.summary());
    if let Some(wanted) = &args.criteria {
        return criteria::measure(&args, wanted);
    }
    if args.against {
        return pairs::print(&each(&args, |number| pairs::case(number, &args)));
    }
    if args.plan {
        return plan_table::print(&each(&args, |number| plan::case(number, &args)));
    }
    let mut judged = Vec::new();
    if args.tier != Tier::Real {
        judged = drawn(&args);
    }
    if matches!(args.tier, Tier::Real | Tier::All) && args.only.is_none() {
        judged.extend(real::all(&args));
    }
    tables::print(&judged);
}

/// All drawn cases.
fn drawn(args: &Args) -> Vec<Judged> {
    let one = |number| match args.tier {
        Tier::Other => other::case(number, args),
        _ => run::case(&Case::draw(number, args), args),
    };
    each(args, one)
}

/// `--n` cases, `--jobs` at a time, each printed and written as a line when it is done; none that the CSV has already.
fn each<T: Row + Send>(args: &Args, one: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let rows = Rows::open::<T>(args);
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
                    if rows.has(number) {
                        continue;
                    }
                    let judged = one(number);
                    println!("{number:>5}  {}", judged.line());
                    rows.write(number, &judged);
                    done.lock().expect("no thread panics with it").push((number, judged));
                }
            });
        }
    });
    let mut done = done.into_inner().expect("all threads have ended");
    done.sort_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, judged)| judged).collect()
}
