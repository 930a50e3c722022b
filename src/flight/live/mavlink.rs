//! MAVLink 2: states from a flight controller's own estimate, body rates and thrust back, as a computer on board sends
//! them to PX4.

pub mod frame;
pub mod message;
mod state;

use super::answer::Answer;
use super::duty::Duty;
use super::heard::Heard;
use super::phase::{Phase, Reason};
use super::protocol::Protocol;
use super::switch::Switch;
use frame::{Frames, MavFrame, Scanned, frame};
use message::{HEARTBEAT, Payload};
use state::Parts;

/// racer's component: the onboard computer of the vehicle's system.
const COMPONENT: u8 = 191;
/// How often it says that it is there, and asks for what is missing, s.
const BEAT_S: f64 = 1.0;
/// What is asked of the flight controller, and how often, us: states faster than they are needed, to be young.
const ASKED: [(u32, u32); 4] = [
    (message::ODOMETRY, 5_000),
    (message::RC_CHANNELS, 20_000),
    (message::MANUAL_CONTROL, 20_000),
    (message::BATTERY_STATUS, 500_000),
];

/// One vehicle on a MAVLink link.
#[derive(Debug)]
pub struct Mavlink {
    frames: Frames,
    states: Parts,
    switch: Option<Switch>,
    duty: Duty,
    /// System and component of the flight controller: the first autopilot that was heard.
    vehicle: Option<[u8; 2]>,
    /// Of the vehicle's last frame.
    heard: Option<u8>,
    /// Of the next frame to send.
    sequence: u8,
    beat_s: Option<f64>,
    told: Option<(Phase, Option<Reason>)>,
}

impl Mavlink {
    /// Before the first byte. `switch` is what to take for the dead man's, if it is to come over this link.
    pub fn new(switch: Option<Switch>, duty: Duty) -> Self {
        Self {
            frames: Frames::default(),
            states: Parts::default(),
            switch,
            duty,
            vehicle: None,
            heard: None,
            sequence: 0,
            beat_s: None,
            told: None,
        }
    }

    /// Counts a frame of the vehicle: how many were lost before it.
    fn lost(&mut self, sequence: u8) -> Option<Heard> {
        let ahead = self.heard.map_or(1, |last| sequence.wrapping_sub(last));
        // Half the way round and more is a frame that came twice or late.
        if ahead == 0 || ahead > 128 {
            return None;
        }
        self.heard = Some(sequence);
        (ahead > 1).then(|| Heard::Lost(u64::from(ahead) - 1))
    }

    fn known(&mut self, frame: &MavFrame, out: &mut Vec<Heard>) {
        let fields = Payload(&frame.payload);
        if frame.id == HEARTBEAT && self.vehicle.is_none() && is_autopilot(fields) {
            self.vehicle = Some(frame.sender);
        }
        if self.vehicle != Some(frame.sender) {
            return;
        }
        out.extend(self.lost(frame.sequence));
        out.extend(match (frame.id, self.switch) {
            (HEARTBEAT, Some(switch)) => switch.of_mode(is_offboard(fields)),
            (message::RC_CHANNELS, Some(switch)) => {
                let channels: [u16; 18] = std::array::from_fn(|i| fields.u16(4 + 2 * i));
                switch.of_channels(&channels)
            }
            (message::MANUAL_CONTROL, Some(switch)) => switch.of_buttons(fields.u16(8)),
            (id, _) => self.states.hear(id, fields),
        });
    }

    fn send(&mut self, out: &mut Vec<u8>, id: u32, payload: &[u8]) {
        let system = self.vehicle.map_or(1, |[system, _]| system);
        out.extend(frame(self.sequence, [system, COMPONENT], id, payload));
        self.sequence = self.sequence.wrapping_add(1);
    }

    /// What is sent once a second.
    fn beat(&mut self, out: &mut Vec<u8>, phase: Phase) {
        self.send(out, HEARTBEAT, &message::heartbeat());
        if let Some(vehicle) = self.vehicle.filter(|_| self.duty.source && phase == Phase::Waiting) {
            for (id, period_us) in ASKED {
                self.send(out, message::COMMAND_LONG, &message::set_message_interval(vehicle, id, period_us));
            }
        }
    }
}

impl Protocol for Mavlink {
    fn hear(&mut self, bytes: &[u8], _: f64) -> Vec<Heard> {
        let mut out = Vec::new();
        for found in self.frames.hear(bytes) {
            match found {
                Scanned::Foreign => out.push(Heard::Foreign),
                Scanned::Other(sequence, sender) if self.vehicle == Some(sender) => out.extend(self.lost(sequence)),
                Scanned::Other(..) => {}
                Scanned::Known(frame) => self.known(&frame, &mut out),
            }
        }
        out
    }

    fn say(&mut self, answer: &Answer, now_s: f64) -> Vec<u8> {
        let mut out = Vec::new();
        if self.beat_s.is_none_or(|last_s| now_s - last_s >= BEAT_S) {
            self.beat_s = Some(now_s);
            self.beat(&mut out, answer.phase);
        }
        let now = (answer.phase, answer.reason);
        if self.told != Some(now) {
            self.told = Some(now);
            let reason = answer.reason.map_or(String::new(), |reason| format!(": {}", reason.text()));
            self.send(&mut out, message::STATUSTEXT, &message::statustext(&format!("racer {}{reason}", now.0.name())));
        }
        // A flight controller takes the mode for setpoints only from whoever sends some: on the pad, none to fly by.
        let rates_thrust = match (answer.setpoint, answer.phase) {
            (Some(s), _) => Some(([s.body_rates[0], -s.body_rates[1], -s.body_rates[2]], s.throttle)),
            (None, Phase::Ready) => Some(([0.0; 3], 0.0)),
            _ => None,
        };
        if let (Some((rates, thrust)), Some(vehicle), true) = (rates_thrust, self.vehicle, self.duty.sink) {
            let target = message::set_attitude_target((now_s * 1e3) as u32, vehicle, rates, thrust);
            self.send(&mut out, message::SET_ATTITUDE_TARGET, &target);
        }
        out
    }
}

fn is_autopilot(heartbeat: Payload) -> bool {
    const NO_AUTOPILOT: u8 = 8;
    heartbeat.u8(5) != NO_AUTOPILOT
}

/// Armed, and in PX4's main mode 6.
fn is_offboard(heartbeat: Payload) -> bool {
    const ARMED: u8 = 128;
    const OFFBOARD: u32 = 6;
    heartbeat.u8(6) & ARMED != 0 && heartbeat.u32(0) >> 16 & 0xff == OFFBOARD
}
