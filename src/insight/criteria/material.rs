//! Does its size matter?

use super::criteria;

criteria! {
    "Does it matter?";

    /// Size of an effect, in its small typical sizes, that anybody would notice.
    MATERIAL_SIZE = 0.5, Assumed("the small typical size of an effect's card is one that a lap shows");
    /// Bias of a sensor, in its small typical sizes, that is more than any such sensor has.
    MATERIAL_BIAS = 0.8, Assumed("the fit of every flight allows for smaller ones");
    /// What is worth a name after a second, m/s.
    LEAST_IMPACT = 0.005, Assumed("IndiFlight's late thrust, 6 % of an unseen force, has 0.007, a false one 0.003");
    /// The same of what a sensor's error integrates to, m/s.
    LEAST_SENSOR_IMPACT = 0.02, Assumed("below the errors of any estimator");
    /// Gusts that are worth a word, m/s2.
    MATERIAL_GUST = 0.08, Assumed("a push of 0.1 m/s over the second that a policy plans ahead");
    /// Structure in rates that nobody needs to care about, rad/s.
    IDLE_RATE = 0.025, Assumed("below the noise that policies are trained with");
    /// The same in specific force, m/s2.
    IDLE_FORCE = 0.08, Assumed("a push of 0.1 m/s over the second that a policy plans ahead");
    /// The same in the voltage, V.
    IDLE_VOLTAGE = 0.02, Assumed("a change of thrust of 0.3 %");
    /// Share of its thrust that a weak motor lacks against the others.
    WEAK_MOTOR = 0.05, Assumed("motors and propellers of one make differ by a few percent");
}
