//! Is what was found enough, or is structure left?

use super::{UNRECORDED, criteria};

criteria! {
    "Is it complete?";

    /// Structure beside the root mean square of the residual that is called unexplained.
    LEFT_OF_NOISE = 0.15, Assumed(UNRECORDED);
    /// Structure beside what the findings explain of the same channel that is called unexplained.
    LEFT_OF_EXPLAINED = 0.2, Assumed(UNRECORDED);
    /// Structure that lines up with a signal counts from this share of those sizes on.
    LINED_UP_SHARE = 0.37, Assumed(UNRECORDED);
    /// What a finding explains has to be so many times the structure that is left.
    ADEQUATE_RATIO = 1.5, Assumed(UNRECORDED);
    /// What has a memory, where it is unexplained, may be so many times what a finding explains.
    MEMORY_RATIO = 3.0, Assumed("residuals of measured flights are never white; what else was tried is not on record");
    /// Share of the root mean square of what is left of a force that is known before, from which on the forms of what
    /// was found are not the vehicle's.
    REMEMBERED = 0.5, Assumed("0.7 to 0.8 beside inflow by momentum theory, 0.3 and less where the forms are right");
    /// Share of what is unexplained that goes with time from which on a finding is not the same early and late.
    CHANGING_SHARE = 0.2, Assumed(UNRECORDED);
    /// What explains less than this share of what the largest finding of its channel does is small beside it.
    SMALL_BESIDE = 0.05, Assumed(UNRECORDED);
    /// Share of a channel besides its own from which on a finding is about it.
    ABOUT_SHARE = 0.05, Assumed("below, other causes explain more of it");
    /// Share of the horizontal residual that belongs to places in the world from which it is told.
    PLACE_SHARE = 0.05, Assumed(UNRECORDED);
    /// Rows that a place has to have been seen in at other times.
    PLACE_ROWS = 100.0, Theory("a standard error of the mean of a tenth of the residual");
    /// Share of the variance that has to go with a signal to name it.
    VARIANCE_SHARE = 0.02, Assumed("below, chance among so many signals may explain as much");
}
