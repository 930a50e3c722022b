//! The kinds of manoeuvres, by name.

/// A kind of manoeuvre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manoeuvre {
    RollSteps,
    PitchSteps,
    YawSteps,
    RateSteps,
    RollDoublets,
    PitchDoublets,
    YawDoublets,
    RollFlip,
    PitchFlip,
    YawSpin,
    ThrottleSteps,
    Punch,
    Chop,
    RampUp,
    RampDown,
    Forward,
    Backward,
    Left,
    Right,
    Climb,
    Descent,
    Dive,
    Circle,
    PunchTurns,
    LowHover,
}

impl Manoeuvre {
    /// All kinds in order of declaration.
    pub const ALL: [Manoeuvre; 25] = [
        Manoeuvre::RollSteps,
        Manoeuvre::PitchSteps,
        Manoeuvre::YawSteps,
        Manoeuvre::RateSteps,
        Manoeuvre::RollDoublets,
        Manoeuvre::PitchDoublets,
        Manoeuvre::YawDoublets,
        Manoeuvre::RollFlip,
        Manoeuvre::PitchFlip,
        Manoeuvre::YawSpin,
        Manoeuvre::ThrottleSteps,
        Manoeuvre::Punch,
        Manoeuvre::Chop,
        Manoeuvre::RampUp,
        Manoeuvre::RampDown,
        Manoeuvre::Forward,
        Manoeuvre::Backward,
        Manoeuvre::Left,
        Manoeuvre::Right,
        Manoeuvre::Climb,
        Manoeuvre::Descent,
        Manoeuvre::Dive,
        Manoeuvre::Circle,
        Manoeuvre::PunchTurns,
        Manoeuvre::LowHover,
    ];

    /// Its name, such as `roll-doublets`.
    pub fn name(self) -> &'static str {
        match self {
            Manoeuvre::RollSteps => "roll-steps",
            Manoeuvre::PitchSteps => "pitch-steps",
            Manoeuvre::YawSteps => "yaw-steps",
            Manoeuvre::RateSteps => "rate-steps",
            Manoeuvre::RollDoublets => "roll-doublets",
            Manoeuvre::PitchDoublets => "pitch-doublets",
            Manoeuvre::YawDoublets => "yaw-doublets",
            Manoeuvre::RollFlip => "roll-flip",
            Manoeuvre::PitchFlip => "pitch-flip",
            Manoeuvre::YawSpin => "yaw-spin",
            Manoeuvre::ThrottleSteps => "throttle-steps",
            Manoeuvre::Punch => "punch",
            Manoeuvre::Chop => "chop",
            Manoeuvre::RampUp => "ramp-up",
            Manoeuvre::RampDown => "ramp-down",
            Manoeuvre::Forward => "forward",
            Manoeuvre::Backward => "backward",
            Manoeuvre::Left => "left",
            Manoeuvre::Right => "right",
            Manoeuvre::Climb => "climb",
            Manoeuvre::Descent => "descent",
            Manoeuvre::Dive => "dive",
            Manoeuvre::Circle => "circle",
            Manoeuvre::PunchTurns => "punch-turns",
            Manoeuvre::LowHover => "low-hover",
        }
    }

    /// The kind of that name.
    pub fn named(name: &str) -> Option<Manoeuvre> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether it is flown in the first half of a round. Each half covers every axis, the throttle and the speeds, so
    /// that no part of a flight goes without.
    pub fn early(self) -> bool {
        matches!(
            self,
            Manoeuvre::RollSteps
                | Manoeuvre::YawSteps
                | Manoeuvre::PitchDoublets
                | Manoeuvre::RollFlip
                | Manoeuvre::ThrottleSteps
                | Manoeuvre::Chop
                | Manoeuvre::RampUp
                | Manoeuvre::Forward
                | Manoeuvre::Left
                | Manoeuvre::Climb
                | Manoeuvre::Dive
                | Manoeuvre::PunchTurns
        )
    }
}
