//! A diagnosis as text.

use crate::cli::columns;
use crate::insight::diagnose::gain;
use crate::insight::diagnose::judgement::diagnosis::{Diagnosis, Drift};
use crate::insight::diagnose::judgement::finding::{Finding, Status};
use crate::insight::diagnose::selection::accident::LeftOut;
use crate::present::report::{digits, range};

/// Numbers of the compact model that moved.
fn drift(moved: &[Drift]) -> String {
    let rows = moved.iter().map(|x| {
        let written = x.in_vehicle.map_or("-".into(), |v| format!("{v:.4}"));
        vec![x.parameter.clone(), format!("{:.4}", x.base), interval(x.value, x.low, x.high), written, x.unit.into()]
    });
    let head = ["drift against the base", "was", "is (95 % interval)", "extended vehicle", ""];
    columns::table(&head, rows.collect(), 1..2)
}

/// What is wrong, why, what it is worth, what to fly next.
pub fn text(d: &Diagnosis) -> String {
    let mut out = vec![d.headline()];
    out.extend(left_out(d));
    for (i, finding) in d.findings.iter().enumerate() {
        out.push(format!("{}. {}", i + 1, paragraph(finding)));
    }
    for s in &d.unexplained {
        let along = s.along.map_or(String::new(), |a| {
            format!("; it lines up with {a} ({:.0} % of the residual)", 100.0 * s.along_share)
        });
        let size = s.structure_rms.max(s.coloured_rms);
        out.push(format!("structure remains in {}: {:.3} {} of {:.3}{along}", s.channel, size, s.unit, s.rms));
    }
    if !d.small.is_empty() {
        let small: Vec<String> =
            d.small.iter().map(|f| format!("{} ({}, {:.3} m/s after a second)", f.name, f.effect, f.impact)).collect();
        out.push(format!("evident, and too small to matter: {}", small.join(", ")));
    }
    if !d.drift.is_empty() {
        out.push(drift(&d.drift));
    }
    let rows = d.held_out.iter().map(|(name, g)| {
        vec![
            name.to_string(),
            format!("{:.4}", g.before),
            format!("{:.4}", g.after),
            g.unit.to_string(),
            format!("{:.4}", g.r2_before),
            format!("{:.4}", g.r2_after),
        ]
    });
    let header = ["on flight not used for fitting", "RMSE before", "after", "", "R2 before", "after"];
    out.push(columns::table(&header, rows.collect(), 1..6));
    if !d.horizons.is_empty() {
        let rows = d.horizons.iter().map(|a| {
            vec![
                format!("{:.2} s", a.before.after_s),
                format!("{:.3} -> {:.3}", a.before.velocity_m_s, a.after.velocity_m_s),
                format!("{:.3} -> {:.3}", a.before.position_m, a.after.position_m),
                format!("{:.2} -> {:.2}", a.before.attitude_deg, a.after.attitude_deg),
                a.before.starts.to_string(),
            ]
        });
        out.push(columns::table(&["open loop, after", "m/s off", "m off", "deg off", "starts"], rows.collect(), 1..5));
    }
    out.extend(d.captured.map(gain::words));
    if let Some(why) = &d.not_extended {
        out.push(format!("no extended vehicle: {why}"));
    }
    let next: Vec<&str> = d.findings.iter().filter(|f| f.status != Status::Named).map(|f| f.manoeuvre).collect();
    if let Some(next) = next.first() {
        out.push(format!("fly next: {next}"));
    }
    out.push(not_shown(d));
    out.join("\n\n")
}

/// Seconds in which something happened.
fn left_out(d: &Diagnosis) -> Option<String> {
    let one = |l: &LeftOut| {
        let [from, to] = l.span_s;
        format!("{from:.1} to {to:.1} s of {} ({} {:.0} times as far off as usual)", l.log, l.channel, l.times)
    };
    let all: Vec<String> = d.left_out.iter().map(one).collect();
    (!all.is_empty()).then(|| format!("left out, because something happened there: {}", all.join(", ")))
}

/// A value and its interval, with as many digits as the interval's width has a meaning for.
pub fn interval(value: f64, low: f64, high: f64) -> String {
    let [value, low, high] = [value, low, high].map(|x| digits(x, high - low, 2));
    format!("{value} ({low} to {high})")
}

fn paragraph(f: &Finding) -> String {
    let values = f.parameters.iter().map(|(name, v)| format!("{name} {} {}", interval(v.value, v.low, v.high), v.unit));
    let unwritten = f.unwritten().map_or(String::new(), |why| format!(" - {why}"));
    let status = match f.status {
        Status::Named => unwritten,
        Status::NamedSet => {
            format!(" - or {}: these flights do not tell them apart{unwritten}", f.members[1..].join(", "))
        }
        Status::Suspected => format!(" - suspected only: {}", f.why.as_deref().unwrap_or("")),
    };
    let explained: Vec<String> =
        f.mentioned().iter().map(|(c, share)| format!("{:.0} % of {c}", 100.0 * share)).collect();
    let explained = if explained.is_empty() { String::new() } else { format!("explains {}; ", explained.join(", ")) };
    let gain = f.gain.get(f.channel).map_or(String::new(), |g| {
        format!(
            "\n   without it, on flight not used for fitting, {} {:.3} {} off; with it {:.3}",
            f.channel, g.before, g.unit, g.after
        )
    });
    let nearer = || format!("\n   its form is not quite any of these: with {} it comes nearer", f.with.join(", "));
    let form = if f.with.is_empty() { String::new() } else { nearer() };
    format!(
        "{} ({}){status}{form}\n   {}\n   {}\n   {explained}{:.0} stretches agree; {:.2} m/s after a second{gain}",
        f.name,
        f.effect,
        f.sentence,
        values.collect::<Vec<_>>().join(", "),
        f.stretches,
        f.impact
    )
}

/// What the flights could not show.
fn not_shown(d: &Diagnosis) -> String {
    let names: Vec<&str> = d.not_detectable.iter().map(|h| h.effect).collect();
    if names.is_empty() {
        "every effect would have shown".into()
    } else {
        format!("could not have shown: {}", names.join(", "))
    }
}

/// What the flights could show and tell apart.
pub fn plan(d: &Diagnosis) -> String {
    let rows = d.detectable.iter().map(|p| {
        vec![
            p.effect.to_string(),
            format!("{:.2e}", p.smallest),
            format!("{:.2e}", p.told_apart),
            p.nearest.unwrap_or("-").to_string(),
            range(p.typical),
            p.unit.to_string(),
        ]
    });
    let header = ["effect", "seen from", "told apart from", "nearest rival", "typical", ""];
    let table = columns::table(&header, rows.collect(), 1..3);
    let cannot = d.not_detectable.iter().map(|h| format!("\n  {}: {}", h.effect, h.why)).collect::<String>();
    format!("these flights could show\n\n{table}\n\nand could not{cannot}")
}
