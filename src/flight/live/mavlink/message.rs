//! The messages that are needed, of MAVLink's `common` set: identifiers, and where their fields stand. Source:
//! mavlink.io/en/messages/common.html; `tests/inside/live/mavlink.rs` holds them against pymavlink.

pub const HEARTBEAT: u32 = 0;
pub const SYS_STATUS: u32 = 1;
pub const ATTITUDE_QUATERNION: u32 = 31;
pub const LOCAL_POSITION_NED: u32 = 32;
pub const RC_CHANNELS: u32 = 65;
pub const MANUAL_CONTROL: u32 = 69;
pub const RC_CHANNELS_OVERRIDE: u32 = 70;
pub const COMMAND_LONG: u32 = 76;
pub const SET_ATTITUDE_TARGET: u32 = 82;
pub const BATTERY_STATUS: u32 = 147;
pub const STATUSTEXT: u32 = 253;
pub const ODOMETRY: u32 = 331;

/// The number of a message's definition that goes into its checksum; none of a message that is not known.
pub fn extra(id: u32) -> Option<u8> {
    Some(match id {
        HEARTBEAT => 50,
        SYS_STATUS => 124,
        ATTITUDE_QUATERNION => 246,
        LOCAL_POSITION_NED => 185,
        RC_CHANNELS => 118,
        MANUAL_CONTROL => 243,
        RC_CHANNELS_OVERRIDE => 124,
        COMMAND_LONG => 152,
        SET_ATTITUDE_TARGET => 49,
        BATTERY_STATUS => 154,
        STATUSTEXT => 83,
        ODOMETRY => 91,
        _ => return None,
    })
}

/// Little-endian numbers of a payload, by their first byte.
#[derive(Clone, Copy, Debug)]
pub struct Payload<'a>(pub &'a [u8; 255]);

impl Payload<'_> {
    pub fn u8(self, at: usize) -> u8 {
        self.0[at]
    }

    pub fn u16(self, at: usize) -> u16 {
        u16::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    pub fn u32(self, at: usize) -> u32 {
        u32::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    pub fn u64(self, at: usize) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    pub fn f32s<const N: usize>(self, at: usize) -> [f32; N] {
        std::array::from_fn(|i| f32::from_bits(self.u32(at + 4 * i)))
    }
}

/// What racer is: a computer beside the flight controller, which is no autopilot.
pub fn heartbeat() -> Vec<u8> {
    const ONBOARD_CONTROLLER: u8 = 18;
    const NO_AUTOPILOT: u8 = 8;
    const ACTIVE: u8 = 4;
    const VERSION: u8 = 3;
    vec![0, 0, 0, 0, ONBOARD_CONTROLLER, NO_AUTOPILOT, 0, ACTIVE, VERSION]
}

/// Asks `target` (system, component) for message `id` every `period_us`.
pub fn set_message_interval(target: [u8; 2], id: u32, period_us: u32) -> Vec<u8> {
    const SET_MESSAGE_INTERVAL: u16 = 511;
    let mut out: Vec<u8> = [id as f32, period_us as f32].iter().flat_map(|x| x.to_le_bytes()).collect();
    out.resize(28, 0);
    out.extend(SET_MESSAGE_INTERVAL.to_le_bytes());
    out.extend([target[0], target[1], 0]);
    out
}

/// Body rates (front-right-down, rad/s) and thrust (0 to 1) for `target`; the attitude is to be ignored.
pub fn set_attitude_target(time_ms: u32, target: [u8; 2], rates: [f32; 3], thrust: f32) -> Vec<u8> {
    const IGNORE_ATTITUDE: u8 = 128;
    let [p, q, r] = rates;
    let mut out = time_ms.to_le_bytes().to_vec();
    [1.0, 0.0, 0.0, 0.0, p, q, r, thrust].iter().for_each(|x: &f32| out.extend(x.to_le_bytes()));
    out.extend([target[0], target[1], IGNORE_ATTITUDE]);
    out
}

/// Pulses (us) for `target` in place of its receiver's channels 1 to 8; the others stay its receiver's.
pub fn rc_channels_override(target: [u8; 2], pulses: [u16; 8]) -> Vec<u8> {
    [pulses.map(u16::to_le_bytes).concat(), target.to_vec()].concat()
}

/// A line for the pilot's ground station.
pub fn statustext(text: &str) -> Vec<u8> {
    const NOTICE: u8 = 5;
    const LENGTH: usize = 50;
    let mut out = [&[NOTICE], text.as_bytes()].concat();
    out.resize(1 + LENGTH, 0);
    out
}
