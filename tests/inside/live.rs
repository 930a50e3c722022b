//! A policy that flies a vehicle over a link: a whole flight against a simulated vehicle, and every fault, in every
//! protocol.

mod faults;
mod mavlink;
mod msp;
mod ros2;

use crate::support::feed::feed;
use crate::support::tongue::{ALL, Speech, Told, Tongue};
use crate::support::vehicle::Peer;
use faults::{Fault, Sent, flown};
use proptest::collection::vec;
use proptest::prelude::{any, proptest};
use proptest::sample::Index;
use racer::flight::live::guard::{OUTSIDE_STEPS, STALE_S};
use racer::flight::live::heard::{Heard, Sight};
use racer::flight::live::phase::{Phase, Reason};
use racer::flight::live::{Live, Mission};
use racer::flight::{Readable, mcap, write};
use racer::race::onboard::{Estimate, Surroundings};
use racer::race::snapshot::Snapshot;
use std::path::Path;

/// Heading east.
const LEVEL: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

pub fn mission(laps: Option<u32>) -> Mission {
    let snapshot = Snapshot::read(Path::new("tests/golden/policy-73e7003.safetensors")).unwrap();
    let range = snapshot.ranges();
    let (track, vehicle) = (snapshot.about.track, snapshot.about.vehicle);
    Mission { network: snapshot.network, track, vehicle, range, laps, lead: 0 }
}

/// What a vehicle says in each language, and a flight controller of its channels.
pub fn spoken() -> Vec<Vec<u8>> {
    let estimate =
        Estimate { position: [1.0; 3], velocity: [2.0; 3], attitude: LEVEL, body_rates: [3.0; 3], voltage: 24.0 };
    let told = Told { time_us: 1 << 33, estimate, switch: true };
    let mut all: Vec<_> = ALL.iter().flat_map(|speech| Tongue::new(*speech, [10.0; 3]).encode(&told)).collect();
    all.push(msp::channels_read_back());
    all
}

proptest! {
    /// Any bytes, and what is spoken with some of it changed.
    #[test]
    fn whatever_arrives_is_heard_without_a_panic(
        bytes in vec(any::<u8>(), 0..600),
        which in 0..8usize,
        changes in vec((any::<Index>(), any::<u8>()), 0..6),
    ) {
        feed("links", &bytes);
        let mut spoken = spoken().swap_remove(which);
        for (at, byte) in changes {
            let at = at.index(spoken.len());
            spoken[at] = byte;
        }
        feed("links", &spoken);
    }
}

#[test]
fn a_simulated_vehicle_is_flown_round_its_laps_and_logged() {
    let mission = mission(Some(2));
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    for speech in ALL {
        let tongue = Tongue::new(speech, around.full_rate);
        let (live, answer, phases) = flown(&mission, &around, 700, tongue, &|_, told| vec![Sent::State(told)]);
        assert_eq!(phases, [Phase::Ready, Phase::Flying, Phase::Ended], "{speech:?}: {answer:?}");
        assert_eq!((answer.reason, live.gates), (Some(Reason::LapsDone), 9), "{speech:?}");
        assert!(answer.setpoint.is_none() && live.link.lost == 0 && live.link.late == 0, "{speech:?}");
        assert!(live.ages.longest_s < 0.003, "{}", live.ages.longest_s);
        // Two laps of 1.784 s, and from the pad to the first gate.
        let log = &live.record.log;
        let span = log.setpoint.time_s.last().unwrap() - log.setpoint.time_s[0];
        assert!((3.6..5.0).contains(&span), "{speech:?}: {span} s");
        let read = mcap::tables(&write::mcap(log).unwrap(), &|_| true).unwrap();
        assert_eq!(read.readable, Readable::Whole);
        assert_eq!(read.tables["/setpoint"].columns["thrust"].len(), log.setpoint.len());
        assert_eq!(read.tables["/odom"].columns["pose.pose.position.x"].len(), log.odometry.len());
    }
}

#[test]
fn a_lost_a_doubled_and_an_unusable_state_are_bridged_and_counted() {
    let mission = mission(Some(1));
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let fault = |period: usize, told: Told| match period % 20 {
        3 => vec![],
        7 => vec![Sent::State(told), Sent::Again],
        11 => {
            let mut bad = told;
            bad.estimate.velocity[1] = f32::NAN;
            vec![Sent::State(bad)]
        }
        13 => vec![Sent::Damaged(told)],
        15 => vec![Sent::Bytes(b"something else".to_vec()), Sent::State(told)],
        _ => vec![Sent::State(told)],
    };
    for speech in ALL {
        // What was never sent is missing by its number.
        let (live, answer, _) = flown(&mission, &around, 500, Tongue::new(speech, around.full_rate), &fault);
        assert_eq!(answer.reason, Some(Reason::LapsDone), "{speech:?}: {:?}", live.link);
        let link = &live.link;
        assert!(link.unusable >= 10 && link.foreign >= 20, "{speech:?}: {link:?}");
        // Topics have no numbers.
        assert!(link.lost >= 10 || speech == Speech::Topics, "{speech:?}: {link:?}");
        // A state in parts that comes twice has no newer part.
        assert!(link.late >= 10 || speech == Speech::Parts, "{speech:?}: {link:?}");
    }
}

#[test]
fn every_fault_ends_the_flight_for_its_own_reason() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let low = mission.range[0][15];
    assert!(low > -10.0 && OUTSIDE_STEPS < 80);
    let after = |periods: usize, change: fn(&mut Told)| {
        move |period: usize, mut told: Told| {
            if period > periods {
                change(&mut told);
            }
            vec![Sent::State(told)]
        }
    };
    let lost = |period: usize, told| if period < 60 { vec![Sent::State(told)] } else { vec![] };
    let damaged = |period: usize, told| vec![if period < 60 { Sent::State(told) } else { Sent::Damaged(told) }];
    let foreign = |period: usize, told| match period {
        0..60 => vec![Sent::State(told)],
        _ => vec![Sent::Bytes(vec![0xfd; 300]), Sent::Bytes(vec![b'$'; 300])],
    };
    let again = |period: usize, told| vec![if period < 60 { Sent::State(told) } else { Sent::Again }];
    let key = |period: usize, told| match period {
        60 => vec![Sent::State(told), Sent::Key],
        _ => vec![Sent::State(told)],
    };
    let faults: [(&str, Reason, Fault); 12] = [
        ("a lost link", Reason::Stale, &lost),
        ("nothing but damaged states", Reason::Stale, &damaged),
        ("nothing but other bytes", Reason::Stale, &foreign),
        ("the same again and again", Reason::Stale, &again),
        ("numbers that are none", Reason::Stale, &after(60, |told| told.estimate.position[0] = f32::INFINITY)),
        ("no unit quaternion", Reason::Stale, &after(60, |told| told.estimate.attitude = [0.0; 4])),
        ("states that are late", Reason::Stale, &after(60, |told| told.time_us -= 2 * (STALE_S * 1e6) as u64)),
        ("the switch", Reason::SwitchReleased, &after(60, |told| told.switch = false)),
        ("a key", Reason::Key, &key),
        ("a jump", Reason::Jump, &after(60, |told| told.estimate.position[1] += 2.0)),
        ("an empty battery", Reason::LowBattery, &after(60, |told| told.estimate.voltage = 1.0)),
        ("rates never seen", Reason::OutsideRange, &after(10, |told| told.estimate.body_rates = [300.0; 3])),
    ];
    for speech in ALL {
        for (what, reason, fault) in faults {
            let (_, answer, phases) = flown(&mission, &around, 150, Tongue::new(speech, around.full_rate), fault);
            assert_eq!((answer.phase, answer.reason), (Phase::Ended, Some(reason)), "{speech:?}: {what}");
            assert!(answer.setpoint.is_none() && phases.contains(&Phase::Flying), "{speech:?}: {what}");
        }
    }
}

#[test]
fn nothing_is_flown_away_from_the_pad_or_with_the_switch_held_from_the_beginning() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let first = |change: &dyn Fn(&mut Told)| {
        let mut live = Live::new(&mission, &around);
        let mut peer = Peer::new(&mission);
        let mut answer = live.tick(0.0, false);
        assert_eq!((answer.phase, answer.reason), (Phase::Waiting, Some(Reason::NoState)));
        for _ in 0..10 {
            let mut told = peer.told(false);
            change(&mut told);
            live.receive(Heard::Switch { held: told.switch, for_s: 0.1 }, peer.now_s);
            live.receive(Heard::State(Sight { time_us: told.time_us, estimate: told.estimate }), peer.now_s);
            answer = live.tick(peer.now_s, false);
            peer.fly(None);
        }
        (answer.phase, answer.reason)
    };
    assert_eq!(first(&|_| {}), (Phase::Ready, None));
    assert_eq!(first(&|s| s.estimate.position[0] += 0.8), (Phase::Waiting, Some(Reason::NotAtStart)));
    assert_eq!(first(&|s| s.estimate.position[2] -= 30.0), (Phase::Waiting, Some(Reason::Fence)));
    assert_eq!(first(&|s| s.estimate.velocity[0] = 1.0), (Phase::Waiting, Some(Reason::NotAtRest)));
    assert_eq!(first(&|s| s.estimate.attitude = [0.0, 0.0, 0.0, 1.0]), (Phase::Waiting, Some(Reason::NotLevel)));
    assert_eq!(first(&|s| s.estimate.voltage = f32::NAN), (Phase::Waiting, Some(Reason::NoVoltage)));
    assert_eq!(first(&|s| s.switch = true), (Phase::Waiting, Some(Reason::SwitchHeld)));
}

#[test]
fn what_is_told_apart_is_believed_for_its_time_only() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let mut live = Live::new(&mission, &around);
    let mut told = Peer::new(&mission).told(false);
    let voltage = told.estimate.voltage;
    told.estimate.voltage = f32::NAN;
    let mut at = |now_s: f64, parts: &[Heard]| {
        parts.iter().for_each(|heard| live.receive(*heard, now_s));
        let time_us = told.time_us + (now_s * 1e6) as u64;
        live.receive(Heard::State(Sight { time_us, estimate: told.estimate }), now_s);
        let answer = live.tick(now_s, false);
        (answer.phase, answer.reason)
    };
    assert_eq!(at(0.0, &[]), (Phase::Waiting, Some(Reason::NoVoltage)));
    assert_eq!(at(0.01, &[Heard::Voltage(voltage)]), (Phase::Ready, None));
    assert_eq!(at(4.9, &[Heard::Voltage(f32::NAN), Heard::Voltage(0.0)]), (Phase::Ready, None));
    assert_eq!(at(5.1, &[]), (Phase::Waiting, Some(Reason::NoVoltage)));
    assert_eq!(at(5.2, &[Heard::Voltage(voltage)]), (Phase::Ready, None));
    assert_eq!(at(5.3, &[Heard::Switch { held: true, for_s: 0.5 }]).0, Phase::Flying);
    assert_eq!(at(5.7, &[]).0, Phase::Flying);
    assert_eq!(at(5.9, &[]), (Phase::Ended, Some(Reason::SwitchReleased)));
}

#[test]
fn a_clock_that_begins_again_before_the_flight_is_taken_and_in_flight_ends_it() {
    let mission = mission(None);
    let around = Surroundings::of(&mission.track, &mission.vehicle);
    let mut live = Live::new(&mission, &around);
    let estimate = Peer::new(&mission).told(false).estimate;
    let mut at = |now_s: f64, time_us: u64, held: bool| {
        live.receive(Heard::Switch { held, for_s: 0.1 }, now_s);
        live.receive(Heard::State(Sight { time_us, estimate }), now_s);
        let answer = live.tick(now_s, false);
        (answer.phase, answer.reason)
    };
    assert_eq!(at(0.0, 90_000_000, false).0, Phase::Ready);
    assert_eq!(at(0.1, 5_000, false).0, Phase::Ready);
    assert_eq!(at(0.11, 15_000, true).0, Phase::Flying);
    assert_eq!(at(0.12, 25_000, true).0, Phase::Flying);
    // A time that is not to be had yet is believed; what follows is too old then.
    assert_eq!(at(0.13, 900_000, true).0, Phase::Flying);
    assert_eq!(
        (2..9).map(|i| at(0.12 + 0.01 * f64::from(i), 25_000 + 10_000 * i as u64, true)).last().unwrap(),
        (Phase::Ended, Some(Reason::Stale))
    );
}
