//! A vehicle under a flight controller whose mixer moves, boosts and compensates the collective command, identified
//! from what its motors were sent.

use crate::truth::controlled::{Controlled, fly};
use crate::truth::effects::Hidden;
use crate::truth::hidden::{self, Setting, Style};
use racer::flight::Log;
use racer::insight::identify::result::Identification;
use racer::insight::identify::{IdentifyOptions, identify};
use racer::insight::predict::{PredictOptions, predict};
use racer::insight::prepare::data::{Data, DataPart};
use racer::insight::quality::check;
use racer::model::thrust::specific_thrust;
use racer::model::vehicle::Vehicle;
use racer::model::vehicle::identified::ThrustSource;
use rand::SeedableRng;
use rand::rngs::StdRng;

const SECONDS: f64 = 150.0;
/// Of full thrust: over the motors, which is the goal; and over a command whose voltage the mixer compensates until the
/// motors saturate. The curve of Eq. 7 that is nearest to the true one is off by 0.5 % over the motors, by 1.5 % there.
const LARGEST_OVER_MOTORS: f64 = 0.02;
const LARGEST_OVER_COMMAND: f64 = 0.03;

fn options() -> IdentifyOptions {
    IdentifyOptions::new(Vehicle::load("seed_class").unwrap())
}

fn found(log: &Log) -> Identification {
    identify(vec![check(log)], &options(), &mut |_, _| ())
}

/// Checks the thrust between two shares of the command.
fn near(truth: &Controlled, c: &[f64; 6], flown: [f64; 2], most: f64, wanted: &dyn Fn(f64, f64) -> f64) {
    let end = truth.full_v + SECONDS * truth.rate_v_s;
    let middle = error(truth, c, flown, &[0.5 * (truth.full_v + end)], wanted);
    let ends = error(truth, c, flown, &[truth.full_v, end], wanted);
    println!("of full thrust, share of the command, voltage: middle {middle:?}, ends {ends:?}");
    assert!(middle[0].abs() < most && ends[0].abs() < most, "{middle:?} {ends:?}");
}

/// Largest error of the thrust at these voltages, as a share of full thrust; and where.
fn error(
    truth: &Controlled,
    c: &[f64; 6],
    [from, to]: [f64; 2],
    volts: &[f64],
    wanted: &dyn Fn(f64, f64) -> f64,
) -> [f64; 3] {
    let full = truth.thrust(1.0, truth.full_v);
    let mut worst = [0.0; 3];
    for k in 0..=40 {
        let share = from + (to - from) * f64::from(k) / 40.0;
        for &v in volts {
            let off = (specific_thrust(c, 2.0 * share - 1.0, v) - wanted(share, v)) / full;
            if off.abs() > f64::abs(worst[0]) {
                worst = [off, share, v];
            }
        }
    }
    worst
}

#[test]
fn the_rotors_are_found_behind_a_mixer() {
    let truth = Controlled::racer();
    for speeds in [false, true] {
        let log = fly(&truth, 5, SECONDS, speeds);
        let found = found(&log);
        let words = &found.thrust;
        assert_eq!(words.source, if speeds { ThrustSource::Speeds } else { ThrustSource::Motors });
        let lag = words.rotor_lag_s.value.unwrap();
        assert!((lag / truth.rotor_lag - 1.0).abs() < 0.15, "rotor lag {lag}, in truth {}", truth.rotor_lag);
        let [from, to] = words.flown_throttle.unwrap();
        assert!(to > 0.6, "flown to {to}");
        let motors = [from, to].map(|share| truth.output(share, truth.full_v));
        println!("speeds {speeds}: rotor lag {lag:.4} s, over the motors' outputs and the command:");
        near(&truth, &words.over_motors_n.unwrap(), motors, LARGEST_OVER_MOTORS, &|m, v| truth.thrust(m, v));
        let wanted = |share: f64, v: f64| truth.thrust(truth.output(share, v), v);
        near(&truth, &found.vehicle.thrust_n, [from, to], LARGEST_OVER_COMMAND, &wanted);
        let identified = found.vehicle.identified.as_ref().unwrap();
        let chain = identified.rotors.unwrap();
        if speeds {
            let k = chain.thrust_n_per_speed_squared.unwrap() / (4.0 * truth.thrust_per_square);
            assert!((k - 1.0).abs() < 0.01, "k is {k} of the true one");
        }
        assert!(found.response[3].r2.unwrap() > 0.97, "{:?}", found.response[3]);
    }
}

/// PX4, ArduPilot and Betaflight can all do that, rotorpy does; a line from commands to outputs gave 14 % too much
/// thrust at full throttle there.
#[test]
fn outputs_may_be_a_curve_of_the_command() {
    let truth = Controlled { linearises: true, ..Controlled::racer() };
    let found = found(&fly(&truth, 5, SECONDS, true));
    let wanted = |share: f64, v: f64| truth.thrust(truth.output(share, v), v);
    near(&truth, &found.vehicle.thrust_n, found.thrust.flown_throttle.unwrap(), LARGEST_OVER_COMMAND, &wanted);
    let power = found.vehicle.identified.unwrap().rotors.unwrap().motor_power;
    assert!((power - 0.5).abs() < 0.05, "{power}");
}

#[test]
fn the_command_alone_tells_less() {
    let truth = Controlled::racer();
    let mut log = fly(&truth, 5, 90.0, false);
    let with = found(&log).response[3].r2.unwrap();
    log.motors = Default::default();
    let found = found(&log);
    assert_eq!(found.thrust.source, ThrustSource::Command);
    assert!(found.thrust.rotor_lag_s.value.is_none() && found.vehicle.identified.unwrap().rotors.is_none());
    let without = found.response[3].r2.unwrap();
    assert!(without < with, "R2 {without}, with motor outputs {with}");
}

#[test]
fn a_prediction_gives_the_figures_of_an_identification() {
    let log = fly(&Controlled::racer(), 6, 90.0, false);
    let quality = check(&log);
    let found = identify(vec![quality.clone()], &options(), &mut |_, _| ());
    // By way of a file.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("validated.toml");
    std::fs::write(&path, toml::to_string(&found.validated).unwrap()).unwrap();
    let vehicle = Vehicle::load(path.to_str().unwrap()).unwrap();
    let options = PredictOptions { part: DataPart::Validation, rate_cutoff_hz: 100.0, force_cutoff_hz: 30.0 };
    let prediction = predict(&Data::new(vec![quality]), &[&vehicle], &options);
    for (k, name) in ["roll rate", "pitch rate", "yaw rate", "specific force z"].iter().enumerate() {
        let score = prediction.channels.iter().find(|c| c.name == *name).unwrap().score(0);
        let response = &found.response[k];
        assert_eq!(response.rmse.unwrap().to_bits(), score.rmse.to_bits(), "{name}");
        assert_eq!(response.mae.unwrap().to_bits(), score.mae.to_bits(), "{name}");
        assert_eq!(response.r2.unwrap().to_bits(), score.r2.to_bits(), "{name}");
        assert_eq!(response.n_validation, score.n);
    }
    let voltage = prediction.channels.iter().find(|c| c.name == "voltage").unwrap().score(0);
    assert_eq!(found.battery.score, Some(voltage));
    assert!(prediction.ahead[0].iter().all(|h| h.starts > 0 && h.attitude_deg > 0.0), "{:?}", prediction.ahead);
}

/// A pack that sags is measured under load from the first moment, where the battery's log begins in flight.
#[test]
fn a_pack_that_sags_begins_above_what_is_measured_first() {
    let flown = crate::truth::Vehicle::draw(5);
    let sag = [Hidden::sized("voltage_sag", 3.0, &flown, &mut StdRng::seed_from_u64(5))];
    let setting = Setting { seed: 5, seconds: 60.0, noise: 1.0, imu_hz: 250.0, style: Style::Excited };
    let mut log = hidden::fly(&flown, &sag, &setting);
    let before = log.battery.time_s.iter().take_while(|t| **t < 15.0).count();
    log.battery.time_s.drain(..before);
    log.battery.rows.drain(..before);
    let mut vehicle = flown.in_racer();
    vehicle.effects.sizes.insert("voltage_sag".into(), [("v_full".to_string(), 3.0)].into());
    let options = PredictOptions { part: DataPart::All, rate_cutoff_hz: 100.0, force_cutoff_hz: 30.0 };
    let prediction = predict(&Data::new(vec![check(&log)]), &[&vehicle], &options);
    let voltage = prediction.channels.iter().find(|c| c.name == "voltage").expect("a voltage").score(0);
    assert!(voltage.rmse < 0.06, "{} V", voltage.rmse);
}
