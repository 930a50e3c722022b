//! Sticks over MSP: what a flight controller would make of them.

use racer::flight::live::answer::Answer;
use racer::flight::live::heard::Heard;
use racer::flight::live::msp::Msp;
use racer::flight::live::msp::frame::request;
use racer::flight::live::phase::Phase;
use racer::flight::live::protocol::Protocol;
use racer::flight::live::switch::Switch;
use racer::race::onboard::Setpoint;

fn flying(body_rates: [f32; 3], throttle: f32) -> Answer {
    let setpoint = Setpoint { body_rates, throttle, thrust_n: 1.0, thrust_to_weight: 1.0 };
    Answer { phase: Phase::Flying, reason: None, armed: true, time_us: 0, setpoint: Some(setpoint) }
}

/// The channels of the first frame, us.
fn channels(bytes: &[u8]) -> Vec<u16> {
    assert_eq!(&bytes[..5], [b'$', b'M', b'<', 32, 200]);
    bytes[5..37].chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect()
}

#[test]
fn rates_become_sticks_and_no_setpoint_becomes_none() {
    let mut msp = Msp::new(None, [10.0, 10.0, 5.0], Some(5));
    // Right side down, nose down, nose left: sticks right, forward, left.
    let sticks = channels(&msp.say(&flying([5.0, 2.0, 5.0], 1.0), 0.0));
    assert_eq!(sticks[..6], [1750, 1600, 2000, 1000, 2000, 1000]);
    assert_eq!(channels(&msp.say(&flying([99.0, -99.0, -99.0], 0.0), 0.0))[..4], [2000, 1000, 1050, 2000]);
    let idle = [1500, 1500, 1000, 1500];
    for (phase, armed, arm) in [(Phase::Waiting, false, 1000), (Phase::Ready, true, 2000), (Phase::Ended, false, 1000)]
    {
        let answer = Answer { phase, reason: None, armed, time_us: 0, setpoint: None };
        let sticks = channels(&msp.say(&answer, 0.0));
        assert_eq!((&sticks[..4], sticks[4]), (&idle[..], arm), "{phase:?}");
    }
    let mut pilot_arms = Msp::new(None, [10.0; 3], None);
    assert!(channels(&pilot_arms.say(&flying([0.0; 3], 0.5), 0.0))[4..].iter().all(|us| *us == 1000));
}

/// What a flight controller answers.
fn reply(command: u8, payload: &[u8]) -> Vec<u8> {
    let mut frame = request(command, payload);
    frame[2] = b'>';
    frame
}

/// Sixteen channels as a flight controller reads them out.
pub fn channels_read_back() -> Vec<u8> {
    reply(105, [1500u16; 16].map(u16::to_le_bytes).as_flattened())
}

#[test]
fn channels_and_battery_of_the_flight_controller_are_heard() {
    let mut msp = Msp::new(Some(Switch::Channel(8)), [10.0; 3], None);
    let rc = |us: u16| {
        let channels = [1500u16, 1500, 1500, 1000, 1000, 1000, 1000, us, 1000].map(u16::to_le_bytes);
        reply(105, channels.as_flattened())
    };
    let switch = |held| Heard::Switch { held, for_s: 0.5 };
    assert_eq!(msp.hear(&[rc(1701), rc(1699)].concat(), 0.0), [switch(true), switch(false)]);
    // Shorter than the channel that is asked for: not held.
    assert_eq!(msp.hear(&reply(105, &[0xff; 14]), 0.0), [switch(false)]);
    // Six cells, 25.2 V (the eleventh and twelfth byte), and a board that measures none.
    let mut battery = [6, 0, 0, 252, 0, 0, 0, 0, 0, 0xd8, 0x09];
    assert_eq!(msp.hear(&reply(130, &battery), 0.0), [Heard::Voltage(25.2)]);
    battery[0] = 0;
    assert_eq!(msp.hear(&reply(130, &battery), 0.0), []);
    assert_eq!(msp.hear(&reply(130, &battery[..4]), 0.0), []);
    assert_eq!(Msp::new(None, [1.0; 3], None).hear(&rc(2000), 0.0), []);
}

#[test]
fn sticks_do_not_pile_up_before_a_slow_flight_controller() {
    let mut msp = Msp::new(None, [10.0; 3], None);
    let answer = flying([0.0; 3], 0.5);
    let sent = |msp: &mut Msp, now_s: f64| !msp.say(&answer, now_s).is_empty();
    // Whoever never answers is sent everything.
    assert!((0..20).all(|i| sent(&mut msp, 0.01 * f64::from(i))));
    // One answer in two periods, a hundredth behind: one command in two periods from the third on.
    let mut count = 0;
    for i in 20..120 {
        let now_s = 0.01 * f64::from(i);
        if i % 2 == 0 {
            msp.hear(&reply(200, &[]), now_s);
        }
        count += u32::from(sent(&mut msp, now_s));
    }
    assert!((50..=52).contains(&count), "{count}");
    // It falls silent: after a fifth of a second nothing is waited for.
    assert!(!sent(&mut msp, 1.2) && sent(&mut msp, 1.5));
}

#[test]
fn one_command_in_ten_is_a_question() {
    let kinds = |switch| {
        let mut msp = Msp::new(switch, [10.0; 3], None);
        (0..100).map(|i| msp.say(&flying([0.0; 3], 0.5), 0.01 * f64::from(i))[4]).collect::<Vec<_>>()
    };
    let count = |kinds: &[u8], kind| kinds.iter().filter(|k| **k == kind).count();
    let with = kinds(Some(Switch::Channel(8)));
    assert_eq!([200, 105, 130].map(|kind| count(&with, kind)), [90, 8, 2]);
    assert_eq!([200, 105, 130].map(|kind| count(&kinds(None), kind)), [90, 0, 10]);
}
