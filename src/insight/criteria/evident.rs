//! Is there an effect?

use super::{UNRECORDED, criteria};

criteria! {
    "Is it evident?";

    /// Fall of the whitened squares for which an effect is added.
    LEAST_GAIN = 30.0,
        Theory("5.5 standard deviations: by chance once in some 25 million directions, of which each round tries \
            about a hundred; noise is less white than that");
    /// Fall of the whitened squares from which an effect is worth a fit of its own.
    GAIN_WORTH_A_FIT = 15.0,
        Assumed("half the least gain: the score test is linear, and a fit can gain more than it expects");
    /// Robust score (squared standard deviations over stretches) from which it is.
    EVIDENCE_WORTH_A_FIT = 4.5, Theory("two standard deviations, by the spread over stretches of time");
    /// Fall of the whitened squares for which even a few stretches are worth a fit.
    RARE_GAIN = 100.0, Assumed(UNRECORDED);
    /// Fall of the whitened squares for which an effect of no size that matters is kept beside the causes.
    NUISANCE_GAIN = 400.0, Assumed(UNRECORDED);
    /// Share of what an effect gains that its form has to gain beside it.
    FORM_GAIN = 0.2, Assumed("the form of what hardly shows is not told, and is extrapolated where a size is not");
    /// Fall of the whitened squares for which a form is told, whatever its effect gains.
    FORM_TOLD = 400.0, Assumed("as NUISANCE_GAIN; one that does not pay on unseen flight is given up again");
    /// Candidates that are fitted in a round, besides rivals.
    SHORT_LIST = 6.0, Assumed("a fit is a hundred times as dear as a score");
    /// Effects that are added at most.
    MOST_EFFECTS = 12.0, Assumed("eight were too few for a measured flight, whose ninth was its lift");
    /// Effects of the rates alone that are added at most, so that they leave room for others.
    MOST_RATE_EFFECTS = 4.0,
        Assumed("a rate loop has a delay, an order, a limit and an axis of its own; else it takes all places");
    /// Share of its gain that an effect keeps where a number of it ends at the bound of its range.
    BOUNDED_MERIT = 0.5, Assumed(UNRECORDED);
    /// Largest sum of the coefficients of a channel's memory: a constant residual keeps at least what is left to 1 of
    /// its size.
    MOST_MEMORY = 0.6,
        Assumed("on measured flights a freer noise model takes every slow cause for noise; the bound itself was not \
            compared with others");
    /// Standard deviations that the size of a named effect has to be.
    SURE_DEVIATIONS = 4.0, Theory("one in 16 000 by chance: of a catalogue of forty, once in four hundred flights");
    /// Share of a channel's residual from which an effect explains anything of it.
    EXPLAINS_ANYTHING = 1e-3, Assumed("a thousandth of the power is no reason to speak");
    /// Share of a typical skew from which clocks that run apart are tried from it.
    SKEW_TRIED = 0.5, Assumed("less is within reach of the other directions");
}
