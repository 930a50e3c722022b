//! Who has the vehicle: a machine of four phases.
//!
//! waiting <-> ready -> flying -> ended. Nothing leads out of `ended`, and nothing but the dead man's switch, released
//! once and then held, leads into `flying`.

/// Where a flight is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Something that a flight needs is missing.
    #[default]
    Waiting,
    /// It needs only the switch.
    Ready,
    /// The policy has the vehicle.
    Flying,
    /// It has been handed back, for good.
    Ended,
}

impl Phase {
    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Phase::Waiting => "waiting",
            Phase::Ready => "ready",
            Phase::Flying => "flying",
            Phase::Ended => "ended",
        }
    }
}

/// Why it is not ready, or why it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    NoState,
    Stale,
    NotAtStart,
    NotAtRest,
    NotLevel,
    LowBattery,
    SwitchHeld,
    SwitchReleased,
    Fence,
    Jump,
    OutsideRange,
    MissedGate,
    Key,
    LapsDone,
    NoVoltage,
    LinkLost,
}

impl Reason {
    const ALL: [(Reason, &'static str); 16] = [
        (Reason::NoState, "no usable state has arrived"),
        (Reason::Stale, "the newest state is too old"),
        (Reason::NotAtStart, "the vehicle is not on the start pad"),
        (Reason::NotAtRest, "the vehicle moves"),
        (Reason::NotLevel, "the vehicle is not level, or looks another way than the pad"),
        (Reason::LowBattery, "the battery is empty"),
        (Reason::SwitchHeld, "the dead man's switch has to be released once"),
        (Reason::SwitchReleased, "the dead man's switch was released"),
        (Reason::Fence, "the vehicle left the flight volume"),
        (Reason::Jump, "the estimate jumped"),
        (Reason::OutsideRange, "the policy saw what it was not trained for"),
        (Reason::MissedGate, "a gate was missed"),
        (Reason::Key, "the user asked for it"),
        (Reason::LapsDone, "the laps are flown"),
        (Reason::NoVoltage, "nothing tells the battery's voltage"),
        (Reason::LinkLost, "the link for setpoints broke"),
    ];

    /// In an answer's packet: its place in this list, from 1.
    pub fn code(self) -> u32 {
        Self::ALL.iter().position(|(reason, _)| *reason == self).map_or(0, |place| place as u32 + 1)
    }

    /// In words.
    pub fn text(self) -> &'static str {
        Self::ALL.iter().find(|(reason, _)| *reason == self).map_or("", |(_, text)| text)
    }
}

/// The phase, and why.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Machine {
    pub phase: Phase,
    pub reason: Option<Reason>,
    /// Whether the switch was seen released since all was well.
    released: bool,
    /// Periods from the switch to the flight, which motors take to arm and to spin up, and how many of them are over.
    lead: u32,
    led: u32,
}

impl Machine {
    /// Before the first period.
    pub fn new(lead: u32) -> Self {
        Self { lead, ..Self::default() }
    }

    /// Whether the motors may turn, where the switch is held or not.
    pub fn armed(&self, switch: bool) -> bool {
        self.phase == Phase::Flying || self.phase == Phase::Ready && switch
    }

    /// One period: what speaks against flying, whether the switch is held, whether the user asks for an end.
    pub fn advance(&mut self, against: Option<Reason>, switch: bool, key: bool) {
        // What speaks against a start is no reason to end a flight.
        let flying = against.filter(|reason| !STARTING.contains(reason));
        match self.phase {
            Phase::Ended => {}
            _ if key => self.end(Reason::Key),
            Phase::Flying if flying.is_some() => self.end(flying.unwrap_or(Reason::Stale)),
            Phase::Flying if !switch => self.end(Reason::SwitchReleased),
            Phase::Flying => {}
            Phase::Waiting | Phase::Ready if against.is_some() => {
                *self = Self { reason: against, ..Self::new(self.lead) };
            }
            Phase::Waiting if switch => self.reason = Some(Reason::SwitchHeld),
            Phase::Waiting => *self = Self { phase: Phase::Ready, released: true, ..Self::new(self.lead) },
            Phase::Ready if switch && self.released && self.led >= self.lead => self.phase = Phase::Flying,
            Phase::Ready => self.led = if switch { self.led + 1 } else { 0 },
        }
    }

    /// Hands the vehicle back.
    pub fn end(&mut self, reason: Reason) {
        if self.phase != Phase::Ended {
            (self.phase, self.reason) = (Phase::Ended, Some(reason));
        }
    }
}

/// What has to hold on the pad and not in flight.
const STARTING: [Reason; 3] = [Reason::NotAtStart, Reason::NotAtRest, Reason::NotLevel];

#[cfg(test)]
mod tests {
    use super::*;

    fn after(steps: &[(Option<Reason>, bool, bool)]) -> Machine {
        let mut machine = Machine::default();
        steps.iter().for_each(|&(against, switch, key)| machine.advance(against, switch, key));
        machine
    }

    #[test]
    fn only_a_switch_that_was_released_starts_a_flight() {
        let (fine, held) = ((None, false, false), (None, true, false));
        assert_eq!(after(&[held, held]).reason, Some(Reason::SwitchHeld));
        assert_eq!(after(&[fine]).phase, Phase::Ready);
        assert_eq!(after(&[fine, held]).phase, Phase::Flying);
        let away = (Some(Reason::NotAtStart), false, false);
        assert_eq!(after(&[fine, away]), Machine { reason: away.0, ..Machine::default() });
        assert_eq!(after(&[fine, away, held, held]).phase, Phase::Waiting);
    }

    #[test]
    fn motors_are_given_their_time_before_the_flight() {
        let mut machine = Machine::new(2);
        let mut step = |switch| {
            machine.advance(None, switch, false);
            (machine.phase, machine.armed(switch))
        };
        assert_eq!(step(false), (Phase::Ready, false));
        assert_eq!([step(true), step(false)], [(Phase::Ready, true), (Phase::Ready, false)]);
        assert_eq!(
            [step(true), step(true), step(true)],
            [(Phase::Ready, true), (Phase::Ready, true), (Phase::Flying, true)]
        );
        assert_eq!(step(false), (Phase::Ended, false));
    }

    #[test]
    fn a_flight_ends_once_and_for_the_first_reason() {
        let (fine, held) = ((None, false, false), (None, true, false));
        let moving = (Some(Reason::NotAtStart), true, false);
        assert_eq!(after(&[fine, held, moving]).phase, Phase::Flying);
        for (last, reason) in [
            ((Some(Reason::Stale), true, false), Reason::Stale),
            ((Some(Reason::Fence), true, false), Reason::Fence),
            (fine, Reason::SwitchReleased),
            ((None, true, true), Reason::Key),
        ] {
            let ended = after(&[fine, held, last, held, fine, held]);
            assert_eq!((ended.phase, ended.reason), (Phase::Ended, Some(reason)));
        }
        assert_eq!(after(&[fine, (None, false, true)]).reason, Some(Reason::Key));
        let codes: Vec<_> = Reason::ALL.iter().map(|(reason, _)| reason.code()).collect();
        assert_eq!(codes, (1..=16).collect::<Vec<_>>());
    }
}
