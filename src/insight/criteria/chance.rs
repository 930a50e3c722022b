//! Is it chance: lost commands, gusts?

use super::{UNRECORDED, criteria};

criteria! {
    "Is it chance?";

    /// A stick movement is looked at where its loss would show beyond so many standard deviations of the noise.
    MOVEMENT_DEVIATIONS = 12.0, Theory("half of a loss is told from a whole one by six standard deviations");
    /// The movement before may be so much of it.
    MOVEMENT_BEFORE = 0.25, Assumed("what the loss of the command before would leave reaches into this one");
    /// Share of a movement's error from which half of it is there.
    LOST_HALF = 0.3, Theory("halfway between what a kept and a half lost command leave, with some room for the lag");
    /// Share from which all of it is there.
    LOST_WHOLE = 0.7, Theory("halfway between what a half and a whole lost command leave, with some room for the lag");
    /// Share above which it is more than a loss.
    LOST_MOST = 1.4, Theory("as far above a whole one as the least");
    /// Standard deviations from which an answer that comes early is looked at.
    EARLY_DEVIATIONS = 4.0, Theory("one in 16 000 by chance");
    /// Share of a movement that it has to be.
    EARLY_SHARE = 0.4, Assumed(UNRECORDED);
    /// Lost commands that have to be seen.
    LOST_COMMANDS = 12.0, Assumed(UNRECORDED);
    /// So many times as many whole losses as half ones, for a loss is all or nothing.
    LOST_OVER_HALF = 2.0, Assumed(UNRECORDED);
    /// Most that a link loses which is flown on, as a share.
    LOST_SHARE_MOST = 0.3, Assumed("half as much again as the largest typical size; rotors at their limits had 0.39");
    /// So many times as many whole losses as early answers, for a link whose delay varies has both.
    LOST_OVER_EARLY = 2.0, Assumed(UNRECORDED);

    /// The weakest quarter of the flight has this share of the strongest, for the air is as restless early as late.
    GUST_LASTING = 0.1, Assumed(UNRECORDED);
    /// The weaker horizontal axis has this share of the stronger.
    GUST_BALANCED = 0.15, Assumed(UNRECORDED);
    /// Memory of gusts, s.
    GUST_MEMORY_S = 0.05, Theory("an eddy of a metre at 20 m/s passes in it");
    /// Memory from which gusts beside a wind are rather that wind, which turns or grows with height, s.
    GUST_MEMORY_MOST_S = 2.0, Assumed("three times that of stirred air in the third truth, half that of winds there");
    /// Share of them that points the same way in the world four seconds later, from which they are rather a wind.
    GUST_ONE_WAY = 0.33, Assumed("gusts of three seconds have 0.27, winds that turn in the third truth 0.38 and more");
    /// Gusts are so many times what the errors of the logged velocity look like in the forces.
    ESTIMATOR_RATIO = 2.0, Assumed("how the drag changes with the speed is known to a factor of two");
    /// Share of what the horizontal forces remember that has to be left beside what goes with the vehicle's own speed.
    GUST_OWN = 0.5, Assumed("two linear drags leave no gust of it, one by the root less than half");
    /// Structure beside the gusts that is more than they leave.
    GUST_STRUCTURE = 0.7, Assumed(UNRECORDED);
}
