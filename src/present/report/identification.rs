//! An identification as one page that needs nothing else: tables, findings, figures.

use super::signals;
use crate::base::error::Result;
use crate::insight::identify::document::CheckedLog;
use crate::insight::identify::estimate::Estimated;
use crate::insight::identify::result::Identification;
use crate::model::vehicle::AXES;
use crate::present::report::page::{self, number};
use maud::{Markup, PreEscaped, html};

/// The page as HTML.
pub fn page(found: &Identification, logs: &[CheckedLog]) -> Result<String> {
    let figures = found.channels.iter().map(signals::channel).collect::<Result<Vec<_>>>()?;
    let body = html! {
        h1 { "Vehicle " (found.vehicle.name) }
        p {
            "Identified by racer " (env!("CARGO_PKG_VERSION"))
            (format!(" from {:.0} s of usable flight.", found.usable_s))
        }
        (responses(found))
        (parameters(found))
        @if !found.remarks.is_empty() { h2 { "Remarks" } ul { @for remark in &found.remarks { li { (remark) } } } }
        (assumed(found))
        h2 { "Measured and predicted" }
        p {
            "The line divides the part that the parameters were learned from and the part they are validated on. Below \
             each: the residual."
        }
        @for figure in &figures { (PreEscaped(figure)) }
        (checks(logs))
    };
    Ok(page::page(&found.vehicle.name, "", body))
}

/// The paper's Table 1.
fn responses(found: &Identification) -> Markup {
    html! {
        h2 { "Response" }
        table {
            tr {
                th { "" } th { "tau, ms" } th { "95 % interval" } th { "RMSE" } th { "MAE" } th { "R²" }
                th { "training" } th { "validation" }
            }
            @for (name, r) in AXES.into_iter().chain(["thrust"]).zip(&found.response) {
                tr {
                    td { (name) @if !r.unit.is_empty() { ", " (r.unit) } }
                    td { (number(r.tau_s.times(1e3).value, 1)) }
                    td { (interval(&r.tau_s.times(1e3), 1)) }
                    td { (number(r.rmse, 2)) } td { (number(r.mae, 2)) } td { (number(r.r2, 3)) }
                    td { (r.n_train) } td { (r.n_validation) }
                }
            }
        }
    }
}

fn interval(estimate: &Estimated, digits: usize) -> String {
    match (estimate.interval(), &estimate.why) {
        (Some([low, high]), _) => format!("{low:.digits$} to {high:.digits$}"),
        (None, Some(why)) => why.clone(),
        (None, None) => String::new(),
    }
}

fn parameters(found: &Identification) -> Markup {
    html! {
        h2 { "Parameters" }
        table {
            tr { th { "" } th { "value" } th { "95 % interval" } }
            @for (name, estimate, digits, unit) in &found.parameters() {
                tr {
                    td { (name) ", " (unit) }
                    td { (number(estimate.value, *digits)) } td { (interval(estimate, *digits)) }
                }
            }
        }
        @if let Some([low, high]) = found.flown {
            p {
                (format!("The thrust curve was flown from command {low:.2} to {high:.2}; "))
                "beyond that it is extrapolated."
            }
        }
    }
}

fn assumed(found: &Identification) -> Markup {
    let Some(identified) = found.vehicle.identified.as_ref().filter(|identified| !identified.assumed.is_empty()) else {
        return html! {};
    };
    html! {
        h2 { "Taken from the vehicle " (identified.base) }
        ul { @for (key, why) in &identified.assumed { li { code { (key) } ": " span class="why" { (why) } } } }
    }
}

fn checks(logs: &[CheckedLog]) -> Markup {
    html! {
        h2 { "Logs" }
        @for log in logs {
            h3 { (log.name) }
            table {
                tr { th { "stream" } th { "samples" } th { "rate, Hz" } th { "fresh" } }
                @for stream in log.streams {
                    tr {
                        td { (stream.stream) } td { (stream.samples) } td { (number(stream.rate_hz, 0)) }
                        td { (format!("{:.0} %", 100.0 * stream.fresh)) }
                    }
                }
            }
            ul {
                @for f in log.findings {
                    li {
                        (f.stream)
                        @if let Some([from, to]) = f.span_s { (format!(" at {from:.1} to {to:.1} s")) }
                        ": " (f.what) "; " (f.so)
                    }
                }
            }
        }
    }
}
