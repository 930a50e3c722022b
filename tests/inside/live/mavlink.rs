//! MAVLink against pymavlink, which others wrote; frames, roles, and whom racer listens to.

use crate::support::python;
use crate::support::tongue::{VEHICLE, heartbeat};
use racer::flight::live::answer::Answer;
use racer::flight::live::duty::Duty;
use racer::flight::live::heard::{Heard, Sight};
use racer::flight::live::mavlink::Mavlink;
use racer::flight::live::mavlink::frame::frame;
use racer::flight::live::mavlink::message::{
    ATTITUDE_QUATERNION, HEARTBEAT, LOCAL_POSITION_NED, ODOMETRY, RC_CHANNELS_OVERRIDE, rc_channels_override,
};
use racer::flight::live::phase::{Phase, Reason};
use racer::flight::live::protocol::Protocol;
use racer::flight::live::switch::Switch;
use racer::race::onboard::{Estimate, Setpoint};
use serde_json::{Value, json};
use std::path::Path;

const BOTH: Duty = Duty { source: true, sink: true };

fn answer(phase: Phase, reason: Option<Reason>) -> Answer {
    Answer { phase, reason, armed: false, time_us: 0, setpoint: None }
}

fn flying() -> Answer {
    let setpoint = Setpoint { body_rates: [1.0, 2.0, 3.0], throttle: 0.5, thrust_n: 10.0, thrust_to_weight: 1.0 };
    Answer { setpoint: Some(setpoint), armed: true, ..answer(Phase::Flying, None) }
}

/// What racer says from the first heartbeat of a vehicle to the end of its flight.
fn said() -> Vec<u8> {
    let mut mavlink = Mavlink::new(Some(Switch::Offboard), BOTH);
    mavlink.hear(&frame(0, [3, 1], HEARTBEAT, &heartbeat(false)), 0.0);
    let periods = [
        (0.0, answer(Phase::Waiting, Some(Reason::NotAtStart))),
        (0.01, answer(Phase::Ready, None)),
        (0.02, flying()),
        (1.5, answer(Phase::Ended, Some(Reason::OutsideRange))),
    ];
    periods.iter().flat_map(|(now_s, answer)| mavlink.say(answer, *now_s)).collect()
}

#[test]
fn pymavlink_and_racer_read_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    // What only a rehearsal says.
    let pulses = rc_channels_override([3, 1], [1001, 1002, 1003, 1004, 1005, 1006, 1007, 1008]);
    let sticks = frame(12, [3, 191], RC_CHANNELS_OVERRIDE, &pulses);
    std::fs::write(&from, [said(), sticks].concat()).unwrap();
    let args = [Path::new("tests/python/mavlink_messages.py"), &from, &to];
    let Some(output) = python("pymavlink", &args) else { return };
    let read: Vec<Value> = serde_json::from_slice(&output).unwrap();
    racer_was_read(&read);
    pymavlink_is_read(&std::fs::read(&to).unwrap());
}

fn racer_was_read(read: &[Value]) {
    let kinds: Vec<_> = read.iter().map(|message| message["type"].as_str().unwrap()).collect();
    let commands = ["COMMAND_LONG"; 4];
    let wanted = [
        &["HEARTBEAT"][..],
        &commands,
        &["STATUSTEXT", "STATUSTEXT", "SET_ATTITUDE_TARGET", "STATUSTEXT", "SET_ATTITUDE_TARGET"],
        &["HEARTBEAT", "STATUSTEXT", "RC_CHANNELS_OVERRIDE"],
    ];
    assert_eq!(kinds, wanted.concat());
    for (i, message) in read.iter().enumerate() {
        assert_eq!(
            (&message["system"], &message["component"], &message["sequence"]),
            (&json!(3), &json!(191), &json!(i))
        );
    }
    let fields = |i: usize| &read[i]["fields"];
    assert_eq!(fields(0)["type"], 18);
    assert_eq!(fields(0)["autopilot"], 8);
    let asked = fields(1);
    assert_eq!((&asked["command"], &asked["param1"], &asked["param2"]), (&json!(511), &json!(331.0), &json!(5000.0)));
    assert_eq!((&asked["target_system"], &asked["target_component"]), (&json!(3), &json!(1)));
    assert_eq!(fields(5)["text"], "racer waiting: the vehicle is not on the start pad");
    let idle = fields(7);
    assert_eq!((&idle["thrust"], &idle["body_roll_rate"], &idle["type_mask"]), (&json!(0.0), &json!(0.0), &json!(128)));
    let target = fields(9);
    let rates =
        ["body_roll_rate", "body_pitch_rate", "body_yaw_rate", "thrust"].map(|name| target[name].as_f64().unwrap());
    assert_eq!(rates, [1.0, -2.0, -3.0, 0.5]);
    assert_eq!((&target["time_boot_ms"], &target["q"]), (&json!(20), &json!([1.0, 0.0, 0.0, 0.0])));
    assert_eq!(fields(11)["text"], "racer ended: the policy saw what it was not traine");
    let sticks = fields(12);
    assert_eq!((&sticks["target_system"], &sticks["target_component"]), (&json!(3), &json!(1)));
    assert!((1..=8).all(|i| sticks[&format!("chan{i}_raw")] == 1000 + i), "{sticks}");
}

fn state(time_us: u64, position: [f32; 3], velocity: [f32; 3], attitude: [f32; 4]) -> Heard {
    let body_rates = [0.25, -0.5, -0.75];
    Heard::State(Sight { time_us, estimate: Estimate { position, velocity, attitude, body_rates, voltage: f32::NAN } })
}

/// Equal, but for rounding and for missing voltages.
fn same(a: &[Heard], b: &[Heard]) -> bool {
    let text = |heard: &[Heard]| {
        let rounded = heard.iter().map(|heard| match *heard {
            Heard::State(mut sight) => {
                sight.estimate.attitude = sight.estimate.attitude.map(|x| (x * 1e4).round() / 1e4 + 0.0);
                Heard::State(sight)
            }
            Heard::Voltage(volts) => Heard::Voltage((volts * 1e3).round()),
            other => other,
        });
        format!("{:?}", rounded.collect::<Vec<_>>())
    };
    text(a) == text(b)
}

fn pymavlink_is_read(bytes: &[u8]) {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let switches = |held| Heard::Switch { held, for_s: 0.5 };
    // By hand, from the axes of 0.5, 0.5, -0.5, 0.5: forward is down, right is south, down is west, which is a quarter
    // turn about the axis that points north. Level and heading north is a quarter turn to the left from heading east.
    let parts = state(1_000_000, [2.0, 1.0, -3.0], [5.0, 4.0, -6.0], [-half, 0.0, -half, 0.0]);
    let rest = [
        state(7_000_001, [1.0, -2.0, -3.0], [4.0, -5.0, -6.0], [1.0, 0.0, 0.0, 0.0]),
        state(7_010_001, [2.0, 1.0, -3.0], [5.0, 4.0, -6.0], [-half, 0.0, 0.0, -half]),
        // The estimator says that it has failed.
        Heard::Foreign,
    ];
    let battery = [Heard::Voltage(24.006)];
    for (switch, told) in [
        (Switch::Channel(8), [switches(false)]),
        (Switch::Button(2), [switches(true)]),
        (Switch::Button(3), [switches(false)]),
        (Switch::Offboard, [Heard::Switch { held: true, for_s: 2.5 }]),
    ] {
        let heard = Mavlink::new(Some(switch), BOTH).hear(bytes, 0.0);
        let (switched, others): (Vec<_>, Vec<_>) =
            heard.into_iter().partition(|heard| matches!(heard, Heard::Switch { .. }));
        assert_eq!(switched, told, "{switch:?}");
        let wanted = [&[Heard::Voltage(23.456), parts], battery.as_slice(), &rest].concat();
        assert!(same(&others, &wanted), "{others:?}\n{wanted:?}");
    }
}

#[test]
fn the_first_autopilot_is_the_vehicle_and_nobody_else() {
    let mut mavlink = Mavlink::new(Some(Switch::Offboard), BOTH);
    let ground = [0, 0, 0, 0, 6, 8, 0, 4, 3];
    let held = |heard: &[Heard]| heard.iter().any(|heard| matches!(heard, Heard::Switch { held: true, .. }));
    assert_eq!(mavlink.hear(&frame(0, [255, 190], HEARTBEAT, &ground), 0.0), []);
    assert!(mavlink.say(&flying(), 0.0).len() < 100, "nobody is told to fly");
    assert!(held(&mavlink.hear(&frame(0, VEHICLE, HEARTBEAT, &heartbeat(true)), 0.0)));
    assert_eq!(mavlink.hear(&frame(0, [2, 1], HEARTBEAT, &heartbeat(true)), 0.0), []);
    // The camera of the same vehicle.
    assert_eq!(mavlink.hear(&frame(0, [1, 100], ODOMETRY, &[1; 230]), 0.0), []);
    let lost = mavlink.hear(&frame(4, VEHICLE, HEARTBEAT, &heartbeat(false)), 0.0);
    assert_eq!(lost, [Heard::Lost(3), Heard::Switch { held: false, for_s: 2.5 }]);
    // Once more, and an older one.
    for sequence in [4, 2] {
        let heard = mavlink.hear(&frame(sequence, VEHICLE, HEARTBEAT, &heartbeat(false)), 0.0);
        assert_eq!(heard.len(), 1, "{heard:?}");
    }
}

#[test]
fn a_frame_that_is_not_known_is_no_state() {
    let mut payload = [0u8; 233];
    payload[20..24].copy_from_slice(&1f32.to_le_bytes());
    let mut mavlink = Mavlink::new(None, BOTH);
    mavlink.hear(&frame(0, VEHICLE, HEARTBEAT, &heartbeat(false)), 0.0);
    let mut hear = |frames: [u8; 2]| {
        payload[228..230].copy_from_slice(&frames);
        matches!(mavlink.hear(&frame(1, VEHICLE, ODOMETRY, &payload), 0.0)[..], [Heard::State(_)])
    };
    let known = [[1, 12], [1, 1], [1, 8], [20, 12], [20, 20], [4, 12], [21, 21]];
    assert!(known.map(&mut hear).iter().all(|state| *state));
    assert!([[0, 12], [1, 0], [18, 12], [1, 13]].map(hear).iter().all(|state| !*state));
}

#[test]
fn a_state_in_parts_is_as_old_as_its_older_part() {
    let mut mavlink = Mavlink::new(None, BOTH);
    mavlink.hear(&frame(0, VEHICLE, HEARTBEAT, &heartbeat(false)), 0.0);
    let mut sequence = 0;
    let mut hear = |id: u32, time_ms: u32| {
        sequence += 1;
        let mut payload = time_ms.to_le_bytes().to_vec();
        payload.extend([1.0f32, 0.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()));
        match mavlink.hear(&frame(sequence, VEHICLE, id, &payload), 0.0)[..] {
            [] => None,
            [Heard::State(sight)] => Some(sight.time_us),
            ref other => panic!("{other:?}"),
        }
    };
    let (place, turn) = (LOCAL_POSITION_NED, ATTITUDE_QUATERNION);
    let heard =
        [(place, 10), (turn, 12), (turn, 14), (place, 20), (place, 30), (turn, 30)].map(|(id, ms)| hear(id, ms));
    assert_eq!(heard, [None, Some(10_000), None, Some(14_000), None, Some(30_000)]);
}
