//! Flights on the ground: the plant against the simulator, and a whole rehearsal with a small firmware of our own.

mod ardupilot;

use racer::base::lane::Level;
use racer::flight::instruments::Instruments;
use racer::flight::live::heard::{Heard, Sight};
use racer::flight::live::phase::{Phase, Reason};
use racer::flight::live::{Live, Mission};
use racer::flight::rehearse::airframe::Airframe;
use racer::flight::rehearse::betaflight::wire::{BetaflightWire, Ports};
use racer::flight::rehearse::betaflight::{STATE_BYTES, STICKS_BYTES, full_rates};
use racer::flight::rehearse::clock::SharedClock;
use racer::flight::rehearse::plant::Plant;
use racer::flight::rehearse::{Rehearsal, STEP_S, flown};
use racer::flight::sensors::SensorConfig;
use racer::flight::{fly, mcap, write};
use racer::model::dynamics::{Craft, Factors, State, response};
use racer::model::vehicle::Vehicle;
use racer::race::onboard::{Estimate, Surroundings};
use racer::race::snapshot::Snapshot;
use std::net::UdpSocket;
use std::path::Path;
use std::time::Duration;

const LEVEL: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

fn policy() -> Snapshot {
    Snapshot::read(Path::new("tests/golden/policy-73e7003.safetensors")).unwrap()
}

fn mission(policy: &Snapshot, laps: u32) -> Mission {
    let (track, vehicle) = (policy.about.track.clone(), policy.about.vehicle.clone());
    let (network, range) = (policy.network.clone(), policy.ranges());
    Mission { network, track, vehicle, range, laps: Some(laps), lead: 0 }
}

fn on_pad(mission: &Mission) -> Plant {
    let start = &mission.track.start;
    let (sin, cos) = (0.5 * start.heading_rad()).sin_cos();
    let airframe = Airframe::of(&mission.vehicle);
    Plant::new(&mission.vehicle, airframe, STEP_S, start.position_m, [cos, 0.0, 0.0, sin])
}

/// Lap times, s.
fn laps(passes: &[f64], gates: usize) -> Vec<f64> {
    let crossings: Vec<f64> = passes.iter().step_by(gates).copied().collect();
    crossings.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn forecast(policy: &Snapshot) -> f64 {
    let sensors = SensorConfig::load("ideal").unwrap();
    fly::by_policy(Level::best(), &policy.race(None), &policy.network, &sensors, 1, 8.0).laps[1]
}

#[test]
fn with_equal_motors_it_moves_as_the_simulator_does() {
    for name in ["seed_class", "a2rl_class"] {
        let vehicle = Vehicle::load(name).unwrap();
        let mut plant = Plant::new(&vehicle, Airframe::of(&vehicle), STEP_S, [0.0, 0.0, 50.0], LEVEL);
        plant.resting = false;
        let state = State::new([0.0, 0.0, 50.0], [0.0; 3], LEVEL, [0.0, 0.0, 0.0, -1.0], vehicle.battery.full_v);
        let mut craft = Craft::new(&vehicle, &Factors::NOMINAL, STEP_S, state);
        for step in 0..2000 {
            let throttle = [0.2, 0.9, 0.0, 0.5][step / 500];
            plant.step([throttle; 4]);
            craft.step([0.0, 0.0, 0.0, 2.0 * throttle - 1.0]);
        }
        let (actual, state) = (plant.actual(), craft.state);
        let off = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        assert!(state.velocity[2].abs() > 1.0, "{name}: it does move");
        assert!(off(actual.position, state.position) < 5e-3, "{name}: {actual:?} {state:?}");
        assert!(off(actual.velocity, state.velocity) < 5e-3, "{name}: {actual:?} {state:?}");
        assert!(off(actual.specific_force, craft.specific_force()) < 2e-2, "{name}");
        assert!((actual.voltage - craft.terminal_voltage()).abs() < 1e-6, "{name}");
    }
}

#[test]
fn it_rests_until_its_rotors_carry_it_and_stands_where_it_comes_down() {
    let vehicle = Vehicle::load("seed_class").unwrap();
    let mut plant = Plant::new(&vehicle, Airframe::of(&vehicle), STEP_S, [0.0; 3], LEVEL);
    (0..500).for_each(|_| plant.step([0.1; 4]));
    assert!(plant.resting && plant.body.position == [0.0; 3] && plant.voltage() == vehicle.battery.full_v);
    (0..500).for_each(|_| plant.step([0.4; 4]));
    assert!(!plant.resting && plant.body.position[2] > 0.2 && plant.voltage() < vehicle.battery.full_v);
    (0..2000).for_each(|_| plant.step([0.0, 0.0, 0.1, 0.1]));
    assert!(plant.resting && plant.body.position[2] == 0.0 && plant.rates == [0.0; 3]);
    assert_eq!(plant.actual().specific_force, [0.0, 0.0, vehicle.gravity_m_s2]);
}

#[test]
fn with_an_ideal_rate_loop_it_laps_as_the_simulator_does() {
    let policy = policy();
    let mission = mission(&policy, 2);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let mut live = Live::new(&mission, &around);
    let mut plant = on_pad(&mission);
    let alpha = mission.vehicle.time_constants().map(|tau| response::alpha(tau, STEP_S));
    for period in 0..800 {
        let (now, time_s) = (plant.actual(), f64::from(period) * 0.01);
        let estimate = Estimate {
            position: now.position.map(|x| x as f32),
            velocity: now.velocity.map(|x| x as f32),
            attitude: now.attitude.map(|x| x as f32),
            body_rates: now.body_rates.map(|x| x as f32),
            voltage: now.voltage as f32,
        };
        live.receive(Heard::Switch { held: period > 2, for_s: 1.0 }, time_s);
        live.receive(Heard::State(Sight { time_us: (1e6 * time_s) as u64, estimate }), time_s);
        let answer = live.tick(time_s, false);
        if answer.phase == Phase::Ended {
            break;
        }
        let Some(setpoint) = answer.setpoint else { continue };
        for _ in 0..10 {
            // Instead of motors that differ: the lag that the simulator gives the rates.
            let wanted = setpoint.body_rates.map(f64::from);
            let rates: [f64; 3] = std::array::from_fn(|i| response::toward(plant.rates[i], wanted[i], alpha[i]));
            plant.step([f64::from(setpoint.throttle); 4]);
            plant.rates = rates;
        }
    }
    assert_eq!(live.machine.reason, Some(Reason::LapsDone));
    let (found, expected) = (laps(&live.passes, mission.track.gates.len())[1], forecast(&policy));
    assert!((found / expected - 1.0).abs() < 0.01, "{found} s for {expected}");
}

/// A flight controller that fits on a page: a proportional rate loop and a mixer, which speaks Betaflight's packets and
/// keeps racer's time. It ends when nothing comes any more.
fn firmware(listens: &UdpSocket, motors: u16, clock: u16, full: [f64; 3]) {
    let out = UdpSocket::bind("127.0.0.1:0").unwrap();
    let send = |bytes: &[u8], port: u16| out.send_to(bytes, ("127.0.0.1", port)).map(drop).unwrap();
    listens.set_read_timeout(Some(Duration::from_secs(3))).unwrap();
    let (mut bytes, mut sticks) = ([0; 200], [1500u16, 1500, 988, 1500, 1000]);
    send(b"t", clock);
    while let Ok(length) = listens.recv(&mut bytes) {
        if length == STICKS_BYTES {
            sticks = std::array::from_fn(|i| u16::from_ne_bytes([bytes[8 + 2 * i], bytes[9 + 2 * i]]));
            send(b"r", clock);
            continue;
        }
        assert_eq!(length, STATE_BYTES);
        let double = |i: usize| f64::from_ne_bytes(bytes[8 * i..8 * i + 8].try_into().unwrap());
        let gyro = [double(1), -double(2), double(3)];
        let stick = |i: usize| (f64::from(sticks[i]) - 1500.0) / 500.0;
        let wanted = [stick(0) * full[0], stick(1) * full[1], -stick(3) * full[2]];
        let ask: [f64; 3] = std::array::from_fn(|i| [0.03, 0.03, 0.1][i] * (wanted[i] - gyro[i]));
        let throttle = ((f64::from(sticks[2]) - 1000.0) / 1000.0).max(0.0);
        let mix = [[-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0]];
        let mut packet = vec![4, 0, 0, 0];
        for row in mix {
            let turn: f64 = (0..3).map(|i| row[i] * ask[i]).sum();
            let share = if sticks[4] > 1700 { (0.02 + throttle + turn).clamp(0.02, 1.0) } else { 0.0 };
            packet.extend((1000.0 + 1000.0 * share as f32).to_ne_bytes());
        }
        packet.resize(68, 0);
        send(&packet, motors);
        send(b"t", clock);
    }
}

#[test]
fn a_policy_laps_through_a_firmware_and_its_log_is_read_again() {
    let policy = policy();
    let mission = mission(&policy, 2);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let sensors = SensorConfig::load("typical").unwrap();
    let clock = SharedClock::lockstep().unwrap();
    let listens = UdpSocket::bind("127.0.0.1:0").unwrap();
    let at = listens.local_addr().unwrap().port();
    let motors = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let (told, full) = (clock.port().unwrap(), full_rates(around.full_rate));
    let controller = std::thread::spawn(move || firmware(&listens, motors, told, full));
    let wire = Box::new(BetaflightWire::new(Ports { state: at, sticks: at, motors }, clock).unwrap());
    let instruments = Instruments::new(&sensors, 1);
    let mut rehearsal = Rehearsal::new(on_pad(&mission), wire, instruments, mission.vehicle.mass_kg, around.full_rate);
    let mut live = Live::new(&mission, &around);
    flown::by_policy(&mut rehearsal, &mut live, around.full_rate, 60.0, &|| false).unwrap();
    assert_eq!(live.machine.reason, Some(Reason::LapsDone));
    let (found, expected) = (laps(&live.passes, mission.track.gates.len()), forecast(&policy));
    assert!(found.len() == 2 && (0.95..1.25).contains(&(found[1] / expected)), "{found:?} for {expected}");
    let log = &rehearsal.log;
    assert_eq!((log.motors.count(), log.motors.len()), (4, log.imu.len()));
    assert_eq!(log.states.rows, [[1.0, 0.0], [1.0, 1.0]]);
    let read = mcap::tables(&write::mcap(log).unwrap(), &|_| true).unwrap();
    assert_eq!(read.tables["/motors"].columns["normalized[3]"].len(), log.motors.len());
    controller.join().unwrap();
}

#[test]
fn a_firmware_that_does_not_answer_is_told() {
    let clock = SharedClock::lockstep_within(0.05).unwrap();
    let wire = Box::new(BetaflightWire::new(Ports { state: 9, sticks: 9, motors: 0 }, clock).unwrap());
    let sensors = SensorConfig::load("ideal").unwrap();
    let vehicle = Vehicle::load("seed_class").unwrap();
    let plant = Plant::new(&vehicle, Airframe::of(&vehicle), STEP_S, [0.0; 3], LEVEL);
    let mut rehearsal = Rehearsal::new(plant, wire, Instruments::new(&sensors, 1), 1.0, [10.0; 3]);
    let error = rehearsal.arm().unwrap_err().to_string();
    assert!(error.contains("does not keep racer's time") && error.contains("--clock wall"), "{error}");
}
