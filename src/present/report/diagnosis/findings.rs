//! What was found, the most important first.

use super::{capital, sentence};
use crate::insight::diagnose::judgement::diagnosis::Diagnosis;
use crate::insight::diagnose::judgement::finding::{Finding, Status, Value};
use crate::model::effects;
use crate::present::report::page::{digits, unit};
use maud::{Markup, html};

pub fn all(d: &Diagnosis) -> Markup {
    html! {
        @if !d.findings.is_empty() { h2 { "Found" } }
        @for (i, finding) in d.findings.iter().enumerate() { (one(i + 1, finding)) }
    }
}

fn one(rank: usize, f: &Finding) -> Markup {
    let suspected = f.status == Status::Suspected;
    html! {
        div class=(if suspected { "finding suspected" } else { "finding" }) id=(f.effect) {
            h3 { (rank) ". " (capital(f.name)) " " code { (f.effect) } " " span class="status" { (status(f)) } }
            p { (sentence(f.sentence)) }
            p {
                @for (i, (name, value)) in f.parameters.iter().enumerate() {
                    @if i > 0 { br; }
                    (parameter(name, value))
                }
            }
            p { (explains(f)) (worth(f)) (format!("{:.0} stretches of flight agree. ", f.stretches)) (impact(f)) }
            (rivals(f))
        }
    }
}

fn status(f: &Finding) -> String {
    let unwritten = f.unwritten().map_or(String::new(), |why| format!(", {why}"));
    match f.status {
        Status::Named => format!("named{unwritten}"),
        Status::NamedSet => format!("one of several{unwritten}"),
        Status::Suspected => format!("suspected only: {}", f.why.as_deref().unwrap_or("too little agrees")),
    }
}

fn parameter(name: &str, v: &Value) -> Markup {
    let width = v.high - v.low;
    html! {
        code { (name) } " = " b { (digits(v.value, width, 2)) " " (unit(&v.unit)) }
        ", 95 % interval " (digits(v.low, width, 2)) " to " (digits(v.high, width, 2))
    }
}

fn explains(f: &Finding) -> String {
    let shares = f.mentioned();
    if shares.is_empty() {
        return String::new();
    }
    let shares = shares.iter().map(|(channel, share)| format!("{:.0} % of {channel}", 100.0 * share));
    format!("It explains, of the power of the error, {}. ", shares.collect::<Vec<_>>().join(", "))
}

/// What leaving it out costs where it was not fitted.
fn worth(f: &Finding) -> String {
    f.gain.get(f.channel).map_or(String::new(), |g| {
        let (before, after) = (digits(g.before, g.before, 3), digits(g.after, g.after, 3));
        format!(
            "On flight not used for fitting, {} is {before} {} off without it and {after} with it. ",
            f.channel,
            unit(g.unit)
        )
    })
}

fn impact(f: &Finding) -> String {
    let sensor = effects::card(f.effect).is_some_and(|card| card.kind == effects::EffectKind::Sensor);
    let size = digits(f.impact, f.impact, 2);
    if sensor {
        format!("Within a second it adds up to an error of {size} m/s.")
    } else {
        format!("After one second, the simulations with and without it are {size} m/s apart.")
    }
}

/// What it may be instead, and what would tell.
fn rivals(f: &Finding) -> Markup {
    let named = |id: &&str| effects::card(id).map_or(id.to_string(), |card| format!("{} ({id})", card.name));
    let list = |ids: &[&str]| ids.iter().map(named).collect::<Vec<_>>().join(", ");
    let others: Vec<&str> = f.members.iter().copied().filter(|id| *id != f.effect).collect();
    html! {
        @if !others.is_empty() {
            p {
                b { "These flights do not tell it from " (list(&others)) "." }
                " To tell them apart, fly " (f.manoeuvre) "."
                @if !f.with.is_empty() {
                    " Its form is not quite any of theirs: with " (list(&f.with)) " it comes nearer."
                }
            }
        } @else if f.status == Status::Suspected {
            p {
                "To be surer, fly " (f.manoeuvre) "."
                @if !f.rivals.is_empty() { " It looks like " (list(&f.rivals)) "." }
            }
        } @else if !f.rivals.is_empty() {
            p class="why" {
                "It could be mistaken for " (list(&f.rivals)) ". What tells them apart: " (f.manoeuvre)
                "."
            }
        }
    }
}
