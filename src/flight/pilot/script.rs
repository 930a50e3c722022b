//! What a manoeuvre does from moment to moment.

mod course;
mod low;
mod rates;
mod sequenced;
mod throttle;

use super::PilotLimits;
use super::cascade::Demand;
use super::view::View;
use crate::base::rng::Sequence;
pub use course::VelocityLeg;
pub use low::LowHover;
pub use rates::{Flip, RateSteps};
pub use sequenced::{Segment, Sequenced};
use std::fmt::Debug;
pub use throttle::{PunchTurns, ThrottleSteps};

/// A moment of a manoeuvre.
pub struct Now<'a> {
    /// Since the manoeuvre began, s.
    pub time: f64,
    /// Since the last command, s.
    pub dt: f64,
    pub view: &'a View,
    pub limits: &'a PilotLimits,
}

/// A manoeuvre.
pub trait Script: Debug + Send {
    /// What to fly now; `None` where it is over.
    fn demand(&mut self, now: &Now, rng: &mut Sequence) -> Option<Demand>;
}
