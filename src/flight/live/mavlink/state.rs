//! Parts from messages: ODOMETRY, or LOCAL_POSITION_NED with ATTITUDE_QUATERNION where there is none.

use super::message::{self, Payload};
use crate::flight::live::heard::{Heard, Sight};
use crate::flight::mapping::frames::{Body, World, attitude};
use crate::model::attitude::{body_axes, in_world};
use crate::race::onboard::Estimate;

/// What MAVLink calls frames (`MAV_FRAME`).
const LOCAL_NED: u8 = 1;
const LOCAL_ENU: u8 = 4;
const BODY_NED: u8 = 8;
const BODY_FRD: u8 = 12;
const LOCAL_FRD: u8 = 20;
const LOCAL_FLU: u8 = 21;

/// What has arrived of a state that comes in parts.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Whether ODOMETRY comes: it has all, of one time.
    whole: bool,
    /// Times, ms, with position and velocity, and with attitude and body rates.
    place: Option<(u32, [f32; 6])>,
    turn: Option<(u32, [f32; 7])>,
    /// The older of both times, when there was a state last.
    last_ms: u32,
}

impl Parts {
    /// What message `id` tells.
    pub fn hear(&mut self, id: u32, fields: Payload) -> Option<Heard> {
        match id {
            message::ODOMETRY => {
                self.whole = true;
                Some(odometry(fields).map_or(Heard::Foreign, Heard::State))
            }
            message::LOCAL_POSITION_NED => {
                self.place = Some((fields.u32(0), fields.f32s(4)));
                self.parts()
            }
            message::ATTITUDE_QUATERNION => {
                self.turn = Some((fields.u32(0), fields.f32s(4)));
                self.parts()
            }
            message::BATTERY_STATUS => battery(fields).map(Heard::Voltage),
            message::SYS_STATUS => Some(fields.u16(14)).filter(known).map(|mv| Heard::Voltage(1e-3 * f32::from(mv))),
            _ => None,
        }
    }

    /// A state of both parts: as old as the older, and new only where both are.
    fn parts(&mut self) -> Option<Heard> {
        let ((place_ms, [x, y, z, u, v, w]), (turn_ms, [q0, q1, q2, q3, p, q, r])) = (self.place?, self.turn?);
        let time_ms = place_ms.min(turn_ms);
        if self.whole || time_ms == self.last_ms {
            return None;
        }
        self.last_ms = time_ms;
        let ned = Local { world: World::Ned, level: false };
        let estimate = Estimate {
            position: ned.vector([x, y, z]),
            velocity: ned.vector([u, v, w]),
            attitude: ned.attitude([q0, q1, q2, q3]),
            body_rates: [p, -q, -r],
            voltage: f32::NAN,
        };
        Some(Heard::State(Sight { time_us: u64::from(time_ms) * 1000, estimate }))
    }
}

/// A world frame of MAVLink.
#[derive(Clone, Copy)]
struct Local {
    world: World,
    /// Whether its axes are those of a body that stands level at its origin: x forward, not north.
    level: bool,
}

impl Local {
    fn of(frame: u8) -> Option<Self> {
        let (world, level) = match frame {
            LOCAL_NED => (World::Ned, false),
            LOCAL_ENU => (World::Enu, false),
            LOCAL_FRD => (World::Ned, true),
            LOCAL_FLU => (World::Enu, true),
            _ => return None,
        };
        Some(Self { world, level })
    }

    /// Along the axes of racer's world.
    fn vector(self, v: [f32; 3]) -> [f32; 3] {
        let v = v.map(f64::from);
        let turned = match (self.world, self.level) {
            (World::Ned, true) => Body::Frd.to_flu(v),
            (world, _) => world.to_enu(v),
        };
        turned.map(|x| x as f32)
    }

    /// Front-left-up to racer's world, from front-right-down to this one.
    fn attitude(self, q: [f32; 4]) -> [f32; 4] {
        let [w, x, y, z] = q.map(f64::from);
        let turned = match (self.world, self.level) {
            // Half a turn about x on both sides.
            (World::Ned, true) => [w, x, -y, -z],
            (world, _) => attitude([w, x, y, z], Body::Frd, world),
        };
        turned.map(|x| x as f32)
    }
}

/// The state in ODOMETRY; none in a frame that racer does not know, or where the estimator says that it has failed.
fn odometry(fields: Payload) -> Option<Sight> {
    const FAILED: u8 = 0xff;
    if fields.u8(232) == FAILED {
        return None;
    }
    let local = Local::of(fields.u8(228))?;
    let attitude = local.attitude(fields.f32s(20));
    let told: [f32; 3] = fields.f32s(36);
    let velocity = match fields.u8(229) {
        BODY_FRD | BODY_NED => {
            let axes = body_axes(attitude.map(f64::from));
            in_world(&axes, Body::Frd.to_flu(told.map(f64::from))).map(|x| x as f32)
        }
        frame => Local::of(frame)?.vector(told),
    };
    let [p, q, r] = fields.f32s(48);
    let (position, body_rates) = (local.vector(fields.f32s(8)), [p, -q, -r]);
    let estimate = Estimate { position, velocity, attitude, body_rates, voltage: f32::NAN };
    Some(Sight { time_us: fields.u64(0), estimate })
}

/// Neither of the values that say that there is none.
fn known(mv: &u16) -> bool {
    *mv != 0 && *mv != u16::MAX
}

/// The sum of the cells of the first battery, V.
fn battery(fields: Payload) -> Option<f32> {
    let cells = (0..10).map(|i| fields.u16(10 + 2 * i)).chain((0..4).map(|i| fields.u16(41 + 2 * i))).filter(known);
    let mv: f32 = cells.map(f32::from).sum();
    (fields.u8(32) == 0 && mv > 0.0).then_some(1e-3 * mv)
}
