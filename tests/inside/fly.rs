//! Recorded flights are those of the model, and their sensors err as configured.

use racer::base::lane::Level;
use racer::base::rng::{Philox, RngStream};
use racer::flight::fly::{by_pilot, by_policy, in_order};
use racer::flight::pilot::Manoeuvre;
use racer::flight::sensors::SensorConfig;
use racer::learn::nn::Network;
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Factors, Parameters, State, specific_force};
use racer::model::vehicle::Vehicle;
use racer::race::config::Setup;
use racer::race::env::Race;
use racer::race::env::observe::OBSERVATIONS;
use racer::race::env::reset::StartPlace;

fn sensors(name: &str) -> SensorConfig {
    SensorConfig::load(name).expect("built in")
}

fn seed_class() -> Vehicle {
    Vehicle::load("seed_class").expect("built in")
}

#[test]
fn the_pilot_takes_off_flies_and_lands_before_the_battery_is_empty() {
    let vehicle = seed_class();
    let flown = by_pilot(&vehicle, &sensors("ideal"), &[], 7, 300.0);
    let log = &flown.log;
    // Two volts at a sixtieth of a volt a second.
    assert!((115.0..140.0).contains(&flown.seconds), "{} s", flown.seconds);
    assert!(
        log.imu.rows[..900].iter().all(|row| row[..5] == [0.0; 5] && (row[5] - vehicle.gravity_m_s2).abs() < 1e-12)
    );
    let last = log.odometry.rows.last().expect("samples");
    assert!(last[2] == 0.0 && last[7..] == [0.0; 3], "{last:?}");
    assert!(flown.top_speed > 15.0 && flown.laps.is_empty() && flown.failure.is_none());
    for (samples, rate) in [(log.setpoint.len(), 100.0), (log.imu.len(), 500.0), (log.odometry.len(), 100.0)] {
        assert!((samples as f64 - rate * flown.seconds).abs() <= 1.0, "{samples} at {rate} Hz");
    }
    let record = log.vehicle.max_rate_rad_s.expect("recorded");
    assert!(log.setpoint.rows.iter().all(|row| row[3] >= 0.0 && row[3] <= 1.0 && row[0].abs() <= record[0]));
}

#[test]
fn the_pilot_flies_exactly_what_is_planned_and_lands() {
    let vehicle = seed_class();
    let order = [Manoeuvre::Punch, Manoeuvre::Dive, Manoeuvre::Punch, Manoeuvre::LowHover];
    let (flown, manoeuvres) = in_order(&vehicle, &sensors("ideal"), &order, 3, 300.0);
    assert_eq!(manoeuvres.iter().map(|m| m.kind).collect::<Vec<_>>(), order);
    assert!(manoeuvres.windows(2).all(|pair| pair[0].span_s[1] == pair[1].span_s[0]), "{manoeuvres:?}");
    let [_, landing] = manoeuvres[3].span_s;
    assert!(flown.seconds > landing && flown.seconds < landing + 25.0, "{} s, {manoeuvres:?}", flown.seconds);
    let last = flown.log.odometry.rows.last().expect("samples");
    assert!(last[2] == 0.0 && last[7..] == [0.0; 3], "{last:?}");
    let fullest = flown.log.setpoint.rows.iter().map(|row| row[3]).fold(0.0, f64::max);
    assert_eq!(fullest, 1.0, "a punch is at full throttle");
    // Too short a flight lands before it is done.
    let more = order.repeat(4);
    assert!(in_order(&vehicle, &sensors("ideal"), &more, 3, 45.0).1.len() < more.len());
}

/// What is felt is what moves: integrated specific force and gravity give the recorded velocities.
#[test]
fn specific_force_is_the_acceleration() {
    let flown = by_pilot(&seed_class(), &sensors("ideal"), &[Manoeuvre::Forward, Manoeuvre::RollFlip], 3, 60.0);
    let log = &flown.log;
    assert_eq!(log.imu.time_s[5000], 10.0);
    let in_world = |row: &[f64; 10], v: [f64; 3]| {
        let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]));
        q * nalgebra::Vector3::from(v)
    };
    let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
    for k in 1000..5000 {
        // Odometry comes with every fifth sample of the IMU.
        let (a, b) = (&log.odometry.rows[k], &log.odometry.rows[k + 1]);
        let [before, after] = [a, b].map(|row| in_world(row, [row[7], row[8], row[9]]));
        let mut v = before;
        for j in 5 * k..5 * k + 5 {
            let force = |j: usize, row| in_world(row, [3, 4, 5].map(|i| log.imu.rows[j][i]));
            // Trapezes; the attitude goes evenly from one sample of it to the next.
            let share = |j: usize| (j - 5 * k) as f64 / 5.0;
            let mean = |j: usize| force(j, a) * (1.0 - share(j)) + force(j, b) * share(j);
            let half = 0.5 * 0.002;
            v += (mean(j) + mean(j + 1)) * half - nalgebra::Vector3::z() * (9.80665 * 2.0 * half);
        }
        worst = worst.max((v - after).norm());
        fastest = fastest.max(after.norm());
    }
    assert!(worst < 0.05 && fastest > 15.0, "{worst} m/s off within 10 ms, at up to {fastest} m/s");
}

/// In free fall nothing is felt; hovering, gravity is.
#[test]
fn specific_force_of_fall_and_hover() {
    let mut vehicle = seed_class();
    let hover = vehicle.hover_command(23.0);
    let state = |thrust: f64, velocity: [f64; 3]| {
        State::new([0.0; 3], velocity, [0.8, 0.6, 0.0, 0.0], [0.0, 0.0, 0.0, thrust], 23.0)
    };
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, CONTROL_S);
    let [x, y, z] = specific_force(&state(hover, [0.0; 3]), &parameters);
    assert!(x == 0.0 && y == 0.0 && (z - vehicle.gravity_m_s2).abs() < 1e-9);
    // Drag is against the velocity: 12 m/s along the body's y.
    let [_, y, _] = specific_force(&state(hover, [0.0, 12.0 * 0.28, 12.0 * 0.96]), &parameters);
    assert!((y + parameters.drag[1] * 144.0).abs() < 1e-9, "{y}");
    vehicle.thrust_n = [0.0; 6];
    let falling = Parameters::new(&vehicle, &Factors::NOMINAL, CONTROL_S);
    assert_eq!(specific_force(&state(0.3, [0.0; 3]), &falling), [0.0; 3]);
}

#[test]
fn errors_of_the_sensors_are_those_configured() {
    let (ideal, typical) = (sensors("ideal"), sensors("typical"));
    let vehicle = seed_class();
    let [truth, log] = [&ideal, &typical].map(|sensors| by_pilot(&vehicle, sensors, &[], 5, 60.0).log);
    assert_eq!(truth.setpoint, log.setpoint);
    for (k, channel) in [(1, &typical.imu.gyro), (4, &typical.imu.specific_force)] {
        let errors: Vec<f64> = truth.imu.rows.iter().zip(&log.imu.rows).map(|(a, b)| b[k] - a[k]).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let sd = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / errors.len() as f64).sqrt();
        // The bias is a single draw.
        assert!((sd / channel.noise - 1.0).abs() < 0.05 && mean.abs() < 4.0 * channel.bias, "{k}: {mean} +- {sd}");
    }
    let [volts, same] = [&log, &by_pilot(&vehicle, &typical, &[], 5, 60.0).log].map(|log| log.battery.column(0));
    assert_eq!(volts, same, "a seed repeats");
    assert!(volts.iter().all(|v| (v * 100.0 - (v * 100.0).round()).abs() < 1e-6));
    assert!(log.odometry.rows.iter().all(|row| (row[3..7].iter().map(|q| q * q).sum::<f64>() - 1.0).abs() < 1e-6));
}

/// A policy's log holds the states of its race as an evaluation flies it.
#[test]
fn a_policy_flies_as_it_is_scored() {
    let Setup { config, track, vehicle } = Setup::load("a2rl", &[]).expect("built in");
    let race = Race::new(&config.env, &track, &vehicle, 1).scored(&track);
    let network = Network::initialised(OBSERVATIONS, -0.5, &mut Philox::new(3).sequence(RngStream::Weights, 0, 0));
    let scored = racer::race::eval::fly::fly(Level::best(), &race, &network, StartPlace::Pad, 1, 300);
    let flown = by_policy(Level::best(), &race, &network, &sensors("ideal"), 1, 3.0);
    assert_eq!(flown.log.setpoint.len(), scored.trace.len());
    assert_eq!(flown.failure.is_some(), scored.flights[0].failure.is_some());
    for (row, moment) in flown.log.odometry.rows.iter().zip(&scored.trace) {
        assert_eq!([row[0], row[1], row[2]], [moment.x, moment.y, moment.z].map(f64::from));
    }
}
