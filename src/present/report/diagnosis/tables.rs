//! What was gained, what is left, what drifted, what could not show.

use crate::insight::diagnose::gain;
use crate::insight::diagnose::judgement::diagnosis::{Diagnosis, Verdict};
use crate::present::report::page::{digits, range, unit};
use maud::{Markup, html};

/// By channel, on flight not used for fitting.
pub fn gain(d: &Diagnosis) -> Markup {
    html! {
        h2 { "What it is worth" }
        p {
            "Root mean square errors on flight that was not used for fitting, and the share of the variance that is \
             predicted."
        }
        table {
            tr { th { "" } th { "before" } th { "after" } th { "change" } th { "R² before" } th { "R² after" } }
            @for (name, g) in &d.held_out {
                tr {
                    td { (name) ", " (unit(g.unit)) }
                    td { (digits(g.before, g.before, 3)) } td { (digits(g.after, g.before, 3)) }
                    td { (percent(g.after / g.before - 1.0)) }
                    td { (digits(g.r2_before, 1.0, 5)) } td { (digits(g.r2_after, 1.0, 5)) }
                }
            }
        }
        @if let Some(captured) = d.captured {
            p { (gain::words(captured)) "." }
        }
    }
}

/// A change; no change has no sign.
fn percent(change: f64) -> String {
    let whole = (100.0 * change).round();
    format!("{} %", digits(if whole == 0.0 { 0.0 } else { whole }, 10.0, 2))
}

/// Open-loop errors.
pub fn horizons(d: &Diagnosis) -> Markup {
    let pair = |before: f64, after: f64| format!("{} → {}", digits(before, before, 3), digits(after, before, 3));
    html! {
        table {
            tr {
                th { "left alone for" } th { "velocity, m/s off" } th { "position, m off" }
                th { "attitude, deg off" } th { "starts" }
            }
            @for a in &d.horizons {
                tr {
                    td { (a.before.after_s) " s" }
                    td { (pair(a.before.velocity_m_s, a.after.velocity_m_s)) }
                    td { (pair(a.before.position_m, a.after.position_m)) }
                    td { (pair(a.before.attitude_deg, a.after.attitude_deg)) }
                    td { (a.before.starts) }
                }
            }
        }
    }
}

/// What no effect explains.
pub fn structure(d: &Diagnosis) -> Markup {
    html! {
        h2 { "What is left unexplained" }
        @if d.unexplained.is_empty() {
            p { "Nothing: " (if d.verdict == Verdict::Clean { "the errors are" } else { "what remains is" }) " noise." }
        } @else {
            table {
                tr {
                    th { "" } th { "structure" } th { "whole error" }
                    th class="text" { "lines up with" } th class="text" { "is louder with" }
                }
                @for s in &d.unexplained {
                    tr {
                        td { (s.channel) ", " (unit(s.unit)) }
                        td { (digits(s.structure_rms.max(s.coloured_rms), s.rms, 3)) } td { (digits(s.rms, s.rms, 3)) }
                        td class="text" {
                            @match s.along {
                                Some(along) => { (along) (format!(", {:.0} % of the power", 100.0 * s.along_share)) }
                                None => "nothing that the simulation knows",
                            }
                        }
                        td class="text" {
                            @if let Some(along) = s.variance_along {
                                (along) (format!(", {:.1} times", s.variance_ratio))
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Numbers of the compact model that moved.
pub fn drift(d: &Diagnosis) -> Markup {
    html! {
        @if !d.drift.is_empty() {
            h2 { "Drift against " (d.base) }
            table {
                tr { th { "" } th { "was" } th { "is" } th { "95 % interval" } th { "extended vehicle" } }
                @for x in &d.drift {
                    @let width = x.high - x.low;
                    tr {
                        td { (x.parameter) @if x.unit != "1" { ", " (unit(x.unit)) } }
                        td { (digits(x.base, width, 2)) } td { (digits(x.value, width, 2)) }
                        td { (digits(x.low, width, 2)) " to " (digits(x.high, width, 2)) }
                        td { @if let Some(v) = x.in_vehicle { (digits(v, width, 2)) } }
                    }
                }
            }
        }
    }
}

/// What these flights could not have shown, and what they could.
pub fn hidden(d: &Diagnosis) -> Markup {
    html! {
        h2 { "What could not have shown" }
        @if d.not_detectable.is_empty() { p { "Every effect of the catalogue would have shown." } }
        ul {
            @for h in &d.not_detectable {
                li {
                    code { (h.effect) } ": " (h.why)
                    @if let Some(smallest) = h.smallest {
                        " (it would show from " (digits(smallest, smallest, 2)) " " (unit(h.unit)) ")"
                    }
                }
            }
        }
        details {
            summary { "What would have shown, and from which size" }
            table {
                tr {
                    th { "" } th { "seen from" } th { "told apart from" } th class="text" { "nearest rival" }
                    th { "typical" } th class="text" { "" }
                }
                @for p in &d.detectable {
                    tr {
                        td { code { (p.effect) } }
                        td { (digits(p.smallest, p.smallest, 2)) } td { (digits(p.told_apart, p.told_apart, 2)) }
                        td class="text" { (p.nearest.unwrap_or("none")) }
                        td { (range(p.typical)) } td class="text" { (unit(p.unit)) }
                    }
                }
            }
        }
    }
}
