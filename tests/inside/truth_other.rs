//! The third truth does what it says: a quadrotor that flies, and causes that each change the flight.

use crate::truth::effects::Hidden;
use crate::truth::hidden::{Setting, Style};
use crate::truth::other::faults::Faults;
use crate::truth::other::plant::Plant;
use crate::truth::other::{Airframe, STEP_S, causes, fly, motors};
use crate::truth::thrust::per_mass;
use racer::flight::Log;
use rand::SeedableRng;
use rand::rngs::StdRng;

const SETTING: Setting = Setting { seed: 5, seconds: 24.0, noise: 0.0, imu_hz: 250.0, style: Style::Excited };

fn flown(airframe: &Airframe, hidden: &[Hidden]) -> Log {
    fly(airframe, hidden, &SETTING)
}

#[test]
fn it_hovers_and_turns_as_its_sticks_say() {
    let airframe = Airframe::draw(1);
    let none = Faults::new(&[], 0, 10.0);
    let mut plant = Plant::hovering(&airframe);
    let mut command = [0.0, 0.0, 0.0, plant.hover_command(&airframe)];
    plant.controller.send(0.0, command, &none);
    (0..1000).for_each(|k| plant.step(&airframe, &none, f64::from(k) * STEP_S));
    assert!(plant.velocity.norm() < 0.02, "carried by its hover command: {}", plant.velocity);
    command[0] = 0.2;
    plant.controller.send(0.5, command, &none);
    (1000..1600).for_each(|k| plant.step(&airframe, &none, f64::from(k) * STEP_S));
    let wanted = 0.2 * airframe.max_rate[0];
    assert!((plant.rates[0] / wanted - 1.0).abs() < 0.05, "{} of {wanted}", plant.rates[0]);
    assert!(plant.rates[1].abs() + plant.rates[2].abs() < 0.02 * wanted);
}

#[test]
fn its_compact_model_has_its_thrust() {
    for seed in 0..5 {
        let airframe = Airframe::draw(seed);
        let nominal = airframe.nominal();
        for throttle in [0.2, 0.5, 0.9] {
            let thrust = airframe.full_n * motors::speed(&airframe, throttle, airframe.full_v).powi(2) / airframe.mass;
            let compact = per_mass(&nominal, 2.0 * throttle - 1.0, airframe.full_v);
            assert!((compact - thrust).abs() < 0.15, "{compact} for {thrust} at {throttle}");
        }
        assert!(nominal.tau.iter().all(|tau| (0.006..0.08).contains(tau)), "{:?}", nominal.tau);
    }
}

/// Without noise, so that every difference is the cause's.
#[test]
fn every_cause_changes_the_flight() {
    let airframe = Airframe::draw(2);
    let clean = flown(&airframe, &[]);
    assert!(clean.imu.len() > 5500 && clean.odometry.len() > 2000 && clean.battery.len() > 200);
    let highest = clean.odometry.column(2).into_iter().fold(0.0, f64::max);
    assert!(highest > 2.0, "it flies: {highest} m");
    let mut rng = StdRng::seed_from_u64(1);
    for kind in causes::KINDS.iter().chain(causes::OUTSIDE) {
        let hidden = causes::draw(kind.id, 1.0, &mut rng);
        let log = flown(&airframe, &[hidden]);
        let same = log.imu == clean.imu && log.odometry == clean.odometry && log.battery == clean.battery;
        assert!(!same, "{} changes nothing", kind.id);
        let finite = log.imu.rows.iter().flatten().chain(log.odometry.rows.iter().flatten()).all(|x| x.is_finite());
        assert!(finite, "{}", kind.id);
    }
}

#[test]
fn every_right_name_is_an_effect() {
    for name in causes::KINDS.iter().flat_map(|kind| kind.right).chain(&causes::OWN) {
        // The whole IMU late has no name of its own yet.
        assert!(*name == "imu_late" || racer::model::effects::card(name).is_some(), "{name}");
    }
}
