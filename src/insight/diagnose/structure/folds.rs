//! Parts of the time, each predicted from the others.

/// How many there are.
pub const FOLDS: u32 = 6;
/// Stretches of time to a fold's piece, so that each fold holds early and late flight.
const PIECE: u32 = 3;

/// The fold of a stretch of time.
pub fn fold(block: u32) -> u32 {
    block / PIECE % FOLDS
}
