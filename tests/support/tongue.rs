//! The languages that a simulated vehicle speaks: its states as bytes, and what it takes from bytes. Frames are turned
//! here by matrices, not as the program does.

mod topics;

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use racer::flight::live::answer::Answer;
use racer::flight::live::duty::Duty;
use racer::flight::live::heard::Sight;
use racer::flight::live::mavlink::Mavlink;
use racer::flight::live::mavlink::frame::{Frames, Scanned, frame};
use racer::flight::live::mavlink::message::{self, Payload};
use racer::flight::live::msp::Msp;
use racer::flight::live::packets::{self, Packets};
use racer::flight::live::protocol::Protocol;
use racer::flight::live::ros2::Ros2;
use racer::flight::live::switch::Switch;
use racer::race::onboard::Estimate;

/// What a vehicle says of itself, in racer's frames.
#[derive(Clone, Copy)]
pub struct Told {
    pub time_us: u64,
    pub estimate: Estimate,
    pub switch: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speech {
    Packets,
    /// ODOMETRY, and the mode as the switch.
    Odometry,
    /// LOCAL_POSITION_NED and ATTITUDE_QUATERNION, and a channel as the switch.
    Parts,
    /// racer's packets in, sticks out.
    Sticks,
    /// Topics of mavros, and its mode as the switch.
    Topics,
}

pub const ALL: [Speech; 5] = [Speech::Packets, Speech::Odometry, Speech::Parts, Speech::Sticks, Speech::Topics];

/// A language with what is remembered of what was said.
pub struct Tongue {
    pub speech: Speech,
    pub source: Box<dyn Protocol>,
    /// Where it is not the source that answers.
    sink: Option<Box<dyn Protocol>>,
    full_rate: [f64; 3],
    number: u32,
    /// What the sticks said last: not every frame has any.
    sticks: Option<([f32; 3], f32)>,
}

pub const VEHICLE: [u8; 2] = [1, 1];
const CHANNEL: usize = 8;

impl Tongue {
    pub fn new(speech: Speech, full_rate: [f64; 3]) -> Self {
        let both = Duty { source: true, sink: true };
        let source: Box<dyn Protocol> = match speech {
            Speech::Packets => Box::new(Packets::new(true, true)),
            Speech::Odometry => Box::new(Mavlink::new(Some(Switch::Offboard), both)),
            Speech::Parts => Box::new(Mavlink::new(Some(Switch::Channel(CHANNEL)), both)),
            Speech::Sticks => Box::new(Packets::new(true, false)),
            Speech::Topics => Box::new(Ros2::new(Some(Switch::Offboard), both)),
        };
        let sink = (speech == Speech::Sticks).then(|| Box::new(Msp::new(None, full_rate, None)) as Box<dyn Protocol>);
        Self { speech, source, sink, full_rate, number: 0, sticks: None }
    }

    /// A state as it is sent, in one piece or several.
    pub fn encode(&mut self, told: &Told) -> Vec<Vec<u8>> {
        let messages = match self.speech {
            Speech::Packets | Speech::Sticks => {
                self.number += 1;
                let sight = Sight { time_us: told.time_us, estimate: told.estimate };
                return vec![packets::state(self.number, &sight, told.switch)];
            }
            Speech::Topics => return topics::messages(told),
            Speech::Odometry => vec![
                (message::HEARTBEAT, heartbeat(told.switch)),
                (message::BATTERY_STATUS, battery_status(told.estimate.voltage)),
                (message::ODOMETRY, odometry(told)),
            ],
            Speech::Parts => {
                let (position, attitude) = parts(told);
                vec![
                    (message::HEARTBEAT, heartbeat(false)),
                    (message::RC_CHANNELS, rc_channels(if told.switch { 2000 } else { 1000 })),
                    (message::SYS_STATUS, sys_status(told.estimate.voltage)),
                    (message::LOCAL_POSITION_NED, position),
                    (message::ATTITUDE_QUATERNION, attitude),
                ]
            }
        };
        let mut out = Vec::new();
        for (id, payload) in messages {
            out.extend(frame(self.number as u8, VEHICLE, id, &payload));
            self.number += 1;
        }
        vec![out]
    }

    /// The same, damaged where the state stands.
    pub fn damaged(&mut self, told: &Told) -> Vec<Vec<u8>> {
        let mut pieces = self.encode(told);
        let bytes = pieces.last_mut().unwrap();
        match self.speech {
            Speech::Packets | Speech::Sticks => drop(bytes.pop()),
            Speech::Odometry | Speech::Parts => {
                let last = bytes.len() - 9;
                bytes[last] ^= 0x40;
            }
            Speech::Topics => bytes.truncate(bytes.len() / 2),
        }
        pieces
    }

    /// What is sent for an answer.
    pub fn say(&mut self, answer: &Answer, now_s: f64) -> Vec<u8> {
        let bytes = self.source.say(answer, now_s);
        match &mut self.sink {
            None => bytes,
            Some(sink) => {
                assert!(bytes.is_empty());
                sink.say(answer, now_s)
            }
        }
    }

    /// Body rates (front-left-up, rad/s) and throttle that a vehicle takes from such bytes; none of an idle setpoint.
    pub fn obeyed(&mut self, bytes: &[u8]) -> Option<([f32; 3], f32)> {
        match self.speech {
            Speech::Packets => {
                let float = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
                (bytes[20] == 1).then(|| ([float(24), float(28), float(32)], float(36)))
            }
            Speech::Topics => topics::target(bytes).filter(|target| *target != ([0.0; 3], 0.0)),
            Speech::Odometry | Speech::Parts => target(bytes).filter(|target| *target != ([0.0, -0.0, -0.0], 0.0)),
            Speech::Sticks => {
                let Some(sticks) = sticks(bytes) else { return self.sticks };
                let way = |i: usize| (f32::from(sticks[i]) - 1500.0) / 500.0;
                let full = self.full_rate.map(|x| x as f32);
                let rates = [way(0) * full[0], way(1) * full[1], -way(3) * full[2]];
                let flies = sticks[..4] != [1500, 1500, 1000, 1500];
                self.sticks = flies.then_some((rates, (f32::from(sticks[2]) - 1050.0) / 950.0));
                self.sticks
            }
        }
    }
}

fn target(bytes: &[u8]) -> Option<([f32; 3], f32)> {
    Frames::default().hear(bytes).iter().find_map(|scanned| match scanned {
        Scanned::Known(frame) if frame.id == message::SET_ATTITUDE_TARGET => {
            let payload = Payload(&frame.payload);
            assert_eq!((payload.u8(36), payload.u8(37), payload.u8(38)), (VEHICLE[0], VEHICLE[1], 128));
            let [p, q, r, thrust] = payload.f32s(20);
            Some(([p, -q, -r], thrust))
        }
        _ => None,
    })
}

fn sticks(bytes: &[u8]) -> Option<[u16; 16]> {
    let channels = bytes.strip_prefix(&[b'$', b'M', b'<', 32, 200])?;
    Some(std::array::from_fn(|i| u16::from_le_bytes([channels[2 * i], channels[2 * i + 1]])))
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// North, east, down from east, north, up.
fn world() -> Matrix3<f64> {
    Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0)
}

pub fn ned(v: [f32; 3]) -> [f32; 3] {
    let turned = world() * Vector3::from(v.map(f64::from));
    [turned.x, turned.y, turned.z].map(|x| x as f32)
}

/// Front-right-down to north-east-down, from front-left-up to east-north-up.
pub fn attitude_ned(q: [f32; 4]) -> [f32; 4] {
    let [w, x, y, z] = q.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix();
    let body = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let turned = Rotation3::from_matrix_unchecked(world() * rotation.matrix() * body);
    let q = UnitQuaternion::from_rotation_matrix(&turned);
    [q.w, q.i, q.j, q.k].map(|x| x as f32)
}

/// Front-right-down from the world.
fn in_body(q: [f32; 4], v: [f32; 3]) -> [f32; 3] {
    let [w, x, y, z] = q.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let turned = rotation.inverse() * Vector3::from(v.map(f64::from));
    [turned.x as f32, -turned.y as f32, -turned.z as f32]
}

fn frd([p, q, r]: [f32; 3]) -> [f32; 3] {
    [p, -q, -r]
}

fn odometry(told: &Told) -> Vec<u8> {
    let e = &told.estimate;
    let mut out = told.time_us.to_le_bytes().to_vec();
    out.extend(floats(&ned(e.position)));
    out.extend(floats(&attitude_ned(e.attitude)));
    out.extend(floats(&in_body(e.attitude, e.velocity)));
    out.extend(floats(&frd(e.body_rates)));
    out.extend(floats(&[f32::NAN; 42]));
    // Local NED and body FRD; resets, kind of estimator, quality.
    out.extend([1, 12, 0, 4, 100]);
    out
}

fn parts(told: &Told) -> (Vec<u8>, Vec<u8>) {
    let (e, time) = (&told.estimate, ((told.time_us / 1000) as u32).to_le_bytes());
    let position = [time.to_vec(), floats(&ned(e.position)), floats(&ned(e.velocity))].concat();
    let attitude = [time.to_vec(), floats(&attitude_ned(e.attitude)), floats(&frd(e.body_rates))].concat();
    (position, attitude)
}

pub fn heartbeat(offboard: bool) -> Vec<u8> {
    let main_mode = if offboard { 6 } else { 1 };
    // Quadrotor, PX4, armed, active.
    vec![0, 0, main_mode, 0, 2, 12, 128 | 81, 4, 3]
}

fn rc_channels(us: u16) -> Vec<u8> {
    let mut out = 5u32.to_le_bytes().to_vec();
    (1..=18).for_each(|i| out.extend(if i == CHANNEL { us } else { 1500 }.to_le_bytes()));
    out.extend([18, 255]);
    out
}

fn sys_status(voltage: f32) -> Vec<u8> {
    let mut out = vec![0; 14];
    out.extend(((voltage * 1000.0) as u16).to_le_bytes());
    out
}

/// Six cells, as PX4 sends them.
fn battery_status(voltage: f32) -> Vec<u8> {
    let mut out = vec![0; 10];
    let cells = (0..10).map(|i| if i < 6 { (voltage * 1000.0 / 6.0) as u16 } else { u16::MAX });
    cells.for_each(|mv| out.extend(mv.to_le_bytes()));
    out.resize(36, 0);
    out
}
