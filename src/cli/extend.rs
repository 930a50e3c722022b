//! `racer extend`: a vehicle with effects of sizes given by hand, to see what they would do.

use super::{CommandEnd, columns, tell};
use crate::base::check::{BadInput, Check};
use crate::base::fsio::Reserved;
use crate::model::effects::{self, Card, EffectParameter, MODEL};
use crate::model::vehicle::Vehicle;
use crate::present::report::range;
use std::path::PathBuf;

/// Give a vehicle effects beyond the compact model, or list them
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Vehicle to extend: a name or a file; without it the effects are listed
    #[arg(value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Effects as EFFECT.PARAMETER=SIZE, in the units of the list; names that `racer diagnose` prints may be given too
    #[arg(value_name = "EFFECT.PARAMETER=SIZE", requires = "vehicle")]
    sizes: Vec<String>,
    /// New file for the extended vehicle
    #[arg(long, value_name = "V.toml", requires = "vehicle")]
    out: Option<PathBuf>,
}

const HELP: &str =
    "`racer diagnose --extend` finds the sizes in a flight; this command sets them, to see what an effect would do.

Examples:
  racer extend
  racer extend seed_class axial_inflow.k=0.5 voltage_sag.v_full=1.5 --out what_if.toml
  racer eval latest --vehicle what_if.toml";

/// A number that people read: name, range, unit.
type ReadRange = (&'static str, [f64; 2], &'static str);

/// Lists, or checks and writes.
pub fn run(args: &Args) -> anyhow::Result<CommandEnd> {
    let Some(name) = &args.vehicle else {
        super::print(&list())?;
        return Ok(CommandEnd::Done);
    };
    let mut vehicle = Vehicle::load(name)?;
    let Some(out) = &args.out else {
        return Err(BadInput::new("--out", "nothing", "a new file for the extended vehicle", "add --out V.toml").into());
    };
    let out = Reserved::new(out, "--out")?;
    for (i, size) in args.sizes.iter().enumerate() {
        let (effect, parameter, value) = equation(size, &vehicle)?;
        let earlier = args.sizes[..i].iter().filter_map(|size| equation(size, &vehicle).ok());
        if earlier.into_iter().any(|(e, p, _)| (e, p) == (effect.clone(), parameter.clone())) {
            let (found, expected) = (format!("{size}, a second time"), "one size for each parameter");
            return Err(
                BadInput::new("the sizes", found, expected, format!("{effect}.{parameter} is one number")).into()
            );
        }
        vehicle.effects.sizes.entry(effect).or_default().insert(parameter, value);
    }
    vehicle.check().map_err(|invalid| BadInput::at("command line", invalid))?;
    let written = out.write(toml::to_string(&vehicle)?.as_bytes())?;
    tell(&format!("extended vehicle in {0}: racer train --vehicle {0}", written.display()));
    Ok(CommandEnd::Done)
}

fn parse(text: &str) -> Option<(String, String, f64)> {
    let (key, value) = text.split_once('=')?;
    let (effect, parameter) = key.split_once('.')?;
    Some((effect.into(), parameter.into(), value.trim().parse().ok()?))
}

/// A size that was asked for as the equation has it: effect, parameter, value. People may read other numbers.
fn equation(size: &str, vehicle: &Vehicle) -> Result<(String, String, f64), BadInput> {
    let (effect, parameter, value) = parse(size).ok_or_else(|| {
        let expected = "EFFECT.PARAMETER=SIZE, such as axial_inflow.k=0.5";
        BadInput::new("the sizes", size, expected, "`racer extend` lists the effects")
    })?;
    let Some(card) = MODEL.iter().find(|card| card.id == effect) else { return Ok((effect, parameter, value)) };
    if card.parameters.iter().any(|p| p.name == parameter) {
        return Ok((effect, parameter, value));
    }
    let tau = vehicle.time_constants();
    if let Some((own, value)) = card.asked(&parameter, value, tau) {
        return Ok((effect, own.name.into(), value));
    }
    let own = card.parameters.iter().map(|p| format!("{} of {} to {} {}", p.name, p.low, p.high, p.unit));
    let read = card.parameters.iter().flat_map(|p| card.read_within([p.low, p.high], tau));
    let read = read.map(|(name, ends, unit)| format!("{name} of {} {unit}", range(ends)));
    let expected = own.chain(read).collect::<Vec<_>>().join(", or ");
    Err(BadInput::new(format!("command line: {effect}.{parameter}"), size, &expected, "`racer extend` lists them"))
}

/// Effects of the simulator with their parameters, units and typical sizes.
fn list() -> String {
    let mut rows = Vec::new();
    for card in MODEL {
        for p in card.parameters {
            let key = format!("{}.{}", card.id, p.name);
            rows.push(vec![key, range(p.typical), p.unit.into(), card.sentence.into()]);
        }
        rows.extend(read_as(card));
    }
    let table = columns::table(&["effect", "typical", "", "what it means"], rows, 1..2);
    let others: Vec<&str> = effects::LOG.iter().map(|card| card.id).collect();
    format!("{table}\n\nof sensors and of chance, found by `racer diagnose` only: {}", others.join(", "))
}

/// Lines of the names that `racer diagnose` prints where the equation has another: either may be given.
fn read_as(card: &Card) -> Vec<Vec<String>> {
    let line = |p: &EffectParameter| {
        let at = |tau: f64| card.read_within(p.typical, [tau; 4]);
        let sizes = at(0.02).into_iter().zip(at(0.04));
        let line = |((name, ends, unit), (_, other, _)): (ReadRange, ReadRange)| {
            let typical = if ends == other { range(ends) } else { "the vehicle's".into() };
            vec![
                format!("{}.{name}", card.id),
                typical,
                unit.into(),
                format!("the same, as another number than {}", p.name),
            ]
        };
        sizes.map(line).collect::<Vec<_>>()
    };
    card.parameters.iter().flat_map(line).collect()
}
