//! From a flight log to a vehicle file: the built-in pilot flies a vehicle, and its log alone says which one it was.
//!
//!     cargo run --release --example identify

use racer::{Error, IdentifyOptions, Log, SensorConfig, Vehicle, check, fly_pilot, identify};

fn main() -> Result<(), Error> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, new) = (folder.path().join("flight.mcap"), folder.path().join("mine.toml"));

    // A log of two minutes; a real one comes from the vehicle.
    let truth = Vehicle::load("a2rl_class")?;
    fly_pilot(&truth, &SensorConfig::load("typical")?, 120.0, 1)?.save(&file)?;

    let checked = check(&Log::open(&file)?);
    for finding in &checked.findings {
        println!("{:?}: {}: {}; {}", finding.severity, finding.stream, finding.what, finding.so);
    }

    // What a flight cannot tell, such as the mass, another vehicle lends.
    let mut options = IdentifyOptions::new(Vehicle::load("seed_class")?);
    options.mass_kg = Some(truth.mass_kg);
    let found = identify(&[checked], &options, |_, _| ())?;
    println!("{:<22}{:>10}{:>10}   95 % interval", "", "truth", "found");
    for (name, truth, estimate) in [
        ("roll lag, ms", 1e3 * truth.time_constant_s.roll, found.response[0].tau_s.times(1e3)),
        ("thrust lag, ms", 1e3 * truth.time_constant_s.thrust, found.response[3].tau_s.times(1e3)),
        ("discharge, V/min", 60.0 * truth.battery.rate_v_s, found.battery.rate_v_s.times(60.0)),
    ] {
        let (value, [low, high]) = (estimate.value.unwrap_or(f64::NAN), estimate.interval().unwrap_or([f64::NAN; 2]));
        println!("{name:<22}{truth:>10.2}{value:>10.2}   {low:.2} to {high:.2}");
    }

    found.vehicle.save(&new)?;
    let ratio = Vehicle::load(&new.display().to_string())?.thrust_to_weight();
    println!("thrust over weight: {:.2} in truth, {ratio:.2} in the new vehicle file", truth.thrust_to_weight());
    Ok(())
}
