//! Is there an effect?

use super::criteria;

/// The benchmark that calibrations come from.
const HIDDEN: &str = "cargo bench --bench hidden_effects -- --n 300";

criteria! {
    "Is it evident?";

    /// Fall of the whitened squares for which an effect is added.
    LEAST_GAIN = 30.0, Theory("the 1e-7 tail of chi-squared with one degree of freedom is 28: a hundred directions, tried in eight rounds of thousands of flights");
    /// Robust score (squared standard deviations over stretches) for which an effect is added.
    LEAST_EVIDENCE = 9.0, Theory("three standard deviations, by the spread over stretches of time");
    /// Share of both from which an effect is worth a fit of its own.
    WORTH_A_FIT = 0.5, Assumed("a fit from its best size gains up to twice what the score test expects");
    /// Fall of the whitened squares for which even a few stretches are worth a fit.
    RARE_GAIN = 100.0, Calibrated(HIDDEN);
    /// Fall of the whitened squares for which an effect of no size that matters is kept beside the causes.
    NUISANCE_GAIN = 400.0, Calibrated(HIDDEN);
    /// Candidates that are fitted in a round, besides rivals.
    SHORT_LIST = 6.0, Assumed("the score test has the right one among the first three nearly always");
    /// Effects that are added at most.
    MOST_EFFECTS = 8.0, Assumed("more than any flight has shown");
    /// Share of its gain that an effect keeps where a number of it ends at the bound of its range.
    BOUNDED_MERIT = 0.5, Calibrated(HIDDEN);
    /// Largest sum of the coefficients of a channel's memory: a constant residual keeps at least what is left to 1 of its size.
    MOST_MEMORY = 0.6, Calibrated("racer diagnose on the measured flights of RESULTS.md: above it the noise model takes every slow cause for noise");
    /// Standard deviations that the size of a named effect has to be.
    SURE_DEVIATIONS = 4.0, Theory("one in 16 000 by chance, so that a catalogue of forty has one in four hundred flights");
    /// Share of a channel's residual from which an effect explains anything of it.
    EXPLAINS_ANYTHING = 1e-3, Assumed("a thousandth of the power is no reason to speak");
    /// Share of a typical skew from which clocks that run apart are tried from it.
    SKEW_TRIED = 0.5, Assumed("less is within reach of the other directions");
}
