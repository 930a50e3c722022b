//! Could it be another cause?

use super::{UNRECORDED, criteria};

criteria! {
    "Is there a rival?";

    /// Standard deviations of their difference within which two causes are a tie.
    TIE_DEVIATIONS = 2.5, Theory("one in eighty by chance");
    /// Likeness of what two rivals add to the prediction from which on they may be one cause.
    ONE_LIKENESS = 0.7, Assumed("half of what either explains is the other's");
    /// Share of its gain that a rival keeps at most, once the best is in, to compete with it.
    RIVAL_KEEPS = 0.3, Assumed(UNRECORDED);
    /// Shift of the rates over a flight beyond which no response slows, s.
    SLOWED_MOST_S = 0.03, Assumed("half of a slow vehicle's response: with two thirds of its voltage it takes twice as \
        long");
    /// Difference of the delays after commands and after the odometry that is none, s.
    SAME_DELAY_S = 6e-4, Assumed("a third of the IMU's period at 500 Hz");
    /// The same as a share of the delay.
    SAME_DELAY_SHARE = 0.05, Assumed("both are known to a few percent");
    /// Share of a delay by which the motors' outputs follow the throttle, from which on commands have it before the
    /// motors, and below which they have it behind them.
    BEFORE_SHARE = 0.4, Assumed("all of it or none, known to a millisecond");
    /// Share of it by which turns follow the outputs, beyond a lag, where gyro and accelerometer are late by it.
    BEHIND_SHARE = 0.8, Assumed("motors that are no plain lag seem some 2 ms late besides");
    /// Difference of a lag of the velocity from the shift of its clock, as a share of that, up to which it comes from
    /// it.
    SAME_LAG_SHARE = 0.5, Assumed("the lag is known worse than the shift");
    /// A delay of less than so many times the mean delay of the lost commands is theirs.
    LOST_DELAY = 3.0, Assumed("bursts of lost commands have a mean delay beyond a single one's");
    /// Share of what the motors differ by that a single one has to account for to be weak.
    ALONE_SHARE = 0.75, Theory("a centre of mass that is off gives a third, off in two directions at most two thirds");
    /// Share of a constant error along the thrust that it may have across, for a vibration to look like it.
    ACROSS_SHARE = 0.25, Assumed("a vibration of the motors acts along the thrust; the rest is the noise of the fit");
}
