//! A flight over a link that does to its states what a test asks for, in simulated time.

use crate::support::tongue::{Speech, Told, Tongue};
use crate::support::vehicle::Peer;
use racer::flight::live::answer::Answer;
use racer::flight::live::phase::Phase;
use racer::flight::live::{Live, Mission};
use racer::race::onboard::Surroundings;

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
                Sent::Bytes(bytes) => last = vec![bytes],
                Sent::Key => {
                    key = true;
                    continue;
                }
            }
            let at_s = peer.now_s + 0.002;
            for piece in &last {
                tongue.source.hear(piece, at_s).into_iter().for_each(|heard| live.receive(heard, at_s));
            }
        }
        answer = live.tick(peer.now_s + 0.004, key);
        if phases.last() != Some(&answer.phase) {
            phases.push(answer.phase);
        }
        let said = tongue.say(&answer, peer.now_s + 0.004);
        let obeyed = tongue.obeyed(&said);
        let sticks = tongue.speech == Speech::Sticks;
        assert!(obeyed.is_some() == answer.setpoint.is_some() || sticks, "{answer:?}");
        peer.fly(obeyed);
    }
    (live, answer, phases)
}
