//! What a rate loop has beside its lag is identified where it is there, and only there.

use crate::truth::Vehicle;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style, fly};
use racer::insight::identify::result::Identification;
use racer::insight::identify::{IdentifyOptions, identify};
use racer::insight::quality::check;
use racer::model::effects::ControllerPart;
use rand::SeedableRng;
use rand::rngs::StdRng;

/// Two minutes of excited flight with these effects, identified.
fn identified(seed: u64, effects: &[(&str, f64)]) -> Identification {
    let vehicle = Vehicle::draw(seed);
    let mut rng = StdRng::seed_from_u64(seed);
    let hidden: Vec<Hidden> = effects.iter().map(|(id, size)| Hidden::sized(id, *size, &vehicle, &mut rng)).collect();
    let setting = Setting { seed, seconds: 120.0, noise: 1.0, imu_hz: 250.0, style: Style::Excited };
    let options = IdentifyOptions::new(vehicle.in_racer());
    identify(vec![check(&fly(&vehicle, &hidden, &setting))], &options, &mut |_, _| ())
}

#[test]
fn a_loop_of_first_order_stays_one() {
    let found = identified(71, &[]);
    assert!(found.controller.is_empty(), "{:?}", found.controller);
    assert!(found.vehicle.effects.is_empty());
}

#[test]
fn delay_limit_and_the_order_of_yaw_are_found_and_are_in_the_vehicle() {
    for (effects, part, size, within) in [
        ([("rate_delay", 0.012)].as_slice(), ControllerPart::Delay, 0.012, 5e-4),
        (&[("rate_delay", 0.012), ("rate_slew_limit", 200.0)], ControllerPart::Slew, 1.0 / 200.0, 5e-4),
        (&[("yaw_second_order", 20.0)], ControllerPart::YawInertia, 1.0 / 400.0, 2e-4),
    ] {
        let found = identified(72, effects);
        let value = found.controller.get(&part).and_then(|estimate| estimate.value);
        let value = value.unwrap_or_else(|| panic!("{effects:?}: {part:?} is not among {:?}", found.controller));
        assert!((value - size).abs() < within, "{effects:?}: {value} for {size}");
        let card = racer::model::effects::of_controller(part).unwrap();
        assert_eq!(found.vehicle.effects.sizes[card.id][card.parameters[0].name], value);
        // What racer writes, racer reads.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("v.toml");
        std::fs::write(&path, toml::to_string(&found.vehicle).unwrap()).unwrap();
        assert_eq!(racer::model::vehicle::Vehicle::load(path.to_str().unwrap()).unwrap(), found.vehicle);
    }
}
