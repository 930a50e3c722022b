//! A diagnosis as one page that needs nothing else: the verdict, what was found, what it is worth, what is left,
//! figures.

mod changes;
mod figures;
mod findings;
mod tables;

pub use figures::{DiagnosisFigures, Figure};

use super::page::{self, digits, unit};
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::judgement::diagnosis::Diagnosis;
use maud::{Markup, PreEscaped, html};
use std::path::Path;

const STYLE: &str = ".verdict{font-size:1.25em}.finding{border-left:4px solid #0072b2;padding-left:1em;margin:1.5em 0}
.finding.suspected{border-color:#999}.finding h3{margin:0}.finding p{margin:.4em 0}
.status{font-weight:normal;color:#555}
figure{margin:1.5em 0}figcaption{color:#555}code{font-size:.9em}td.text,th.text{text-align:left}
summary{cursor:pointer}";

/// The page as HTML.
pub fn page(diagnosed: &Diagnosed, figures: &DiagnosisFigures) -> String {
    let d = &diagnosed.diagnosis;
    let body = html! {
        h1 { "What the simulation of " (d.base) " gets wrong" }
        @if let Some(changes) = &diagnosed.changes { (changes::all(changes)) h2 { "The later flights by themselves" } }
        p class="verdict" { (sentence(&d.headline())) }
        p class="why" {
            (format!("Diagnosed by racer {} from {}.", env!("CARGO_PKG_VERSION"), logs(d)))
            " Before means the compact model, fitted to these flights together with the constant errors of the IMU; \
             after, the same with what was found."
        }
        (left_out(d))
        (findings::all(d))
        (tables::gain(d))
        (ahead(d, figures))
        (tables::structure(d))
        (tables::drift(d))
        @if !figures.channels.is_empty() { h2 { "Channels" } }
        @for shown in &figures.channels {
            @let c = &shown.channel;
            h3 { (capital(c.name)) }
            p {
                "Error " (digits(c.before, c.before, 3)) " " (unit(c.unit)) " before, " (digits(c.after, c.before, 3))
                " after, root mean square; "
                "its noise is about " (digits(c.noise, c.before, 3)) "."
            }
            @for figure in &shown.figures { (drawn(figure)) }
        }
        (tables::hidden(d))
    };
    page::page(&format!("Diagnosis of {}", logs(d)), STYLE, body)
}

fn drawn(figure: &Figure) -> Markup {
    html! { figure id=(figure.name) { (PreEscaped(&figure.svg)) figcaption { (figure.caption) } } }
}

/// The open loop, as figure and table.
fn ahead(d: &Diagnosis, figures: &DiagnosisFigures) -> Markup {
    html! {
        h2 { "Simulated ahead" }
        @match &figures.open_loop {
            Some(figure) => { (drawn(figure)) (tables::horizons(d)) }
            None => {
                p { "These logs hold no velocity, or no commands of the thrust: nothing could be simulated ahead." }
            }
        }
    }
}

/// Seconds in which something happened.
fn left_out(d: &Diagnosis) -> Markup {
    html! {
        @if !d.left_out.is_empty() {
            p { "Left out, because something happened there:" }
            ul {
                @for l in &d.left_out {
                    li {
                        (format!("{:.1} to {:.1} s of {}: ", l.span_s[0], l.span_s[1], l.log))
                        (l.channel) (format!(" {:.0} times as far off as usual", l.times))
                    }
                }
            }
        }
    }
}

/// With a capital.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}

/// With a capital and a full stop.
fn sentence(text: &str) -> String {
    capital(text) + if text.ends_with('.') { "" } else { "." }
}

/// Logs by the names of their files.
fn logs(d: &Diagnosis) -> String {
    let name = |path: &String| Path::new(path).file_name().map_or(path.clone(), |n| n.to_string_lossy().into_owned());
    d.logs.iter().map(name).collect::<Vec<_>>().join(", ")
}
