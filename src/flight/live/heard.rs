//! What arrives over a link, whatever protocol it came by.

use crate::race::onboard::Estimate;

/// One thing that arrived.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heard {
    /// Where the vehicle is and how it moves; its voltage is NaN where that is told apart.
    State(Sight),
    /// At the battery's terminals, V.
    Voltage(f32),
    /// Whether the dead man's switch is held, and for how long that is to be believed, s.
    Switch { held: bool, for_s: f64 },
    /// So many messages were sent and did not arrive.
    Lost(u64),
    /// Something that is none of the protocol's messages, or a damaged one.
    Foreign,
}

/// A state as it was sent, in frames and units of racer. Its numbers may be anything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// By the sender's clock.
    pub time_us: u64,
    pub estimate: Estimate,
}
