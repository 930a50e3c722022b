//! The dead man's switch: where it is read, and how long it is believed.

use super::heard::Heard;
use crate::base::check::BadInput;

/// What the switch is on the vehicle's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// A channel of the radio control, from 1; held above [`HELD_US`].
    Channel(usize),
    /// A button of a joystick, from 0.
    Button(u32),
    /// Armed, and in the mode in which the flight controller takes setpoints.
    Offboard,
}

/// Length of the pulse above which a channel is held, us: 1000 to 2000 is the whole way.
const HELD_US: u16 = 1700;
/// How long a channel or a button is believed, s: five of the ten a second that telemetry sends at the least.
const CONTROL_S: f64 = 0.5;
/// How long a mode is believed, s: heartbeats come once a second, and one may be lost.
const MODE_S: f64 = 2.5;
/// Channels that any of the protocols has.
const CHANNELS: usize = 18;

impl Switch {
    /// `rc:CHANNEL`, `button:NUMBER` or `offboard`.
    pub fn parse(text: &str) -> Result<Self, BadInput> {
        let number = |prefix| text.strip_prefix(prefix).and_then(|n: &str| n.parse::<usize>().ok());
        match (text, number("rc:"), number("button:")) {
            ("offboard", ..) => Ok(Self::Offboard),
            (_, Some(channel @ 1..=CHANNELS), _) => Ok(Self::Channel(channel)),
            (_, _, Some(button @ 0..=15)) => Ok(Self::Button(button as u32)),
            _ => Err(BadInput::new(
                "--switch",
                text,
                "rc:CHANNEL (1 to 18), button:NUMBER (0 to 15), or offboard",
                "name what the pilot holds in the hand: docs/flying.md says which of them a link has",
            )),
        }
    }

    /// What these channels, us, say of it.
    pub fn of_channels(self, channels: &[u16]) -> Option<Heard> {
        let Self::Channel(channel) = self else { return None };
        // The largest number says that there is no such channel.
        let held = channels.get(channel - 1).is_some_and(|&us| us > HELD_US && us < u16::MAX);
        Some(Heard::Switch { held, for_s: CONTROL_S })
    }

    /// What these buttons, a bit each, say of it.
    pub fn of_buttons(self, buttons: u16) -> Option<Heard> {
        let Self::Button(button) = self else { return None };
        Some(Heard::Switch { held: buttons >> button & 1 == 1, for_s: CONTROL_S })
    }

    /// What the flight controller's mode says of it.
    pub fn of_mode(self, offboard: bool) -> Option<Heard> {
        (self == Self::Offboard).then_some(Heard::Switch { held: offboard, for_s: MODE_S })
    }
}
