//! The flight that is planned next, as text.

use crate::cli::columns;
use crate::insight::plan::{NextFlight, PlannedPair};
use std::path::Path;

/// What is tied, what to fly, and what that is expected to tell; `file` is where the plan was written.
pub fn text(next: &NextFlight, file: Option<&Path>) -> String {
    let mut out: Vec<String> = Vec::new();
    if !next.left_out.is_empty() {
        let names = next.left_out.join(", ");
        out.push(format!("no manoeuvre is planned for {names}: only a drift against a known vehicle shows it"));
    }
    if next.pairs.is_empty() {
        out.push("nothing else is tied, and too little was flown of nothing: no flight is planned".into());
        return out.join("\n\n");
    }
    let tied = if next.tied { "these flights do not tell apart" } else { "these flights would not have shown" };
    out.push(tied.into());
    let rows = next.pairs.iter().map(|pair| {
        vec![
            causes(pair),
            format!("{:.1}", pair.now),
            format!("{:.1}", pair.then),
            format!("{:.1}", pair.wanted),
            pair.why_not.unwrap_or_default().to_string(),
        ]
    });
    let header = ["in standard deviations over stretches of flight", "now", "planned", "wanted", ""];
    out.push(columns::table(&header, rows.collect(), 1..4));
    if next.manoeuvres.is_empty() {
        out.push("no manoeuvre of the pilot tells any of it: no flight is planned".into());
        return out.join("\n\n");
    }
    out.push(format!("fly next, {:.0} s with take-off and landing, each kind early and late", next.seconds));
    let rows = next.manoeuvres.iter().map(|chosen| {
        let count = format!("{} x", chosen.count);
        vec![chosen.name.to_string(), count, format!("{:.0} s", chosen.each_s), chosen.words.to_string()]
    });
    out.push(columns::table(&["manoeuvre", "times", "each", "in words"], rows.collect(), 1..3));
    let all: usize = next.manoeuvres.iter().map(|chosen| chosen.count).sum();
    if next.on_a_pack < all {
        out.push(format!("the battery is empty after {} of {all}: fly the rest on another pack", next.on_a_pack));
    }
    out.push(match file {
        Some(file) => format!("racer fly --pilot --plan {} flies it in the simulator", file.display()),
        None => "with --plan-out FILE it is a file that `racer fly --pilot --plan FILE` flies".into(),
    });
    out.push("then diagnose both logs together".into());
    out.join("\n\n")
}

fn causes(pair: &PlannedPair) -> String {
    match pair.causes {
        [Some(one), Some(other)] => format!("{one} or {other}"),
        [Some(one), None] | [None, Some(one)] => format!("{one} or nothing"),
        [None, None] => String::new(),
    }
}
