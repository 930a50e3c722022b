//! Switches over ROS 2, and two of its nodes that meet over DDS.

use racer::flight::live::duty::Duty;
use racer::flight::live::heard::Heard;
use racer::flight::live::protocol::Protocol;
use racer::flight::live::ros2::{Ros2, RosTopic};
use racer::flight::live::switch::Switch;

/// Behind a header without a frame: so many bytes before it, then `body`.
fn message(topic: RosTopic, body: &[u8]) -> Vec<u8> {
    let header = [0u32, 0, 1].map(u32::to_le_bytes);
    [&[topic as u8, 0, 1, 0, 0], header.as_flattened(), &[0], body].concat()
}

#[test]
fn channels_buttons_and_modes_are_switches() {
    let duty = Duty { source: true, sink: false };
    let held = |switch, bytes: &[u8]| match Ros2::new(Some(switch), duty).hear(bytes, 0.0)[..] {
        [Heard::Switch { held, .. }] => Some(held),
        _ => None,
    };
    // Signal strength, two bytes to align, three channels.
    let channels = message(RosTopic::Channels, &[99, 0, 0, 3, 0, 0, 0, 0xd0, 7, 0xe8, 3, 0xd0, 7]);
    assert_eq!([1, 2, 3, 4].map(|c| held(Switch::Channel(c), &channels)), [true, false, true, false].map(Some));
    // No axes and two buttons, of which the second is down.
    let buttons = message(RosTopic::Joystick, &[0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!([0, 1, 2].map(|b| held(Switch::Button(b), &buttons)), [false, true, false].map(Some));
    let mode = |armed: u8, name: &[u8]| {
        let padded = [1, armed, 0, 0, 0, 0, 0, name.len() as u8, 0, 0, 0];
        message(RosTopic::Mode, &[&padded, name].concat())
    };
    assert_eq!(held(Switch::Offboard, &mode(1, b"OFFBOARD\0")), Some(true));
    assert_eq!(held(Switch::Offboard, &mode(0, b"OFFBOARD\0")), Some(false));
    assert_eq!(held(Switch::Offboard, &mode(1, b"ALTCTL\0")), Some(false));
    assert_eq!(held(Switch::Offboard, &mode(1, b"OFFBOARD\0")[..30]), None);
    assert_eq!(held(Switch::Channel(1), &mode(1, b"OFFBOARD\0")), None);
    // Sixteen thousand channels are none.
    assert_eq!(held(Switch::Channel(1), &message(RosTopic::Channels, &[99, 0, 0, 0, 64, 0, 0])), None);
}
