//! Flights through the firmware: a policy's laps, and the pilot's manoeuvres.

use super::Rehearsal;
use super::sticks::Sticks;
use crate::base::error::Result;
use crate::flight::live::Live;
use crate::flight::live::heard::{Heard, Sight};
use crate::flight::live::phase::{Phase, Reason};
use crate::flight::pilot::{Pilot, Seen};
use crate::model::constants::CONTROL_S;
use crate::race::onboard::{Estimate, Setpoint};

/// Periods that the firmware has for closing its log after it was disarmed.
const AFTER: usize = 50;

/// The policy's flight from the pad to its end, with the onboard code of `racer pilot`. `key` says whether the user
/// asks for an end; `most_s` ends it, too.
pub fn by_policy(
    rehearsal: &mut Rehearsal,
    live: &mut Live,
    full_rate: [f64; 3],
    most_s: f64,
    key: &dyn Fn() -> bool,
) -> Result<()> {
    rehearsal.arm()?;
    let at_end = rehearsal.full_rates(full_rate);
    loop {
        let (now_s, actual) = (rehearsal.time_s(), rehearsal.actual());
        let estimate = Estimate {
            position: actual.position.map(|x| x as f32),
            velocity: actual.velocity.map(|x| x as f32),
            attitude: actual.attitude.map(|x| x as f32),
            body_rates: actual.body_rates.map(|x| x as f32),
            voltage: actual.voltage as f32,
        };
        // The switch is held from the moment that the policy is ready.
        let held = live.machine.phase != Phase::Waiting;
        live.receive(Heard::Switch { held, for_s: 1.0 }, now_s);
        live.receive(Heard::State(Sight { time_us: (1e6 * now_s) as u64, estimate }), now_s);
        let answer = live.tick(now_s, key() || now_s > most_s);
        if answer.phase == Phase::Ended {
            break;
        }
        if answer.phase == Phase::Waiting && now_s > 1.0 {
            live.machine.end(answer.reason.unwrap_or(Reason::NoState));
            break;
        }
        let sticks = answer.setpoint.map_or(IDLE, |setpoint| sticks(&setpoint, at_end));
        if let Some(Setpoint { body_rates: [p, q, r], throttle, .. }) = answer.setpoint {
            rehearsal.log.setpoint.push(now_s, [p, q, r, throttle].map(f64::from));
        }
        rehearsal.hold(&sticks)?;
    }
    disarm(rehearsal)
}

/// The pilot's flight from the ground to its landing, of at most `seconds`.
pub fn by_pilot(
    rehearsal: &mut Rehearsal,
    pilot: &mut Pilot,
    full_rate: [f64; 3],
    seconds: f64,
    key: &dyn Fn() -> bool,
) -> Result<()> {
    rehearsal.arm()?;
    let at_end = rehearsal.full_rates(full_rate);
    let mut landed_s = 0.0;
    while rehearsal.time_s() < seconds && landed_s < 1.0 && !key() {
        let (time_s, actual) = (rehearsal.time_s(), rehearsal.actual());
        let seen = Seen {
            time_s,
            position: actual.position,
            velocity: actual.velocity,
            attitude: actual.attitude,
            rates: actual.body_rates,
            voltage: actual.voltage,
        };
        let [roll, pitch, yaw, thrust] = pilot.command(&seen);
        let [x, y, z] = full_rate;
        let row = [roll * x, pitch * y, yaw * z, 0.5 + 0.5 * thrust];
        rehearsal.log.setpoint.push(time_s, row);
        let setpoint = Setpoint {
            body_rates: [row[0] as f32, row[1] as f32, row[2] as f32],
            throttle: row[3] as f32,
            thrust_n: 0.0,
            thrust_to_weight: 0.0,
        };
        rehearsal.hold(&sticks(&setpoint, at_end))?;
        landed_s = if pilot.landed() { landed_s + CONTROL_S } else { 0.0 };
    }
    disarm(rehearsal)
}

/// Armed, on the pad.
const IDLE: Sticks = Sticks { rates: [0.0; 3], throttle: None, armed: true };

/// The sticks of a setpoint, for a firmware whose full sticks ask for the rates `at_end` (rad/s).
fn sticks(setpoint: &Setpoint, at_end: [f64; 3]) -> Sticks {
    Sticks {
        rates: std::array::from_fn(|i| f64::from(setpoint.body_rates[i]) / at_end[i]),
        throttle: Some(f64::from(setpoint.throttle)),
        armed: true,
    }
}

/// What follows is no part of the log.
fn disarm(rehearsal: &mut Rehearsal) -> Result<()> {
    let log = rehearsal.log.clone();
    for _ in 0..AFTER {
        rehearsal.hold(&Sticks::default())?;
    }
    rehearsal.log = log;
    Ok(())
}
