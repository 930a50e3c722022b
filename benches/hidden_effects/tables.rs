//! The score, printed.

use crate::case::Group;
use crate::judge::{Judged, Scored};
use crate::share::Share;
use racer::base::stats::quantile;
use std::collections::BTreeMap;

pub fn print(all: &[Judged]) {
    println!("\n{} logs", all.len());
    shares(all);
    confusion(all);
    parameters(all);
    // What the catalogue has no name for cannot be gained.
    let gains = |j: &&Judged| !matches!(j.group, Group::Outside | Group::None | Group::Drift);
    let captured: Vec<f64> = all.iter().filter(gains).filter_map(|j| j.answer.as_ref().ok()?.captured).collect();
    if !captured.is_empty() {
        let [median, low] = [0.5, 0.1].map(|at| 100.0 * quantile(&captured, at));
        println!("\ncaptured gain: median {median:.1} %, a tenth below {low:.1} % (of {})", captured.len());
    }
    let times: Vec<f64> = all.iter().map(|j| j.seconds).collect();
    println!("run time: median {:.1} s, worst {:.1} s", quantile(&times, 0.5), quantile(&times, 1.0));
}

/// Each share over the logs that it is about.
fn shares(all: &[Judged]) {
    let share = |name: &str, about: &dyn Fn(&Judged) -> bool, yes: &dyn Fn(&Judged) -> bool| {
        let share = Share::count(all.iter().filter(|j| about(j)).map(yes));
        if share.of > 0 {
            println!("  {name:<52}{}", share.text());
        }
    };
    share("the program failed", &|_| true, &|j| j.answer.is_err());
    share("a confident wrong name", &|_| true, &|j| j.confident_wrong() > 0);
    share("a name with nothing behind it", &|_| true, &|j| !j.spurious().is_empty());
    let none = |j: &Judged| j.group == Group::None;
    let drift = |j: &Judged| j.group == Group::Drift;
    share("clean: a false name", &none, &|j| j.first().is_some());
    share("clean: told to be clean", &none, &|j| j.answer.as_ref().is_ok_and(|a| a.verdict == "clean"));
    share("clean: told to be unexplained", &none, &Judged::unexplained);
    share("drift: a false name", &drift, &|j| j.first().is_some());
    share("drift: told as drift", &drift, &|j| j.answer.as_ref().is_ok_and(|a| a.drift));
    for group in [Group::One, Group::Two, Group::Unmatched, Group::Clutter, Group::Real] {
        let name = group.name();
        let of = |j: &Judged| j.group == group;
        let of_nameable = |j: &Judged| j.group == group && j.nameable();
        share(&format!("{name}: right cause first"), &of, &Judged::first_is_right);
        share(&format!("{name}: right cause first, of those nameable"), &of_nameable, &Judged::first_is_right);
        share(&format!("{name}: first a set with it, led by another"), &of, &Judged::first_set_holds);
        share(&format!("{name}: a wrong name first"), &of, &Judged::first_is_wrong);
        share(&format!("{name}: missed"), &of, &Judged::missed);
        share(&format!("{name}: missed, of those nameable"), &of_nameable, &Judged::missed);
        share(&format!("{name}: told to be unexplained"), &of, &Judged::unexplained);
    }
    let two = |j: &Judged| j.group == Group::Two;
    share("two: both named", &two, &|j| j.found()[0] == 2);
    share("two: both named or in a named set", &two, &|j| j.found()[1] == 2);
    let small = |j: &Judged| j.group == Group::Small;
    share("small: a name with nothing behind it", &small, &|j| !j.spurious().is_empty());
    let hidden = |j: &Judged| matches!(j.group, Group::One | Group::Two);
    share("one or two: right cause first", &hidden, &Judged::first_is_right);
    share("one or two: every cause named or in a set", &hidden, &|j| j.found()[1] == j.hidden.len());
    share("one that would show, by the report: does", &|j| j.promised(), &Judged::shown);
    let outside = |j: &Judged| j.group == Group::Outside;
    share("outside: told to be unexplained", &outside, &Judged::unexplained);
    share("outside: given a name", &outside, &|j| j.first().is_some());
}

/// What each truth was first called.
fn confusion(all: &[Judged]) {
    println!("\n{:<26}{:>4}  first named", "truth", "logs");
    let mut rows: BTreeMap<(Group, String), BTreeMap<String, usize>> = BTreeMap::new();
    for judged in all.iter().filter(|j| j.answer.is_ok()) {
        let said = match judged.first() {
            Some(first) if judged.first_set_holds() => format!("set of {} with it", first.effect),
            Some(first) => first.effect.clone(),
            None if judged.unexplained() => "(unexplained)".into(),
            None if judged.wanted().is_empty() || judged.group == Group::Outside => "(nothing)".into(),
            None if judged.nameable() => "(missed)".into(),
            None => "(not detectable)".into(),
        };
        // Of two, each has a row: what it is confused with shows in those of one.
        let truths = if judged.group == Group::Two { Vec::new() } else { judged.wanted().to_vec() };
        let names = match (judged.group, truths.as_slice()) {
            (Group::Two, _) => vec!["two effects".to_string()],
            (group, []) => vec![group.name().to_string()],
            (_, truths) => truths.iter().map(|truth| truth.id.clone()).collect(),
        };
        let said = if judged.group == Group::Two && judged.first_is_right() { "one of them".into() } else { said };
        for name in names {
            *rows.entry((judged.group, name)).or_default().entry(said.clone()).or_default() += 1;
        }
    }
    for ((_, truth), said) in rows {
        let mut said: Vec<_> = said.into_iter().collect();
        said.sort_by_key(|(name, count)| (usize::from(*name != truth), usize::MAX - count));
        let logs: usize = said.iter().map(|(_, count)| count).sum();
        let list: Vec<_> = said.iter().map(|(name, count)| format!("{name} {count}")).collect();
        println!("{truth:<26}{logs:>4}  {}", list.join(", "));
    }
}

fn parameters(all: &[Judged]) {
    let scored: Vec<Scored> = all.iter().flat_map(Judged::parameters).collect();
    if scored.is_empty() {
        return;
    }
    let mut by_name: BTreeMap<&str, Vec<&Scored>> = BTreeMap::new();
    for one in &scored {
        by_name.entry(&one.name).or_default().push(one);
    }
    println!(
        "\n{:<34}{:>5}{:>12}{:>12}  inside the interval",
        "parameter, named rightly", "n", "median, %", "worst, %"
    );
    let print = |name: &str, of: &[&Scored]| {
        let errors: Vec<f64> = of.iter().map(|one| 100.0 * one.error.abs()).collect();
        let inside = Share::count(of.iter().filter_map(|one| one.inside));
        let [median, worst] = [0.5, 1.0].map(|at| quantile(&errors, at));
        println!("{name:<34}{:>5}{median:>12.1}{worst:>12.1}  {}", of.len(), inside.text());
    };
    for (name, of) in &by_name {
        print(name, of);
    }
    print("all", &scored.iter().collect::<Vec<_>>());
}
