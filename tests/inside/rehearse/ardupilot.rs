//! The way to ArduPilot, with a small firmware of our own at its end.

use super::{LEVEL, forecast, laps, mission, on_pad, policy};
use racer::flight::instruments::Instruments;
use racer::flight::live::Live;
use racer::flight::live::mavlink::frame::frame;
use racer::flight::live::mavlink::message::{STATUSTEXT, statustext};
use racer::flight::live::phase::Reason;
use racer::flight::rehearse::airframe::Airframe;
use racer::flight::rehearse::ardupilot::full_rates;
use racer::flight::rehearse::ardupilot::wire::ArduPilotWire;
use racer::flight::rehearse::plant::Plant;
use racer::flight::rehearse::{Rehearsal, STEP_S, flown};
use racer::flight::sensors::SensorConfig;
use racer::model::vehicle::Vehicle;
use racer::race::onboard::Surroundings;
use serde_json::Value;
use std::net::UdpSocket;
use std::time::{Duration, Instant};

/// Front right, rear left, front left, rear right: shares that roll right, lift the nose, and yaw right.
const MIX: [[f64; 3]; 4] = [[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]];

/// A packet of 16 outputs, us.
fn outputs(count: u32, pulses: [u16; 4]) -> Vec<u8> {
    let mut out = [18458_u16.to_le_bytes(), 1000_u16.to_le_bytes()].concat();
    out.extend(count.to_le_bytes());
    pulses.iter().for_each(|us| out.extend(us.to_le_bytes()));
    out.resize(40, 0);
    out
}

/// The eight channels of a MAVLink 2 frame that overrides a receiver's, from a ground station.
fn overridden(bytes: &[u8]) -> [u16; 8] {
    assert_eq!((bytes[0], bytes[5], &bytes[7..10]), (0xfd, 255, [70, 0, 0].as_slice()));
    std::array::from_fn(|i| u16::from_le_bytes([bytes[10 + 2 * i], bytes[11 + 2 * i]]))
}

/// The length of the next state; none where none comes any more. An empty packet asks whether somebody is there.
fn state(sim: &UdpSocket, bytes: &mut [u8]) -> Option<usize> {
    std::iter::from_fn(|| sim.recv(bytes).ok()).find(|length| *length > 0)
}

/// A proportional rate loop in the frames of a flight controller that looks down, which goes by the time it is told.
/// It ends when nothing comes any more, or after so many steps.
fn firmware([physics, link]: [u16; 2], full: [f64; 3], steps: u32) -> f64 {
    let bind = || UdpSocket::bind("127.0.0.1:0").unwrap();
    let (sim, mavlink) = (bind(), bind());
    sim.connect(("127.0.0.1", physics)).unwrap();
    mavlink.connect(("127.0.0.1", link)).unwrap();
    mavlink.set_nonblocking(true).unwrap();
    sim.set_read_timeout(Some(Duration::from_secs(3))).unwrap();
    mavlink.send(&frame(0, [1, 1], STATUSTEXT, &statustext("ArduPilot Ready"))).unwrap();
    let (mut bytes, mut channels, mut time_s) = ([0; 2000], [1500_u16, 1500, 1000, 1500, 1000, 1000, 1000, 1000], 0.0);
    sim.send(&outputs(0, [0; 4])).unwrap();
    for count in 1..=steps {
        let Some(length) = state(&sim, &mut bytes) else { break };
        let said: Value = serde_json::from_slice(&bytes[..length]).unwrap();
        while let Ok(length) = mavlink.recv(&mut bytes) {
            channels = overridden(&bytes[..length]);
        }
        let told = said["timestamp"].as_f64().unwrap();
        assert!((told - time_s - 1e-3).abs() < 2e-6, "{told} after {time_s}");
        time_s = told;
        let stick = |i: usize| (f64::from(channels[i]) - 1500.0) / 500.0;
        let gyro = |i: usize| said["imu"]["gyro"][i].as_f64().unwrap();
        let wanted = [stick(0) * full[0], stick(1) * full[1], stick(3) * full[2]];
        let ask: [f64; 3] = std::array::from_fn(|i| [0.03, 0.03, 0.1][i] * (wanted[i] - gyro(i)));
        let throttle = (f64::from(channels[2]) - 1000.0) / 1000.0;
        let armed = channels[5] > 1700;
        let pulse = |row: [f64; 3]| {
            let turn: f64 = (0..3).map(|i| row[i] * ask[i]).sum();
            if armed { 1000 + (1000.0 * (0.02 + throttle + turn).clamp(0.02, 1.0)) as u16 } else { 1000 }
        };
        let packet = outputs(count, MIX.map(pulse));
        sim.send(&packet).unwrap();
        if count % 100 == 0 {
            // As the firmware does where a state is late.
            sim.send(&packet).unwrap();
        }
    }
    time_s
}

#[test]
fn a_policy_laps_through_ardupilots_packets() {
    let policy = policy();
    let mission = mission(&policy, 2);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let sensors = SensorConfig::load("typical").unwrap();
    let wire = ArduPilotWire::new().unwrap();
    let (ports, full) = (wire.ports(), full_rates(around.full_rate));
    let controller = std::thread::spawn(move || firmware(ports, full, u32::MAX));
    let instruments = Instruments::new(&sensors, 1);
    let mass_kg = mission.vehicle.mass_kg;
    let mut rehearsal = Rehearsal::new(on_pad(&mission), Box::new(wire), instruments, mass_kg, around.full_rate);
    let mut live = Live::new(&mission, &around);
    flown::by_policy(&mut rehearsal, &mut live, around.full_rate, 60.0, &|| false).unwrap();
    assert_eq!(live.machine.reason, Some(Reason::LapsDone));
    let (found, expected) = (laps(&live.passes, mission.track.gates.len()), forecast(&policy));
    assert!(found.len() == 2 && (0.95..1.25).contains(&(found[1] / expected)), "{found:?} for {expected}");
    let flown_s = rehearsal.time_s();
    drop(rehearsal);
    // It was told the time of all steps, those before and after the log, too.
    assert!(controller.join().unwrap() > flown_s + 3.0);
}

fn standing(wire: ArduPilotWire) -> String {
    let sensors = SensorConfig::load("ideal").unwrap();
    let vehicle = Vehicle::load("seed_class").unwrap();
    let plant = Plant::new(&vehicle, Airframe::of(&vehicle), STEP_S, [0.0; 3], LEVEL);
    let mut rehearsal = Rehearsal::new(plant, Box::new(wire), Instruments::new(&sensors, 1), 1.0, [10.0; 3]);
    rehearsal.arm().unwrap_err().to_string()
}

#[test]
fn a_silent_a_dead_and_an_unwilling_firmware_are_told() {
    let silent = standing(ArduPilotWire::within(0.05).unwrap());
    assert!(silent.contains("does not speak"), "{silent}");

    let wire = ArduPilotWire::new().unwrap();
    let ports = wire.ports();
    let controller = std::thread::spawn(move || firmware(ports, [10.0; 3], 50));
    let begun = Instant::now();
    let dead = standing(wire);
    controller.join().unwrap();
    assert!(dead.contains("is gone") && begun.elapsed() < Duration::from_secs(4), "{dead}");

    // One that flies on, but with its motors off.
    let wire = ArduPilotWire::within(2.0).unwrap();
    let [physics, link] = wire.ports();
    let unwilling = std::thread::spawn(move || {
        let bind = || UdpSocket::bind("127.0.0.1:0").unwrap();
        let (sim, mavlink) = (bind(), bind());
        sim.connect(("127.0.0.1", physics)).unwrap();
        mavlink.connect(("127.0.0.1", link)).unwrap();
        sim.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
        let says = |text: &str| mavlink.send(&frame(0, [1, 1], STATUSTEXT, &statustext(text))).map(drop).unwrap();
        says("ArduPilot Ready");
        says("Arm: Compass 1 not healthy");
        let mut count = 0;
        sim.send(&outputs(count, [1000; 4])).unwrap();
        while state(&sim, &mut [0; 2000]).is_some() {
            count += 1;
            sim.send(&outputs(count, [1000; 4])).unwrap();
        }
    });
    let refused = standing(wire);
    unwilling.join().unwrap();
    assert!(refused.contains("does not arm") && refused.contains("Compass 1 not healthy"), "{refused}");
}
