//! Is what was found enough, or is structure left?

use super::criteria;

/// What these are calibrated with: flights with causes outside the catalogue, and measured ones.
const OUTSIDE: &str = "cargo bench --bench hidden_effects -- --tier outside --n 100, and racer diagnose on the measured flights of RESULTS.md";

criteria! {
    "Is it complete?";

    /// Structure beside the root mean square of the residual that is called unexplained.
    LEFT_OF_NOISE = 0.15, Calibrated(OUTSIDE);
    /// Structure beside what the findings explain of the same channel that is called unexplained.
    LEFT_OF_EXPLAINED = 0.2, Calibrated(OUTSIDE);
    /// Structure that lines up with a signal counts from this share of those sizes on.
    LINED_UP_SHARE = 0.37, Calibrated(OUTSIDE);
    /// What a finding explains has to be so many times the structure that is left.
    ADEQUATE_RATIO = 1.5, Calibrated(OUTSIDE);
    /// What has a memory, where it is unexplained, may be so many times what a finding explains.
    MEMORY_RATIO = 3.0, Calibrated("racer diagnose on the measured flights of RESULTS.md, whose residuals are never white");
    /// Share of what is unexplained that goes with time from which on a finding is not the same early and late.
    CHANGING_SHARE = 0.2, Calibrated(OUTSIDE);
    /// What explains less than this share of what the largest finding of its channel does is small beside it.
    SMALL_BESIDE = 0.05, Calibrated("cargo bench --bench hidden_effects -- --tier clutter --n 100");
    /// Share of a channel besides its own from which on a finding is about it.
    ABOUT_SHARE = 0.05, Assumed("below, other causes explain more of it");
    /// Share of the horizontal residual that belongs to places in the world from which it is told.
    PLACE_SHARE = 0.05, Calibrated(OUTSIDE);
    /// Rows that a place has to have been seen in at other times.
    PLACE_ROWS = 100.0, Theory("a standard error of the mean of a tenth of the residual");
    /// Share of the variance that has to go with a signal to name it.
    VARIANCE_SHARE = 0.02, Assumed("below, chance among 22 signals explains as much");
}
