//! `racer extend`: a vehicle with effects of sizes given by hand, to see what they would do.

use super::{CommandEnd, columns, tell};
use crate::base::check::{BadInput, Check};
use crate::base::fsio::Reserved;
use crate::model::effects::{self, MODEL};
use crate::model::vehicle::Vehicle;
use std::path::PathBuf;

/// Give a vehicle effects beyond the compact model, or list them
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub struct Args {
    /// Vehicle to extend: a name or a file; without it the effects are listed
    #[arg(value_name = "NAME|FILE")]
    vehicle: Option<String>,
    /// Effects as EFFECT.PARAMETER=SIZE, in the units of the list
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
    let out = Reserved::new(out)?;
    for size in &args.sizes {
        let (effect, parameter, value) = parse(size).ok_or_else(|| {
            let expected = "EFFECT.PARAMETER=SIZE, such as axial_inflow.k=0.5";
            BadInput::new("the sizes", size, expected, "`racer extend` lists the effects")
        })?;
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

/// Effects of the simulator with their parameters, units and typical sizes.
fn list() -> String {
    let rows = MODEL.iter().flat_map(|card| {
        card.parameters.iter().map(|p| {
            let [low, high] = p.typical;
            vec![
                format!("{}.{}", card.id, p.name),
                format!("{low:.3} to {high:.3}"),
                p.unit.into(),
                card.sentence.into(),
            ]
        })
    });
    let table = columns::table(&["effect", "typical", "", "what it means"], rows.collect(), 1..2);
    let others: Vec<&str> = effects::LOG.iter().map(|card| card.id).collect();
    format!("{table}\n\nof sensors and of chance, found by `racer diagnose` only: {}", others.join(", "))
}
