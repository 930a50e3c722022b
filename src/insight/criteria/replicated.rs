//! Does it show again and again, or once?

use super::{UNRECORDED, criteria};

criteria! {
    "Is it replicated?";

    /// Stretches of flight that have to agree before an effect is named.
    AGREEING_STRETCHES = 15.0, Assumed(UNRECORDED);
    /// Standard deviations by which a stretch has to show an effect to count by itself, and against it to count as one
    /// less.
    STRETCH_DEVIATIONS = 2.0, Theory("one in forty by chance");
    /// Stretches that have to show a rarely flown effect by themselves.
    RARE_STRETCHES = 4.0, Theory("all four by chance: one in three million");
    /// Share of all that the flight tells of a rarely flown effect that they have to hold.
    RARE_SHARE = 0.7, Assumed("what is rarely flown is told where it is flown");
    /// Standard deviations that the size of a rarely flown effect has to be.
    RARE_DEVIATIONS = 6.0, Assumed("half as many again as of one that shows all the time");
    /// Share of all that the flight tells of an effect that stretches hold which show it by themselves, less those that
    /// contradict, from which it needs no sure size beside what is only suspected.
    UNANIMOUS_SHARE = 0.9,
        Assumed("two hovers near the ground, both ten deviations, whose sizes differ twofold by the height's error");
    /// Visits of the ground of which nearly all have to show an effect of it to be evident without a sure size.
    GROUND_VISITS = 2.0, Assumed("the height's error of one visit says nothing of the next");
    /// Stretches between two visits.
    VISITS_APART = 5.0, Assumed("an estimator's memory is shorter than 10 s");
    /// Agreeing stretches on the first half period of an oscillation.
    OSCILLATION_AWAY = 10.0, Assumed(UNRECORDED);
    /// Agreeing stretches on the second.
    OSCILLATION_BACK = 6.0, Assumed(UNRECORDED);
    /// Share of the first that the second has to have.
    OSCILLATION_LASTS = 0.25, Theory("a damping ratio of 0.4 or less");
}
