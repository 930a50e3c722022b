//! What a rollout teaches, as the update reads it.

/// A batch in rows of 16 samples; features lie `[row][feature][16]`.
#[derive(Clone, Copy)]
pub struct Minibatch<'a, E> {
    /// `[rows][observations][16]`
    pub observations: &'a [E],
    /// `[rows][4][16]`
    pub z: &'a [E],
    /// `[rows][16]` each.
    pub log_prob: &'a [E],
    pub advantages: &'a [E],
    pub returns: &'a [E],
}
