//! The manoeuvres in words, for a person with sticks.

use super::Manoeuvre;

impl Manoeuvre {
    /// What a person flies.
    pub fn words(self) -> &'static str {
        match self {
            Manoeuvre::RollSteps => "over the spot, two seconds of sharp random roll stick, level in the mean",
            Manoeuvre::PitchSteps => "over the spot, two seconds of sharp random pitch stick, level in the mean",
            Manoeuvre::YawSteps => "over the spot, two seconds of sharp random yaw stick",
            Manoeuvre::RateSteps => "over the spot, two seconds of sharp random roll, pitch and yaw stick at once",
            Manoeuvre::RollDoublets => "roll stick to one side and back to the other, slow, faster, and full",
            Manoeuvre::PitchDoublets => "pitch stick forward and back, slow, faster, and full",
            Manoeuvre::YawDoublets => "yaw stick to one side and back to the other, slow, faster, and full",
            Manoeuvre::RollFlip => "a flip about roll at full stick, throttle held below hover",
            Manoeuvre::PitchFlip => "a flip about pitch at full stick, throttle held below hover",
            Manoeuvre::YawSpin => "a second of fast yaw to one side, and a second to the other",
            Manoeuvre::ThrottleSteps => "three seconds of sharp random throttle, at hover in the mean",
            Manoeuvre::Punch => "full throttle from a hover for half a second, then closed for a moment",
            Manoeuvre::Chop => "throttle closed for a second high up, then full for a moment",
            Manoeuvre::RampUp => "throttle from closed to full, evenly within one to two seconds",
            Manoeuvre::RampDown => "throttle from full to closed, evenly within one to two seconds",
            Manoeuvre::Forward => "a fast level pass nose first, three seconds",
            Manoeuvre::Backward => "a fast level pass tail first, three seconds",
            Manoeuvre::Left => "a fast level pass with the left side first, three seconds",
            Manoeuvre::Right => "a fast level pass with the right side first, three seconds",
            Manoeuvre::Climb => "a fast climb, nearly straight up, four seconds",
            Manoeuvre::Descent => "a fast descent under power, nearly straight down, four seconds",
            Manoeuvre::Dive => "a fast slanted descent, four seconds",
            Manoeuvre::Circle => "a fast level circle with the nose along it",
            Manoeuvre::PunchTurns => "full throttle for a second while the yaw stick goes from side to side",
            Manoeuvre::LowHover => "five seconds of hover a hand above the ground",
        }
    }
}
