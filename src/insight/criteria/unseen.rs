//! Does it hold on flight that was not used for fitting, and for the sensors by themselves?

use super::criteria;

criteria! {
    "Does it hold elsewhere?";

    /// Share of all flight from which a single flight is unseen by thirds: what the others know is no measure of it.
    MOST_UNSEEN = 0.6, Assumed("half as long again as all others together");
    /// Standard deviations (over stretches of time) by which an effect has to lower the whitened squares of unseen
    /// flight.
    PAYS_DEVIATIONS = 2.0, Theory("one in forty by chance; four stretches that agree");
    /// Whitened squares of unseen flight that one stretch of time may count for or against a cause, where the sum of
    /// all is for it.
    MOST_EVIDENCE = 10.0, Theory("one in 150 by chance; one fast leg is not all that a short flight knows of drag");
    /// Difference of a skew as fitted from what it is followed at through the flight, as a share of that, up to which
    /// both are one.
    SAME_SKEW_SHARE = 0.5, Assumed("windows of six seconds tell it to a few percent of what matters");
    /// Standard deviations by which unseen flight has to be predicted worse in a channel to be worse.
    WORSE_DEVIATIONS = 2.0, Theory("one in forty by chance; what is tried first then costs no name");
    /// Rise of a channel's error on unseen flight, as a share, that is worse.
    WORSE_SHARE = 0.01, Assumed("a hundredth of the error is worth no word");
    /// Rise from which it is worse as well where stretches of time are by the share of each.
    MUCH_WORSE_SHARE = 0.05, Assumed("less is left to the stretches with the largest errors");
    /// Share of a sensor's error that attitude and velocity have to show by themselves.
    KINEMATIC_SHARE = 0.5, Assumed("kinematics do not depend on the model of the vehicle; half allows for their noise");
    /// Standard deviations by which they have to show less.
    KINEMATIC_DEVIATIONS = 2.0, Theory("one in forty by chance");
    /// Share of an effect's size that has to be left beside rates that go with the velocity.
    MOMENT_SHARE = 0.75, Assumed("0.5 and 0.6 of an expo beside flapping rotors in rotorpy, 0.99 in the third truth");
    /// Two effects cancel from this likeness on, of the opposite sign.
    CANCEL_LIKENESS = 0.9, Theory("there a fifth of the information on either is its own");
    /// Share of the larger one's whitened squares that both together may leave to cancel.
    CANCEL_LEFT = 0.25, Theory("half of its size");
    /// Share of the power of a channel from which what explains it has its name, though it makes another channel worse
    /// and is not written.
    STANDS_ELSEWHERE = 0.5, Assumed("a sag of 0.5 V explains 0.87 of what the voltage is off by");
}
