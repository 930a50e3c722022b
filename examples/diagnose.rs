//! From a flight log to what the simulation gets wrong: a vehicle flies with an effect that its model does not know,
//! and the diagnosis names it.
//!
//!     cargo run --release --example diagnose

use racer::{Error, SensorConfig, Vehicle, check, diagnose, fly_pilot};

fn main() -> Result<(), Error> {
    let model = Vehicle::load("seed_class")?;
    let real = model.clone().with_effect("axial_inflow", "k", 0.6)?;
    let log = fly_pilot(&real, &SensorConfig::load("typical")?, 60.0, 1)?;

    let diagnosed = diagnose(&[check(&log)], &model, |_, _| ());
    println!("{}", diagnosed.diagnosis.headline());
    for finding in &diagnosed.diagnosis.findings {
        println!("{:?}: {} ({})", finding.status, finding.name, finding.effect);
        println!("  {}", finding.sentence);
        for (name, value) in &finding.parameters {
            println!("  {name} = {:.3} ({:.3} to {:.3}) {}", value.value, value.low, value.high, value.unit);
        }
    }
    for (channel, gain) in &diagnosed.diagnosis.held_out {
        println!("{channel}: off by {:.3} {} before, {:.3} after", gain.before, gain.unit, gain.after);
    }

    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("extended.toml");
    match &diagnosed.vehicle {
        Ok(vehicle) => {
            vehicle.save(&file)?;
            let effects = Vehicle::load(&file.display().to_string())?.effects.sizes;
            println!("the extended vehicle has {effects:?}");
        }
        Err(why) => println!("there is no extended vehicle: {why}"),
    }
    Ok(())
}
