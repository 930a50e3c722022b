//! Ranges in which the compact model's numbers are looked for: wider than any multirotor's, so that what ends there is
//! not told by the flight. Assumed.

/// Time constants of rates and thrust, s.
pub const TIME_CONSTANT_S: [f64; 2] = [5e-4, 0.3];

/// Body rate of a full stick, as a share of what it is taken for.
pub const RATE_GAIN: [f64; 2] = [0.2, 5.0];

/// Drag over mass along an axis, 1/m.
pub const DRAG_1_M: [f64; 2] = [0.0, 0.5];
