//! Was enough flown to tell?

use super::{UNRECORDED, criteria};

criteria! {
    "Was enough flown?";

    /// Usable flight for anything, s.
    LEAST_FLIGHT_S = 5.0, Assumed("tens of stretches that residuals are independent over");
    /// Spread of a rate setpoint (5 to 95 %) that tells a response, rad/s.
    RATE_SPREAD = 0.2, Assumed("ten times the noise of a gyro");
    /// Spread of the thrust command that tells a thrust curve, of 0 to 1.
    THRUST_SPREAD = 0.05, Assumed("a change of a tenth of the thrust at hover");
    /// Spread of the voltage that tells its part in the thrust, as a share of it.
    VOLTAGE_SPREAD = 0.015, Assumed("a change of thrust of 3 %");
    /// Speed (95 %) at which drag shows, m/s.
    DRAG_SPEED_M_S = 3.0, Assumed("drag of 0.02 1/m is 0.2 m/s2 there, twice an accelerometer's bias");
    /// Flight over which a discharge shows, s.
    DISCHARGE_S = 20.0, Assumed("the relaxation of a cell takes as long");

    /// Standard deviations that a size has to be, to be seen at all.
    SEEN_DEVIATIONS = 5.0, Assumed("about the root of the least gain of 30 for which an effect is added");
    /// Share of its information that an effect keeps beside the base; below, the base absorbs it.
    ABSORBED_SHARE = 2e-3, Assumed(UNRECORDED);
    /// Likeness (correlation of what is left) from which a rival is the nearest one.
    NEAREST_LIKENESS = 0.5, Theory("there a quarter of the information is shared");

    /// Rows without which a channel has no noise model.
    NOISE_ROWS = 40.0, Theory("five for each of the eight coefficients of its memory");
    /// Rows without which a channel is not searched for structure.
    STRUCTURE_ROWS = 200.0, Theory("more than one for each level of each of 22 signals");
    /// Rows without which gusts are not looked for.
    GUST_ROWS = 1000.0, Assumed("ten seconds of flight");
    /// Rows of held-out flight without which no gain is told.
    HELD_OUT_ROWS = 20.0, Assumed("a standard error of the gain of a sixth");
    /// Whitened squares over those that are left at least, from which on there is something to gain.
    WORTH_GAINING = 1.05, Assumed("below, what could be gained is within the noise of the held-out flight");
}
