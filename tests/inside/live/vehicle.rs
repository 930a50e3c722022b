//! A simulated vehicle on a link, whatever it speaks.

use super::tongue::{Told, Tongue};
use racer::flight::live::answer::Answer;
use racer::flight::live::phase::Phase;
use racer::flight::live::{Live, Mission};
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Craft, Factors, State};
use racer::race::onboard::{AT_START, Estimate, Surroundings};

/// The nominal vehicle on the pad.
pub struct Peer {
    craft: Craft<f32>,
    full: [f64; 3],
    pub now_s: f64,
}

impl Peer {
    pub fn new(mission: &Mission) -> Self {
        let start = mission.track.start;
        let (sin, cos) = (0.5 * start.heading_rad()).sin_cos();
        let attitude = [cos, 0.0, 0.0, sin];
        let state =
            State::new(start.position_m, [0.0; 3], attitude, AT_START.map(f64::from), mission.vehicle.battery.full_v);
        let craft = Craft::new(&mission.vehicle, &Factors::NOMINAL, CONTROL_S, state).map(|x| x as f32);
        Self { craft, full: mission.vehicle.max_rates_rad_s(), now_s: 0.0 }
    }

    pub fn told(&self, switch: bool) -> Told {
        let State { position, velocity, attitude, .. } = self.craft.state;
        let (body_rates, voltage) = (self.craft.body_rates(), self.craft.terminal_voltage());
        let estimate = Estimate { position, velocity, attitude, body_rates, voltage };
        // Its clock began elsewhere.
        Told { time_us: 77_000_000 + (self.now_s * 1e6).round() as u64, estimate, switch }
    }

    /// 10 ms under these body rates (rad/s) and this throttle. Without any it stays where it is.
    pub fn fly(&mut self, obeyed: Option<([f32; 3], f32)>) {
        if let Some((rates, throttle)) = obeyed {
            let [x, y, z] = std::array::from_fn(|i| rates[i] / self.full[i] as f32);
            self.craft.step([x, y, z, 2.0 * throttle - 1.0]);
        }
        self.now_s += CONTROL_S;
    }
}

/// What the link carries of one period, and whether the user presses the key.
pub enum Sent {
    State(Told),
    /// The last bytes once more.
    Again,
    /// A state whose bytes were damaged on the way.
    Damaged(Told),
    Bytes(Vec<u8>),
    Key,
}

/// What the link does to the state of a period, counted from the switch.
pub type Fault<'a> = &'a dyn Fn(usize, Told) -> Vec<Sent>;

/// Periods at rest before the switch is held.
pub const REST: usize = 5;

/// Flies for so many periods after the switch is held, and gives the flight and its last answer.
pub fn flown<'a>(
    mission: &'a Mission,
    around: &'a Surroundings,
    periods: usize,
    mut tongue: Tongue,
    fault: Fault,
) -> (Live<'a>, Answer, Vec<Phase>) {
    let mut live = Live::new(mission, around);
    let mut peer = Peer::new(mission);
    let (mut phases, mut last) = (Vec::new(), Vec::new());
    let mut answer = live.tick(0.0, false);
    for period in 0..periods + REST {
        let told = peer.told(period >= REST);
        let sent = match period.checked_sub(REST) {
            Some(flying) => fault(flying, told),
            None => vec![Sent::State(told)],
        };
        let mut key = false;
        for sent in sent {
            match sent {
                Sent::State(told) => last = tongue.encode(&told),
                Sent::Again => {}
                Sent::Damaged(told) => last = tongue.damaged(&told),
                Sent::Bytes(bytes) => last = bytes,
                Sent::Key => {
                    key = true;
                    continue;
                }
            }
            let at_s = peer.now_s + 0.002;
            tongue.source.hear(&last, at_s).into_iter().for_each(|heard| live.receive(heard, at_s));
        }
        answer = live.tick(peer.now_s + 0.004, key);
        if phases.last() != Some(&answer.phase) {
            phases.push(answer.phase);
        }
        let said = tongue.say(&answer, peer.now_s + 0.004);
        let obeyed = tongue.obeyed(&said);
        assert_eq!(obeyed.is_some(), answer.setpoint.is_some(), "{answer:?}");
        peer.fly(obeyed);
    }
    (live, answer, phases)
}
