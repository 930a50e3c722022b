//! What a link is for.

/// One of them, or both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duty {
    /// States come by it.
    pub source: bool,
    /// Setpoints go by it.
    pub sink: bool,
}
