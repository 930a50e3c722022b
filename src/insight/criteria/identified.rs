//! Is a fitted number one that a vehicle should have?

use super::criteria;

criteria! {
    "Is it identified?";

    /// Share of the variance of the validation part that is left unexplained from which a fit does not predict.
    UNEXPLAINED_MOST = 1.0, Theory("there the mean of what was measured predicts as well: R2 is zero");
    /// Width of a 95 % interval over its value from which the value is not told.
    WIDEST_INTERVAL = 1.0, Assumed("half or one and a half times the value are then both likely");
    /// Ratio of the largest to the smallest drag of two axes that an ellipsoid is fitted with.
    DRAG_RATIO = 30.0, Assumed("frames with ducts come to ten; more would be a sheet");
    /// Rate below which motor outputs and rotor speeds are not used, Hz.
    ROTOR_RATE_HZ = 50.0, Assumed("rotors answer within tens of milliseconds");
    /// Rates behind their setpoints, summed over the axes as shares of the largest setpoints, below which a mixer
    /// leaves the collective alone.
    CALM = 0.1, Assumed("Betaflight, rehearsed: mean motor output off by 0.00 to 0.02 below, up to 0.4 above");
    /// Share of the range of the motors' outputs within which one is at an end of it.
    MOTOR_END_SHARE = 0.01, Assumed("outputs at an end are exactly there but for rounding");
    /// For so long after one was there, rotors and rates are still on their way, s.
    MIXER_SETTLING_S = 0.2, Assumed("six time constants of slow rotors; after 0.1 s 1 m/s2 was left of 30");
    /// Share of a flight that has to be calm for what is not to be left out.
    CALM_LEAST = 0.1, Assumed("a tenth of five minutes is as much flight as identification asks for");
    /// Rate setpoints beyond the full-stick rate that was taken for the vehicle's, as a share, that contradict it.
    BEYOND_FULL_STICK = 1.05, Assumed("setpoints end at the full-stick rate but for rounding and filters");
}
