//! Is a planned flight long enough?

use super::criteria;

criteria! {
    "Is the planned flight enough?";

    /// So many standard deviations over stretches of time are planned for beyond those that tell a tie, or show that an
    /// effect is there.
    PLANNED_MARGIN = 1.28, Theory("what a flight tells is off by one of them, so that nine of ten flights tell enough");
    /// Longest flight that is planned, take-off and landing with it, s.
    LONGEST_PLAN_S = 300.0, Assumed("a pack, or a little more than one");
    /// Share of the standard deviations still wanted that a manoeuvre has to bring at least.
    WORTH_FLYING = 1e-3, Assumed("a thousand of them would be needed");
}
