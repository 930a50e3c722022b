//! Have the compact model's own numbers moved, and why? What must be true of a move to be told.

use super::{UNRECORDED, criteria};

criteria! {
    "Has the base moved?";

    /// Standard deviations that a move has to be.
    MOVED_DEVIATIONS = 4.0, Theory("one in 16 000 by chance");
    /// Move of a time constant that matters, as a share.
    MOVED_TIME_CONSTANT = 0.05, Assumed("randomisation covers less");
    /// Of a full-stick rate.
    MOVED_RATE = 0.015, Assumed("randomisation covers less");
    /// Of the thrust over mass.
    MOVED_THRUST = 0.02, Assumed("randomisation covers less");
    /// Of the drag.
    MOVED_DRAG = 0.1, Assumed("randomisation covers less");
    /// Of the discharge.
    MOVED_DISCHARGE = 0.2, Assumed("randomisation covers less");
    /// Of the voltage's part in the thrust.
    MOVED_VOLTAGE = 0.1, Assumed("randomisation covers less");
    /// Share of the voltage's part in the thrust that a controller has to make up for, about a full battery.
    COMPENSATED = 0.25, Assumed("a base vehicle from the first minute of a pack is off by 0.12 to 0.20 of it");
    /// Share of the whole move that an effect has to account for to be named as its cause.
    CAUSE_ACCOUNTS = 0.9, Assumed(UNRECORDED);
    /// The same with what a base vehicle is off by without a cause, where the effect is worth more than that.
    CAUSE_BESIDE = 0.75, Assumed("worn packs and hot magnets 0.78 to 0.93; the rest is the curve's form");
    /// Share of what such errors of the base leave that it has to account for then.
    CAUSE_NEEDED = 0.4, Assumed("worn packs and hot magnets 0.60 to 0.73, clean logs 0.08 to 0.17");
    /// So many times what the best leaves of the move is left by causes that are a tie with it.
    CAUSE_TIE = 2.0, Assumed(UNRECORDED);
    /// And so much of the move besides.
    CAUSE_TIE_SHARE = 0.003, Assumed(UNRECORDED);
}
