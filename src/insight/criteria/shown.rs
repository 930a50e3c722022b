//! Is it worth a word, or a figure?

use super::criteria;

criteria! {
    "Is it worth showing?";

    /// Delay before a rate response that is remarked on, s.
    REMARKED_DELAY_S = 0.003, Assumed("a third of a control period");
    /// Share of the validation error that it has to leave at most.
    REMARKED_ERROR = 0.95, Assumed("a twentieth of the error is worth a remark");
    /// R2 above which nobody asks for a delay.
    REMARKED_R2 = 0.9995, Assumed("what is left is the gyro's noise");
    /// Share of a channel that a finding explains that is mentioned.
    MENTIONED_SHARE = 0.02, Assumed("a hundredth of the error");
    /// Share of a channel that a finding explains that is worth a figure.
    FIGURE_SHARE = 0.05, Assumed("visible in a plot");
    /// Fall of the error of a channel that is worth a figure.
    FIGURE_FALL = 0.02, Assumed("visible in a plot");
}
