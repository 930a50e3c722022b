//! Do clocks, signs, axes and frames of a log agree?

use super::criteria;

criteria! {
    "Do clocks, signs and frames agree?";

    /// Rotations that tell of a clock offset.
    OFFSET_TURNS = 200.0, Assumed("the median of fewer is no smooth function of the offset");
    /// Size of a rotation that tells, rad.
    OFFSET_TURN_RAD = 0.02, Assumed("above the noise of estimated attitudes");
    /// Cost at the best offset, as a share of the median, that is a clear minimum.
    OFFSET_MINIMUM = 0.5, Assumed("wrong frames have no minimum at all");
    /// Offset that is left, s.
    OFFSET_LEFT_S = 0.003, Assumed("about a sample of the odometry");

    /// Share by which masses and full-stick rates that logs of one vehicle say may differ.
    SAME_RECORD = 0.02, Assumed("they come from one weighing and one configuration, rounded");

    /// Samples without which nothing is said about signs and frames.
    FRAME_SAMPLES = 100.0, Assumed("correlations of fewer are chance");
    /// Correlation against its setpoint that is a wrong sign.
    SIGN_CORRELATION = 0.5, Assumed("rates that follow correlate well above it");
    /// Correlation with another axis that is a swapped axis.
    SWAPPED_CORRELATION = 0.8, Assumed("sticks are moved together, but not that much");
    /// Share of that correlation below which its own axis has none.
    SWAPPED_OWN = 0.5, Assumed("an axis that follows has at least as much of its own");
    /// Specific force across z, as a share of that along z, that is no upright IMU.
    UPRIGHT_SHARE = 0.5, Assumed("at the median a vehicle is tilted by less than a quarter of a right angle");
    /// Largest turn below which attitude and gyro are not compared, rad.
    ATTITUDE_TURN_RAD = 0.05, Assumed("above the noise of estimated attitudes");
    /// Correlation of attitude and gyro below which a frame is wrong.
    ATTITUDE_CORRELATION = 0.3, Assumed("a held, smoothed or noisy attitude still agrees in sign");
    /// Share of the gyro's turns that the attitude has on average, below which it is.
    ATTITUDE_SHARE = 0.5, Assumed("a right one has all of them, however noisy; a wrong axis or sign none");
    /// Mean of the upright specific force, as a share off gravity, that is a wrong frame.
    GRAVITY_SHARE = 0.25, Assumed("climbs and descents average out to less");
    /// Fastest speed below which velocity and position are not compared, m/s.
    VELOCITY_SPEED_M_S = 0.5, Assumed("above the drift of estimated positions");
    /// Compared samples below which the same holds.
    VELOCITY_SAMPLES = 50.0, Assumed("correlations of fewer are chance");
    /// Correlation of velocity with the change of position below which a frame is wrong.
    VELOCITY_CORRELATION = 0.5, Assumed("a smoothed or late velocity still has more");

    /// Share of the squares of the turns that a rotation of the IMU has to explain.
    MOUNTING_FIT = 0.8, Assumed("gyro and attitude agree to a few percent; setpoints are followed late");
    /// Share of what is unexplained without it that it has to explain.
    MOUNTING_BETTER = 0.2, Assumed("noise is not mended by turning it");
    /// Least turning about a second axis, as a share of that about the first, that tells a rotation.
    MOUNTING_RANK = 0.02, Assumed("turns about one axis leave the angle about it open");
    /// Rotation of the IMU that is told, rad.
    MOUNTING_SEEN_RAD = 0.17, Assumed("ten degrees: a fifth of each axis shows in another");
    /// Rotation of the IMU that makes everything wrong, rad.
    MOUNTING_WRONG_RAD = 0.5, Assumed("thirty degrees: half of each axis shows in another");
    /// Share of the commands with a time stamp of the IMU that makes it one clock.
    ONE_CLOCK_SHARE = 0.9, Assumed("clocks that run apart share stamps by chance only");
    /// Share of the thrust commands at one ratio to the rotor speed that makes them one signal.
    ROTOR_COMMAND_SHARE = 0.9, Assumed("a commanded rotor follows late, never exactly");
    /// Rows of thrust command beside rotor speed without which nothing is said.
    ROTOR_COMMAND_ROWS = 100.0, Assumed("a second of the slowest logs");
    /// Correlation at which the offset of two clocks is believed in a window.
    CLOCK_CORRELATION = 0.5, Assumed("rates that follow correlate well above it");
    /// Skew beyond which nothing is looked for, as a share.
    CLOCK_SKEW_MOST = 0.025, Assumed("uncompensated resonators are good to half a percent");
    /// Bins without which clocks are not followed.
    CLOCK_BINS = 2000.0, Assumed("a few windows of six seconds");
    /// Skew from which the base is not fitted before it is taken off, as a share.
    CLOCK_SKEW_SEEN = 5e-5, Assumed("adds up to 15 ms in five minutes, a response's time constant");
}
