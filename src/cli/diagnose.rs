//! `racer diagnose`: what the simulation gets wrong, and why.

mod worth;

use super::{Outcome, columns, findings, tell};
use crate::base::check::{BadInput, Invalid};
use crate::base::fsio::{self, Reserved};
use crate::flight::{self, Readable};
use crate::insight::diagnose::finding::{Diagnosis, Finding, Status, Verdict};
use crate::insight::diagnose::{Diagnosed, diagnose};
use crate::insight::identify::{self, identify};
use crate::insight::quality::{Quality, check};
use crate::model::vehicle::Vehicle;
use crate::present::report::diagnosis::Figures;
use crate::present::report::{self, digits};
use crate::present::run;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};

/// Show what the simulation gets wrong, name the cause, and extend the model
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Logs of one vehicle in the order of flight: MCAP, Betaflight blackbox, PX4 ULog or CSV
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// The vehicle that the simulation takes it for: a name or a file [default: identified from the logs]
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// New file for everything that was found, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// New file for the extended vehicle, which `racer train --vehicle` reads
    #[arg(long, value_name = "V.toml")]
    extend: Option<PathBuf>,
    /// New file for the report with figures, one page
    #[arg(long, value_name = "F.html")]
    report: Option<PathBuf>,
    /// New or empty folder for the figures, one SVG file each
    #[arg(long, value_name = "DIR")]
    svg: Option<PathBuf>,
    /// Fly this policy with and without what was found: a run folder, a snapshot file, or `latest`
    #[arg(long, value_name = "RUN|SNAPSHOT|latest")]
    policy: Option<String>,
    /// Train a policy in the base and one in the extended vehicle for so many minutes each, and fly both in the extended one
    #[arg(long, value_name = "MINUTES")]
    retrain: Option<f64>,
    /// New folder for the policies of --retrain [default: retrained]
    #[arg(long, value_name = "DIR", default_value = "retrained", requires = "retrain")]
    retrain_out: PathBuf,
    /// Only say what these flights could show and tell apart, and what to fly next
    #[arg(long)]
    plan: bool,
    /// End with exit code 5 where an effect or unexplained structure is found
    #[arg(long)]
    fail_on_effect: bool,
    /// What the logs' fields mean: a mapping's name or file [default: the format's own, or the one that fits]
    #[arg(long, value_name = "NAME|FILE")]
    mapping: Option<String>,
    /// Without --vehicle: the vehicle that lends what the logs cannot tell
    #[arg(long, value_name = "NAME|FILE", default_value = "seed_class")]
    base: String,
}

const HELP: &str = "The flight is predicted from its commands by the simulator's own equations. What the residuals show is tested against a \
catalogue of effects; those that are evident, replicated, of a size that matters, and leave nothing structured behind, are named, with \
what they are worth on flight that was not used for fitting.

Exit code 3 means that a log is damaged and that its readable part was used, 5 that --fail-on-effect found something.

Examples:
  racer diagnose flight.mcap --vehicle mine.toml
  racer diagnose flight.mcap --vehicle mine.toml --report diagnosis.html
  racer diagnose flight.mcap --vehicle mine.toml --extend better.toml
  racer diagnose flight.mcap --plan";

/// Reads, checks, diagnoses, writes, prints.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let reserve = |path: &Option<PathBuf>| path.as_deref().map(Reserved::new).transpose();
    let (json, extended, page) = (reserve(&args.json)?, reserve(&args.extend)?, reserve(&args.report)?);
    args.svg.as_deref().map(fsio::new_folder).transpose()?;
    let given = args.vehicle.as_deref().map(Vehicle::load).transpose()?;
    if let Some(minutes) = args.retrain {
        Invalid::unless_positive("--retrain", minutes, "").map_err(|invalid| BadInput::at("command line", invalid))?;
    }
    if let Some(policy) = &args.policy {
        run::find(policy)?;
    }
    let runs = args.retrain.map(|_| worth::folder(&args.retrain_out)).transpose()?;
    let bar = ProgressBar::new(100);
    bar.set_style(ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}")?);
    let mut logs: Vec<Quality> = Vec::new();
    for path in &args.logs {
        bar.set_message(format!("reading {}", path.display()));
        let opened = flight::open_with(path, flight::Options { mapping: args.mapping.as_deref(), flight: None })?;
        let quality = check(&opened.log);
        bar.suspend(|| {
            opened.remarks.iter().for_each(|remark| tell(remark));
            tell(&findings::findings(&quality.findings));
        });
        logs.push(quality);
    }
    let damaged = logs.iter().any(|quality| quality.log.readable != Readable::Whole);
    let base = match given {
        Some(vehicle) => vehicle,
        None => {
            let options = identify::Options {
                base: Vehicle::load(&args.base)?,
                mass_kg: None,
                max_rate_rad_s: None,
                rate_cutoff_hz: 100.0,
                force_cutoff_hz: 30.0,
            };
            identify(logs.clone(), &options, &mut |step, _| bar.set_message(format!("identifying: {step}"))).vehicle
        }
    };
    let diagnosed = diagnose(logs, &base, &mut |step, share| {
        bar.set_position((100.0 * share) as u64);
        bar.set_message(step.to_string());
    });
    bar.finish_and_clear();
    let Diagnosed { diagnosis, vehicle, .. } = &diagnosed;
    super::print(&if args.plan { plan(diagnosis) } else { text(diagnosis) })?;
    show(&diagnosed, page, args.svg.as_deref())?;
    if let Some(json) = json {
        let document = serde_json::to_string_pretty(diagnosis)?;
        tell(&format!("figures in {}", json.write(format!("{document}\n").as_bytes())?.display()));
    }
    if let Some(file) = extended {
        let written = file.write(toml::to_string(vehicle)?.as_bytes())?;
        tell(&format!("extended vehicle in {0}: racer train --vehicle {0}", written.display()));
    }
    if let Some(policy) = &args.policy {
        super::print(&worth::present(policy, &base, vehicle)?)?;
    }
    if let (Some(minutes), Some(to)) = (args.retrain, &runs) {
        super::print(&worth::retrain(to, minutes, &base, vehicle)?)?;
    }
    Ok(if args.fail_on_effect && diagnosis.verdict != Verdict::Clean {
        Outcome::Effect
    } else if damaged {
        Outcome::Damaged
    } else {
        Outcome::Done
    })
}

/// Page and figures, where they are asked for.
fn show(diagnosed: &Diagnosed, page: Option<Reserved>, folder: Option<&Path>) -> anyhow::Result<()> {
    if page.is_none() && folder.is_none() {
        return Ok(());
    }
    let figures = Figures::new(diagnosed)?;
    if let Some(folder) = folder {
        for figure in figures.all() {
            fsio::write_new(&folder.join(format!("{}.svg", figure.name)), figure.svg.as_bytes())?;
        }
        tell(&format!("{} figures in {}", figures.all().count(), folder.display()));
    }
    if let Some(page) = page {
        let written = page.write(report::diagnosis::page(diagnosed, &figures).as_bytes())?;
        tell(&format!("report in {}", written.display()));
    }
    Ok(())
}

/// What is wrong, why, what it is worth, what to fly next.
fn text(d: &Diagnosis) -> String {
    let mut out = vec![d.headline()];
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
    if !d.drift.is_empty() {
        let rows = d.drift.iter().map(|x| {
            vec![x.parameter.clone(), format!("{:.4}", x.base), interval(x.value, x.low, x.high), x.unit.into()]
        });
        let table = columns::table(&["drift against the base", "was", "is (95 % interval)", ""], rows.collect(), 1..2);
        out.push(table);
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
    if let Some(captured) = d.captured {
        out.push(format!("{:.0} % of what a better model could gain on that flight was gained", 100.0 * captured));
    }
    let next: Vec<&str> = d.findings.iter().filter(|f| f.status != Status::Named).map(|f| f.manoeuvre).collect();
    if let Some(next) = next.first() {
        out.push(format!("fly next: {next}"));
    }
    out.push(not_shown(d));
    out.join("\n\n")
}

/// A value and its interval, with as many digits as the interval's width has a meaning for.
fn interval(value: f64, low: f64, high: f64) -> String {
    let [value, low, high] = [value, low, high].map(|x| digits(x, high - low, 2));
    format!("{value} ({low} to {high})")
}

fn paragraph(f: &Finding) -> String {
    let values = f.parameters.iter().map(|(name, v)| format!("{name} {} {}", interval(v.value, v.low, v.high), v.unit));
    let status = match f.status {
        Status::Named => String::new(),
        Status::NamedSet => format!(" - or {}: these flights do not tell them apart", f.members[1..].join(", ")),
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
    format!(
        "{} ({}){status}\n   {}\n   {}\n   {explained}{:.0} stretches agree; {:.2} m/s after a second{gain}",
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
fn plan(d: &Diagnosis) -> String {
    let rows = d.detectable.iter().map(|p| {
        vec![
            p.effect.to_string(),
            format!("{:.2e}", p.smallest),
            format!("{:.2e}", p.told_apart),
            p.nearest.unwrap_or("-").to_string(),
            format!("{} to {}", p.typical[0], p.typical[1]),
            p.unit.to_string(),
        ]
    });
    let header = ["effect", "seen from", "told apart from", "nearest rival", "typical", ""];
    let table = columns::table(&header, rows.collect(), 1..3);
    let cannot = d.not_detectable.iter().map(|h| format!("\n  {}: {}", h.effect, h.why)).collect::<String>();
    format!("these flights could show\n\n{table}\n\nand could not{cannot}")
}
