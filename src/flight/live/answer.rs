//! What is sent back, whatever protocol it goes by.

use super::phase::{Phase, Reason};
use crate::race::onboard::Setpoint;

/// The answer of one control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    pub phase: Phase,
    /// Why it is not ready, or why it ended.
    pub reason: Option<Reason>,
    /// Whether the motors may turn: it flies, or is about to.
    pub armed: bool,
    /// Of the state that is answered, by its sender's clock.
    pub time_us: u64,
    /// None unless the policy flies.
    pub setpoint: Option<Setpoint>,
}
