//! Is a planned flight long enough?

use super::criteria;

criteria! {
    "Is the planned flight enough?";

    /// So many times the standard deviations over stretches of time that tell a tie, or show that an effect is there,
    /// are planned for.
    PLANNED_MARGIN = 1.25, Assumed("the flight is flown by another hand, in other air, and the size is not known well");
    /// Longest flight that is planned, take-off and landing with it, s.
    LONGEST_PLAN_S = 300.0, Assumed("a pack, or a little more than one");
    /// Share of the standard deviations still wanted that a manoeuvre has to bring at least.
    WORTH_FLYING = 1e-3, Assumed("a thousand of them would be needed");
}
