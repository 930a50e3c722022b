//! A policy that flies a vehicle over a link: a whole flight against a simulated vehicle, and every fault.

use racer::flight::live::guard::{OUTSIDE_STEPS, STALE_S};
use racer::flight::live::packet::{Answer, Sight, state};
use racer::flight::live::phase::{Phase, Reason};
use racer::flight::live::{Live, Mission};
use racer::flight::{Readable, mcap, write};
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Craft, Factors, State};
use racer::race::onboard::{AT_START, Estimate, Surroundings};
use racer::race::snapshot::Snapshot;
use std::path::Path;

fn mission(laps: Option<u32>) -> Mission {
    let snapshot = Snapshot::read(Path::new("tests/golden/policy-73e7003.safetensors")).unwrap();
    let range = snapshot.ranges();
    Mission { network: snapshot.network, track: snapshot.about.track, vehicle: snapshot.about.vehicle, range, laps }
}

/// The nominal vehicle on the pad, and what it sends.
struct Peer {
    craft: Craft<f32>,
    number: u32,
    now_s: f64,
    rests: bool,
}

impl Peer {
    fn new(mission: &Mission) -> Self {
        let start = mission.track.start;
        let (sin, cos) = (0.5 * start.heading_rad()).sin_cos();
        let attitude = [cos, 0.0, 0.0, sin];
        let state =
            State::new(start.position_m, [0.0; 3], attitude, AT_START.map(f64::from), mission.vehicle.battery.full_v);
        let craft = Craft::new(&mission.vehicle, &Factors::NOMINAL, CONTROL_S, state).map(|x| x as f32);
        Self { craft, number: 0, now_s: 0.0, rests: true }
    }

    fn sight(&self, switch: bool) -> Sight {
        let State { position, velocity, attitude, .. } = self.craft.state;
        let (body_rates, voltage) = (self.craft.body_rates(), self.craft.terminal_voltage());
        let estimate = Estimate { position, velocity, attitude, body_rates, voltage };
        // Its clock began elsewhere.
        Sight { number: self.number, time_us: 77_000_000 + (self.now_s * 1e6) as u64, estimate, switch }
    }

    /// 10 ms under what was answered. Without a setpoint it stays where it is.
    fn fly(&mut self, answer: &Answer, mission: &Mission) {
        if let Some(s) = answer.setpoint {
            let full = mission.vehicle.max_rates_rad_s();
            let [x, y, z] = std::array::from_fn(|i| s.body_rates[i] / full[i] as f32);
            self.craft.step([x, y, z, 2.0 * s.throttle - 1.0]);
            self.rests = false;
        }
        self.number += 1;
        self.now_s += CONTROL_S;
    }
}

/// What the link does to the packets of one period, and the user to the keys.
type Fault<'a> = &'a dyn Fn(usize, Sight) -> (Vec<Vec<u8>>, bool);

/// Flies for so many periods after the switch is held, and gives the flight and its last answer.
fn flown<'a>(
    mission: &'a Mission,
    around: &'a Surroundings,
    periods: usize,
    fault: Fault,
) -> (Live<'a>, Answer, Vec<Phase>) {
    let mut live = Live::new(mission, around);
    let mut peer = Peer::new(mission);
    let mut phases = Vec::new();
    let mut answer = live.tick(0.0, false);
    for period in 0..periods + 5 {
        let sight = peer.sight(period >= 5);
        let (packets, key) = match period.checked_sub(5) {
            Some(flying) => fault(flying, sight),
            None => (vec![state(&sight)], false),
        };
        packets.iter().for_each(|packet| live.receive(packet, peer.now_s + 0.002));
        answer = live.tick(peer.now_s + 0.004, key);
        if phases.last() != Some(&answer.phase) {
            phases.push(answer.phase);
        }
        peer.fly(&answer, mission);
    }
    (live, answer, phases)
}

#[test]
fn a_simulated_vehicle_is_flown_round_its_laps_and_logged() {
    let mission = mission(Some(2));
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let (live, answer, phases) = flown(&mission, &around, 700, &|_, sight| (vec![state(&sight)], false));
    assert_eq!(phases, [Phase::Ready, Phase::Flying, Phase::Ended]);
    assert_eq!((answer.reason, live.gates), (Some(Reason::LapsDone), 9));
    assert!(answer.setpoint.is_none() && live.link.lost == 0 && live.link.late == 0);
    assert!(live.ages.longest_s < 0.003, "{}", live.ages.longest_s);
    // Two laps of 1.784 s, and from the pad to the first gate.
    let log = &live.record.log;
    let span = log.setpoint.time_s.last().unwrap() - log.setpoint.time_s[0];
    assert!((3.6..5.0).contains(&span), "{span} s");
    let read = mcap::tables(&write::mcap(log).unwrap(), &|_| true).unwrap();
    assert_eq!(read.readable, Readable::Whole);
    assert_eq!(read.tables["/setpoint"].columns["thrust"].len(), log.setpoint.len());
    assert_eq!(read.tables["/odom"].columns["pose.pose.position.x"].len(), log.odometry.len());
}

#[test]
fn a_lost_a_doubled_and_an_unusable_packet_are_bridged_and_counted() {
    let mission = mission(Some(1));
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let fault = |period: usize, sight: Sight| match period % 20 {
        3 => (vec![], false),
        7 => (vec![state(&sight), state(&sight)], false),
        11 => {
            let mut bad = sight;
            bad.estimate.velocity[1] = f32::NAN;
            (vec![state(&bad)], false)
        }
        15 => (vec![b"something else".to_vec(), state(&sight)], false),
        _ => (vec![state(&sight)], false),
    };
    let (live, answer, _) = flown(&mission, &around, 500, &fault);
    assert_eq!(answer.reason, Some(Reason::LapsDone), "{:?}", live.link);
    let link = &live.link;
    assert!(link.late >= 10 && link.unusable >= 10 && link.foreign >= 10 && link.lost >= 20, "{link:?}");
}

#[test]
fn every_fault_ends_the_flight_for_its_own_reason() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let ended = |what: &str, reason: Reason, fault: Fault| {
        let (_, answer, phases) = flown(&mission, &around, 150, fault);
        assert_eq!((answer.phase, answer.reason), (Phase::Ended, Some(reason)), "{what}");
        assert!(answer.setpoint.is_none() && phases.contains(&Phase::Flying), "{what}");
    };
    let changed = |sight: Sight, change: &dyn Fn(&mut Sight)| {
        let mut sight = sight;
        change(&mut sight);
        (vec![state(&sight)], false)
    };
    ended("a lost link", Reason::Stale, &|period, sight| match period {
        0..60 => (vec![state(&sight)], false),
        _ => (vec![], false),
    });
    ended("nothing but numbers that are none", Reason::Stale, &|period, sight| {
        changed(sight, &|s| {
            if period > 60 {
                s.estimate.position[0] = f32::INFINITY
            }
        })
    });
    ended("states that are late", Reason::Stale, &|period, sight| {
        changed(sight, &|s| {
            if period > 60 {
                s.time_us -= 2 * (STALE_S * 1e6) as u64
            }
        })
    });
    ended("the switch", Reason::SwitchReleased, &|period, sight| changed(sight, &|s| s.switch = period < 60));
    ended("a key", Reason::Key, &|period, sight| (vec![state(&sight)], period == 60));
    ended("a jump", Reason::Jump, &|period, sight| {
        changed(sight, &|s| {
            if period > 60 {
                s.estimate.position[1] += 2.0
            }
        })
    });
    ended("an empty battery", Reason::LowBattery, &|period, sight| {
        changed(sight, &|s| {
            if period > 60 {
                s.estimate.voltage = 1.0
            }
        })
    });
    let low = mission.range[0][15];
    assert!(low > -10.0 && OUTSIDE_STEPS < 80);
    ended("rates that were never seen", Reason::OutsideRange, &|period, sight| {
        changed(sight, &|s| {
            if period > 10 {
                s.estimate.body_rates = [300.0; 3]
            }
        })
    });
}

#[test]
fn nothing_is_flown_away_from_the_pad_or_with_the_switch_held_from_the_beginning() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let first = |change: &dyn Fn(&mut Sight)| {
        let mut live = Live::new(&mission, &around);
        let mut peer = Peer::new(&mission);
        let mut answer = live.tick(0.0, false);
        assert_eq!((answer.phase, answer.reason), (Phase::Waiting, Some(Reason::NoState)));
        for _ in 0..10 {
            let mut sight = peer.sight(false);
            change(&mut sight);
            live.receive(&state(&sight), peer.now_s);
            answer = live.tick(peer.now_s, false);
            peer.fly(&answer, &mission);
        }
        (answer.phase, answer.reason)
    };
    assert_eq!(first(&|_| {}), (Phase::Ready, None));
    assert_eq!(first(&|s| s.estimate.position[0] += 0.8), (Phase::Waiting, Some(Reason::NotAtStart)));
    assert_eq!(first(&|s| s.estimate.position[2] -= 30.0), (Phase::Waiting, Some(Reason::Fence)));
    assert_eq!(first(&|s| s.estimate.velocity[0] = 1.0), (Phase::Waiting, Some(Reason::NotAtRest)));
    assert_eq!(first(&|s| s.estimate.attitude = [0.0, 0.0, 0.0, 1.0]), (Phase::Waiting, Some(Reason::NotLevel)));
    assert_eq!(first(&|s| s.switch = true), (Phase::Waiting, Some(Reason::SwitchHeld)));
}
