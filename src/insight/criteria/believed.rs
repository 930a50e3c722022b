//! What is known of a number beforehand? Standard deviations of a normal prior about the base vehicle's number: wide
//! enough that a minute of flight overrules them, so that they only hold numbers that the flight does not tell.

use super::criteria;

criteria! {
    "What is known beforehand?";

    /// Time constants, as a share of the base vehicle's.
    TRUST_TIME_CONSTANT = 1.0, Assumed("the base vehicle says the order of magnitude");
    /// Full-stick rates, as a share of the base vehicle's.
    TRUST_RATE = 0.5, Assumed("rates are configured, and read from the log where it has them");
    /// Coefficients of thrust, as a share of the full thrust over mass.
    TRUST_THRUST = 1.0, Assumed("the base vehicle says the order of magnitude");
    /// Drag over mass, 1/m.
    TRUST_DRAG = 0.05, Assumed("twice the drag of a racing quadrotor");
    /// Discharge, V/s.
    TRUST_DISCHARGE = 0.1, Assumed("ten times that of a race");
    /// Parameters of an effect, in large typical sizes.
    TRUST_EFFECT = 3.0, Assumed("nothing is said about what is at most typical");
    /// Voltage at the beginning of a flight, V.
    TRUST_VOLTAGE = 10.0, Assumed("more than lies between a full and an empty pack");
    /// Smallest time constant of an effect's shape, in small typical sizes.
    SHORTEST_SHAPE = 0.3, Assumed("a time constant that goes to nothing is another effect");
}
