//! What changed since earlier flights: asked for, and as text.

use super::text::interval;
use crate::base::check::BadInput;
use crate::flight::spans::length;
use crate::insight::Watch;
use crate::insight::criteria::flown::LEAST_FLIGHT_S;
use crate::insight::diagnose::against::{Both, Change, Changes, WouldShow, compare};
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::quality::Quality;
use crate::model::vehicle::Vehicle;
use crate::present::report::digits;

/// Fails where too little was flown on either side; known before the vehicle is identified, which takes its time.
pub fn check(before: &[Quality], after: &[Quality]) -> Result<(), BadInput> {
    let short = |quality: &&Quality| length(&quality.usable) < LEAST_FLIGHT_S.get();
    let Some(quality) = before.iter().chain(after).find(short).filter(|_| !before.is_empty()) else { return Ok(()) };
    let found = format!("{}: {:.0} s of usable flight", quality.log.name, length(&quality.usable));
    let expected = &format!("{:.0} s of flight in every log", LEAST_FLIGHT_S.get());
    Err(BadInput::new("--against", found, expected, "`racer check` says what is left out, and why"))
}

/// What changed from the flights `before` to `after`; none where there are no earlier ones.
pub fn find(before: Vec<Quality>, after: &[Quality], base: &Vehicle, watch: Watch) -> Option<Changes> {
    (!before.is_empty()).then(|| compare(before, after.to_vec(), base, watch))
}

/// The answer, each change, what both show, and what would have shown.
pub fn text(c: &Changes) -> String {
    let mut out = vec![format!("{}\n   from {} to {}", c.headline(), c.before.join(", "), c.after.join(", "))];
    out.extend(c.changes.iter().enumerate().map(|(i, change)| format!("{}. {}", i + 1, paragraph(change))));
    if !c.both.is_empty() {
        let one = |b: &Both| {
            let sizes =
                b.parameters.iter().map(|(n, v)| format!("{n} {} {}", interval(v.value, v.low, v.high), v.unit));
            format!("{} ({}: {})", b.name, b.effect, sizes.collect::<Vec<_>>().join(", "))
        };
        let both: Vec<String> = c.both.iter().map(one).collect();
        out.push(format!("both show alike, so it is the vehicle's: {}", both.join(", ")));
    }
    let (numbers, effects): (Vec<&WouldShow>, Vec<&WouldShow>) = c.would_show.iter().partition(|w| w.large.is_none());
    let numbers: Vec<String> = numbers.into_iter().map(smallest).collect();
    out.push(format!("a difference would have shown from: {}", numbers.join(", ")));
    let beyond = |size: fn(&WouldShow) -> f64| {
        let hidden = effects.iter().filter(|w| w.large.is_some_and(|large| size(w) > large));
        hidden.map(|w| w.cause).collect::<Vec<&str>>()
    };
    let hidden = beyond(|w| w.smallest);
    if !hidden.is_empty() {
        out.push(format!("not even a large difference would have shown of: {}", hidden.join(", ")));
    }
    let mut partly = beyond(|w| w.worst_axis);
    partly.retain(|cause| !hidden.contains(cause));
    if !partly.is_empty() {
        out.push(format!("about some axis not even a large difference would have shown of: {}", partly.join(", ")));
    }
    out.join("\n\n")
}

/// The smallest difference of a number of the compact model that would have been seen.
fn smallest(w: &WouldShow) -> String {
    if w.unit == "1" {
        format!("{} {} %", w.name, digits(100.0 * w.smallest, 100.0 * w.smallest, 2))
    } else {
        format!("{} {} {}", w.name, digits(w.smallest, w.smallest, 2), w.unit)
    }
}

fn paragraph(c: &Change) -> String {
    let status = match c.status {
        Status::Named => String::new(),
        Status::NamedSet => format!(" - or {}: these flights do not tell them apart", c.members[1..].join(", ")),
        Status::Suspected => format!(" - suspected only: {}", c.why.as_deref().unwrap_or("")),
    };
    let rows = c.difference.iter().filter_map(|(name, d)| {
        let (before, after) = (c.before.get(name)?, c.after.get(name)?);
        let [was, is] = [before, after].map(|v| digits(v.value, (v.high - v.low).max(d.high - d.low), 2));
        let difference = interval(d.value, d.low, d.high);
        Some(format!("\n   {name} was {was}, is {is} {}; difference {difference}", d.unit))
    });
    format!(
        "{} ({}){status}\n   {}{}\n   {:.0} standard deviations{}",
        c.name,
        c.cause,
        c.sentence,
        rows.collect::<String>(),
        c.deviations,
        c.impact.map_or(String::new(), |impact| format!("; {impact:.2} m/s after a second"))
    )
}
