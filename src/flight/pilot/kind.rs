//! The kinds of manoeuvres, by name.

/// A kind of manoeuvre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
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

impl Kind {
    /// All kinds in order of declaration.
    pub const ALL: [Kind; 25] = [
        Kind::RollSteps,
        Kind::PitchSteps,
        Kind::YawSteps,
        Kind::RateSteps,
        Kind::RollDoublets,
        Kind::PitchDoublets,
        Kind::YawDoublets,
        Kind::RollFlip,
        Kind::PitchFlip,
        Kind::YawSpin,
        Kind::ThrottleSteps,
        Kind::Punch,
        Kind::Chop,
        Kind::RampUp,
        Kind::RampDown,
        Kind::Forward,
        Kind::Backward,
        Kind::Left,
        Kind::Right,
        Kind::Climb,
        Kind::Descent,
        Kind::Dive,
        Kind::Circle,
        Kind::PunchTurns,
        Kind::LowHover,
    ];

    /// Its name, such as `roll-doublets`.
    pub fn name(self) -> &'static str {
        match self {
            Kind::RollSteps => "roll-steps",
            Kind::PitchSteps => "pitch-steps",
            Kind::YawSteps => "yaw-steps",
            Kind::RateSteps => "rate-steps",
            Kind::RollDoublets => "roll-doublets",
            Kind::PitchDoublets => "pitch-doublets",
            Kind::YawDoublets => "yaw-doublets",
            Kind::RollFlip => "roll-flip",
            Kind::PitchFlip => "pitch-flip",
            Kind::YawSpin => "yaw-spin",
            Kind::ThrottleSteps => "throttle-steps",
            Kind::Punch => "punch",
            Kind::Chop => "chop",
            Kind::RampUp => "ramp-up",
            Kind::RampDown => "ramp-down",
            Kind::Forward => "forward",
            Kind::Backward => "backward",
            Kind::Left => "left",
            Kind::Right => "right",
            Kind::Climb => "climb",
            Kind::Descent => "descent",
            Kind::Dive => "dive",
            Kind::Circle => "circle",
            Kind::PunchTurns => "punch-turns",
            Kind::LowHover => "low-hover",
        }
    }

    /// The kind of that name.
    pub fn named(name: &str) -> Option<Kind> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Whether it is flown in the first half of a round. Each half covers every axis, the throttle and the speeds, so
    /// that no part of a flight goes without.
    pub fn early(self) -> bool {
        matches!(
            self,
            Kind::RollSteps
                | Kind::YawSteps
                | Kind::PitchDoublets
                | Kind::RollFlip
                | Kind::ThrottleSteps
                | Kind::Chop
                | Kind::RampUp
                | Kind::Forward
                | Kind::Left
                | Kind::Climb
                | Kind::Dive
                | Kind::PunchTurns
        )
    }
}
