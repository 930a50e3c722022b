//! Has the vehicle changed between two sets of flights?

use super::criteria;

criteria! {
    "Has it changed?";

    /// Chance of a difference of such a size, times the number of causes that were tried, up to which it is evident.
CHANGED_CHANCE = 5e-3, Theory("a false alarm in two hundred comparisons, were the stretches of time independent");
    /// Standard deviations from which one number of a difference is asked whether it pays on unseen flight.
    KNOWN_DEVIATIONS = 2.0, Theory("one in forty by chance");
    /// Share of the squared standard deviations of a difference that such numbers have to hold.
    KNOWN_SHARE = 0.5, Assumed("a lift forwards and one across: 36 deviations together, 2 and 1 each by itself");
    /// Standard deviations between flights of one set that a difference of the sets has to be.
    BETWEEN_DEVIATIONS = 3.0, Assumed("two or three flights tell their spread badly");
    /// Share of a difference that every third of the time has to show.
    LASTING_SHARE = 0.3, Assumed("a third that holds a tenth of what is known errs by as much");
    /// Share of what is known of a difference from which a third of the time is asked.
    LASTING_KNOWN = 0.1, Assumed("less is chance");
    /// Change of the thrust over mass that matters, as a share.
    CHANGED_THRUST = 0.025, Assumed("thrust by square of rotor speed differed by 2 % between flights of one vehicle");
    /// Of the drag along any axis.
    CHANGED_DRAG = 0.15, Assumed("half as much again as a move against the base that matters");
    /// Of a time constant.
    CHANGED_TIME_CONSTANT = 0.08, Assumed("half as much again as a move against the base that matters");
    /// Of a full-stick rate.
    CHANGED_RATE = 0.015, Assumed("that of a move against the base that matters");
    /// Of the discharge.
    CHANGED_DISCHARGE = 0.2, Assumed("that of a move against the base that matters");
    /// What a changed effect does after a second, m/s.
    CHANGED_IMPACT = 0.02, Assumed("of eight pairs, changes that were found did 0.8 and more, a false one 0.017");
    /// Change of another error of a sensor that matters, in small typical sizes.
    CHANGED_SENSOR = 1.5, Assumed("of 146 pairs without a change three were given one, of 0.8 and 0.9");
    /// Change of a sensor's constant error that matters, in small typical sizes.
    CHANGED_BIAS = 4.0, Assumed("it is another after every switching on");
    /// Change of a rate loop's gains, by motor outputs, that matters.
    CHANGED_GAIN = 0.25, Assumed("other causes moved what is read of them by up to a quarter, in 100 pairs");
    /// Error of such a gain beside its spread over the time, as a share.
    GAIN_ERROR = 0.055, Assumed("where no gain changed, 276 axes then differ by one standard deviation");
    /// Standard deviations that each changes by, at least.
    GAIN_DEVIATIONS = 1.0, Assumed("an axis that tells nothing has no part in it");
    /// Standard deviations that the gains of roll and pitch change by together, at least.
    GAINS_DEVIATIONS = 5.0, Assumed("of 291 pairs with other changes or none, one share of both had 4.3");
    /// Standard deviations up to which they are one share.
    GAINS_APART = 2.0, Assumed("two that had more than 5.5 deviations together were 2.7 and 5.2 apart");
    /// Share of the turns that motor outputs have to explain.
    GAIN_TURNED = 0.9, Assumed("0.97 of most flights, less where a gap or a hit is among them");
    /// Share of those outputs that errors and turns have to explain.
    GAIN_ANSWERED = 0.94, Assumed("0.98 of most flights");
    /// What the outputs turn has to be the same for a gain to be compared, as a share.
    SAME_AUTHORITY = 0.15, Assumed("within 10 % where it was");
    /// The lag of the motors.
    SAME_LAG = 0.2, Assumed("within a step of 14 % where it was");
    /// The delay of the commands, s.
    SAME_LOOP_DELAY_S = 0.005, Assumed("a filter of 4 ms on the sticks reads as gains of 60 %");
    /// Change of what motor outputs turn that matters, as a share, beyond what the voltage may have done.
    CHANGED_AUTHORITY = 0.3, Assumed("a load of 30 % does less; 147 pairs without another: up to 17 %");
    /// Its error beside the spread over the time, as a share.
    AUTHORITY_ERROR = 0.04, Assumed("pairs without another authority differ by 5 %");
    /// Share of the turns about yaw that motor outputs have to explain.
    YAW_TURNED = 0.6, Assumed("0.5 to 0.97 of the flights of such pairs, all within 7 % of their authority");
    /// Change of the lag that motor outputs turn with that matters.
    CHANGED_LAG = 0.25, Assumed("two steps of 14 % about both axes: of 197 pairs none without another");
    /// Error of such a lag, as a share.
    LAG_ERROR = 0.07, Assumed("half a step");
    /// By how much an odometry is earlier or later in another flight, whatever the IMU's clock does, s.
    SAME_ODOMETRY_S = 3e-3, Assumed("up to 2.3 ms between flights of one vehicle");
    /// The same, as a share of the delay that it is held against.
    SAME_ODOMETRY_SHARE = 0.1, Assumed("both are known to less");
    /// Share of what clocks drift apart by over a flight that an uneven one delays signals by, at most.
    UNEVEN_CLOCK = 0.1, Theory("one that grows from nothing leaves its line by a twelfth to a sixth");
    /// Share of the best gain from which the plainest of those that are tied is preferred.
    PLAIN_SHARE = 0.9, Assumed("slower gains did 0.95 of what a response that slows with the voltage did");
    /// Share of a whole's largest part up to which another part did not change.
    PART_SHARE = 0.4, Assumed("a late throttle: rates by -0.2 of it; a late link moves all by one size");
    /// Squared standard deviations over stretches of time from which a difference is worth a fit.
    CHANGED_EVIDENCE = 4.5, Assumed("that of an effect; more would ask for more stretches than some causes show in");
    /// Differences that are found at most.
    MOST_CHANGES = 5.0, Assumed("more is another vehicle");
    /// Differences that are tried at most, those that do not hold included.
    MOST_TRIED = 10.0, Assumed("what does not hold takes no place of what does");
}
