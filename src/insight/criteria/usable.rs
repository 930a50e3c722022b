//! Is this flight that can be learned from?

use super::criteria;

criteria! {
    "Is this usable flight?";

    /// Equal samples in a row at a signal's largest size that are clipping.
    CLIPPED_RUN = 5.0, Assumed("chance repeats a noisy sample once or twice, not five times");
    /// Rate below which nothing clips, rad/s.
    CLIPPED_RATE = 8.0,
        Assumed("gyros of hobby vehicles end at 17 or 35 rad/s; a quiet quantised signal repeats itself too");
    /// Specific force below which nothing clips, m/s2.
    CLIPPED_FORCE = 30.0, Assumed("accelerometers of hobby vehicles end at 4 g or later");
    /// Kept away from clipping, s.
    CLIPPING_MARGIN_S = 0.1, Assumed("filters of flight controllers ring for less");

    /// Share of repeated rows from which a stream holds samples of a slower source.
    HELD_ROWS = 0.5, Assumed("noise repeats no row; a source of half the rate repeats every second one");
    /// Usual periods without a sample that are a gap.
    GAP_PERIODS = 5.0, Assumed("schedulers of flight controllers skip one or two");
    /// Break that is bridged, s.
    BRIDGED_S = 0.05, Assumed("held commands and a lag of tens of milliseconds hardly notice it");

    /// Usable stretch that is kept, s.
    SHORTEST_FLIGHT_S = 2.0, Assumed("longer than what a vehicle remembers, by an order");
    /// Specific force across the thrust that only an impact makes, m/s2.
    IMPACT_FORCE = 35.0, Assumed("drag across the thrust is less at the speeds of racing");
    /// Kept away from an impact, s.
    IMPACT_MARGIN_S = 0.5, Assumed("frames ring for a few tenths of a second");
    /// Time after its last impact within which a log that ends is a crash, s.
    CRASH_TAIL_S = 3.0, Assumed("pilots disarm within a few seconds");
    /// Turning below which the vehicle may stand still, rad/s.
    STILL_RATE = 0.3, Assumed("a hover turns more in a tenth of a second, a gyro's bias is less");
    /// Distance of the specific force from gravity below which it may stand still, m/s2.
    STILL_FORCE = 1.0, Assumed("accelerometers are off by less");
    /// Speed of the odometry from which it does not stand still, m/s.
    SLIDING_SPEED = 2.0, Assumed("estimates drift by some 0.3 m/s on the ground; without thrust that is soon exceeded");
    /// Share of the usual effort of the rotors below which they do not carry the vehicle.
    IDLE_EFFORT = 0.6, Assumed("thrust goes with about the square of the effort: a third of the weight");
    /// Change of the rate over a second, as a standard deviation, below which it rests, rad/s.
    REST_RATE = 0.01,
        Assumed("standing it was up to 0.006 in logs of five flight controllers, in the calmest hover 0.0125");
    /// The same of the specific force, m/s2.
    REST_FORCE = 0.03, Assumed("standing it was up to 0.02 in the same logs; in the air the rate moves in any case");
    /// Command below which no vehicle flies, of the full one.
    LEAST_COMMAND = 0.02, Theory("it would have fifty times its weight in thrust");
    /// Standing still in mid-flight that is a landing, s.
    LANDING_S = 2.0, Assumed("a chop falls for less");
    /// The same at the beginning and at the end of a log, s.
    RESTING_S = 0.2, Assumed("two bins of a tenth of a second");
    /// Distance from either end of a log that counts as its end, s.
    LOG_END_S = 1.0, Assumed("logging begins and ends within a second of arming");
    /// Kept away after take-off, s.
    TAKE_OFF_MARGIN_S = 0.3, Assumed("the legs leave the ground within it");
    /// Kept away before standing still, s.
    TOUCH_DOWN_MARGIN_S = 1.0, Assumed("touching down comes before standing still");
    /// Kept away from the end of a log, s.
    END_MARGIN_S = 0.5, Assumed("logs are often cut off while the vehicle touches down");

    /// Commands of so many seconds explain a rate.
    COMMAND_MEMORY_S = 0.4, Assumed("several times the slowest rate response, 0.1 s");
    /// Rate beyond what those commands asked for that is no response, rad/s.
    UNASKED_RATE = 5.0, Assumed("overshoot of a badly tuned loop is less");
    /// The same as a share of the range of those commands.
    UNASKED_SHARE = 0.6, Assumed("an overshoot of more would be no loop");
    /// Kept away from turning that nobody asked for, s.
    TUMBLING_MARGIN_S = 0.3, Assumed("the attitude is caught within it");
    /// Share of a log beyond which its commands are wrong, not the flight.
    TUMBLING_SHARE = 0.2, Assumed("nobody logs a flight that is a fifth out of control");
    /// Times in a log beyond which the same holds.
    TUMBLING_TIMES = 20.0, Assumed("nobody logs a flight with twenty crashes");

    /// Velocity beyond the median of its neighbours that no vehicle reaches, m/s, besides what acceleration explains.
    VELOCITY_JUMP_M_S = 1.0, Assumed("noise of velocity estimates is a tenth of that");
    /// Acceleration that a vehicle may have, m/s2.
    VELOCITY_ACCELERATION = 100.0, Assumed("ten g: more than racing quadrotors have");
    /// Odometry slower than this is not integrated against, Hz.
    ODOMETRY_RATE_HZ = 40.0, Assumed("attitude is interpolated between its samples; a flip takes 0.3 s");

    /// Power of a second's whitened residual, in medians of all seconds, from which it is an accident and left out.
    ACCIDENT_POWER = 30.0, Assumed("five times as far off as usual, throughout a second");
    /// Robust standard deviations (of the logarithm) that it is beyond the others besides.
    ACCIDENT_DEVIATIONS = 8.0, Assumed("seconds of flights that vary a lot have heavier tails than the normal law");
    /// Share of the seconds up to which they are accidents; more is what the vehicle does.
    ACCIDENT_SHARE = 0.03, Assumed("an effect that is flown rarely shows in more of them");
    /// Seconds up to which they are accidents in a short flight.
    ACCIDENT_SECONDS = 3.0, Assumed("a hit and what follows it, across the full second");
    /// Kept away from such a second, s.
    ACCIDENT_MARGIN_S = 0.25, Assumed("the stretch over which turns and pushes are compared");
}
