//! What changed since earlier flights.

use super::{capital, sentence};
use crate::insight::diagnose::against::{Change, Changes};
use crate::insight::diagnose::judgement::finding::Status;
use crate::present::report::page::{digits, unit};
use maud::{Markup, html};

pub fn all(c: &Changes) -> Markup {
    html! {
        p class="verdict" { (sentence(&c.headline())) }
        p class="why" { "Earlier: " (c.before.join(", ")) ". Later: " (c.after.join(", ")) "." }
        @for (i, change) in c.changes.iter().enumerate() { (one(i + 1, change)) }
        @if !c.both.is_empty() {
            @let both: Vec<&str> = c.both.iter().map(|b| b.name).collect();
            p { "Both show alike, so it is the vehicle's: " (both.join(", ")) "." }
        }
        details {
            summary { "Which differences would have shown" }
            table {
                tr { th { "" } th { "seen from" } th { "on its worst axis" } th class="text" { "" } }
                @for w in &c.would_show {
                    tr {
                        td { code { (w.cause) } } td { (digits(w.smallest, w.smallest, 2)) }
                        td { (digits(w.worst_axis, w.worst_axis, 2)) }
                        td class="text" { (unit(w.unit)) }
                    }
                }
            }
        }
    }
}

fn one(rank: usize, c: &Change) -> Markup {
    let status = match c.status {
        Status::Named => "changed".into(),
        Status::NamedSet => format!("or {}: these flights do not tell them apart", c.members[1..].join(", ")),
        Status::Suspected => format!("suspected only: {}", c.why.as_deref().unwrap_or("too little agrees")),
    };
    html! {
        div class=(if c.status == Status::Suspected { "finding suspected" } else { "finding" }) {
            h3 { (rank) ". " (capital(c.name)) " " code { (c.cause) } " " span class="status" { (status) } }
            p { (sentence(c.sentence)) }
            table {
                tr { th { "" } th { "was" } th { "is" } th { "difference" } th { "95 % interval" } }
                @for (name, d) in &c.difference {
                    @let width = d.high - d.low;
                    tr {
                        td { (name) @if d.unit != "1" { ", " (unit(&d.unit)) } }
                        td { @if let Some(v) = c.before.get(name) { (digits(v.value, width, 2)) } }
                        td { @if let Some(v) = c.after.get(name) { (digits(v.value, width, 2)) } }
                        td { (digits(d.value, width, 2)) }
                        td { (digits(d.low, width, 2)) " to " (digits(d.high, width, 2)) }
                    }
                }
            }
            p {
                (format!("{:.0} standard deviations", c.deviations))
                @if let Some(impact) = c.impact { "; " (digits(impact, impact, 2)) " m/s after a second" }
                "."
            }
        }
    }
}
