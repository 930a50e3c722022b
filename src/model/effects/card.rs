//! What an effect tells of itself. Who simulates, fits, judges or reports effects asks the card, and names none.

use super::quantity::Quantity;

/// What a person and the diagnosis have to know about an effect. Fill what differs from [`Card::BLANK`].
#[derive(Debug)]
pub struct Card {
    /// What the program prints, writes and reads, such as `axial_inflow`.
    pub id: &'static str,
    /// The field's name for it.
    pub name: &'static str,
    /// What it means to a pilot, in one sentence.
    pub sentence: &'static str,
    pub kind: EffectKind,
    /// All are 0 where the effect is absent. The first is its size.
    pub parameters: &'static [EffectParameter],
    /// Which parameter is no size but a form, such as a time constant: it means nothing where the size is 0.
    pub shape: Option<usize>,
    /// Which parameters are fitted only where flights show them beside the size, such as how that goes with the speed.
    pub forms: &'static [usize],
    /// Identifiers of the effects that it is the whole of, each at its own size.
    pub parts: &'static [&'static str],
    /// Identifiers of effects that every vehicle has and that together look like it: it is named where they do worse.
    pub together: &'static [&'static str],
    /// What its equation changes, and what it takes from what other numbers make.
    pub writes: &'static [Quantity],
    pub reads: &'static [Quantity],
    /// Channels of the residual that it can show in.
    pub channels: &'static [ResidualChannel],
    /// Whether a large size looks unlike a small one, so that fits begin at several.
    pub nonlinear: bool,
    /// How the rates follow under it.
    pub response: RateResponse,
    /// How it acts on a log, where no stage of the simulator does.
    pub role: Role,
    /// Numbers of the compact model that take it up where it is not fitted.
    pub absorbed_by: &'static [CompactNumber],
    /// Whether its equation turns the voltage about the middle of the battery where controllers do about a full one.
    /// Only the base vehicle, or flights without it, tell that from another thrust.
    pub about_full: bool,
    /// Whether it goes with the height, whose errors in an estimate change its size several-fold from one visit to the
    /// next.
    pub by_height: bool,
    /// Effects of all axes beside which this one is yaw's own share of the same.
    pub apart_from: &'static [&'static str],
    /// Which part of a flight controller's answer it is, where identification looks for it.
    pub controller: Option<ControllerPart>,
    /// An effect with the same mean, and what tells the two apart.
    pub twin: Option<Twin>,
    /// What makes its size negative more often than the effect does, in words; empty where nothing does.
    pub negative: &'static str,
    /// What gives it away.
    pub signature: &'static str,
    /// Identifiers of effects that look alike. One side of a pair is enough: see [`super::are_rivals`].
    pub rivals: &'static [&'static str],
    /// What a pilot flies to tell it from its rivals, and the manoeuvres that `racer fly --pilot` flies for it.
    pub manoeuvre: (&'static str, &'static [&'static str]),
    /// The parameters as people read them, where they differ from those of the equation.
    pub shown: Option<ShownParameters>,
}

/// From the equation's parameters (and the time constants of roll, pitch, yaw and thrust, s) to what people read: name,
/// value, unit.
pub type ShownParameters = fn(&[f64], [f64; 4]) -> Vec<(&'static str, f64, &'static str)>;

impl Card {
    /// What most effects have in common.
    pub const BLANK: Card = Card {
        id: "",
        name: "",
        sentence: "",
        kind: EffectKind::Thrust,
        parameters: &[],
        shape: None,
        forms: &[],
        parts: &[],
        together: &[],
        writes: &[],
        reads: &[],
        channels: &[],
        nonlinear: false,
        response: RateResponse::FirstOrder,
        role: Role::InStages,
        absorbed_by: &[],
        about_full: false,
        by_height: false,
        apart_from: &[],
        controller: None,
        twin: None,
        negative: "",
        signature: "",
        rivals: &[],
        manoeuvre: ("", &[]),
        shown: None,
    };

    /// The parameters that are sizes, with their places.
    pub fn sizes(&self) -> impl Iterator<Item = (usize, &'static EffectParameter)> {
        let shape = self.shape;
        self.parameters.iter().enumerate().filter(move |(i, _)| Some(*i) != shape)
    }
}

/// A parameter of an effect.
#[derive(Debug)]
pub struct EffectParameter {
    pub name: &'static str,
    pub unit: &'static str,
    /// Bounds of the search.
    pub low: f64,
    pub high: f64,
    /// Sizes that matter on a 5-inch racing quadrotor; below half the first, nobody would notice.
    pub typical: [f64; 2],
}

/// Where an effect belongs, and so what is done about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectKind {
    /// Extends the simulator.
    Timing,
    Thrust,
    Battery,
    Drag,
    /// Disturbs the simulator at random: found in the variance, not in the mean.
    Random,
    /// Corrects the log and widens the observation noise; never becomes dynamics.
    Sensor,
}

/// A residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ResidualChannel {
    /// Gyro less simulated body rate, rad/s.
    Rate,
    /// Accelerometer less simulated specific force, m/s2.
    Force,
    /// Turn of the attitude less integrated gyro, over a quarter of a second, rad.
    Turn,
    /// Change of velocity less integrated accelerometer, over a quarter of a second, m/s.
    Push,
    /// Voltage less simulated voltage, V.
    Voltage,
}

/// How body rates follow their commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateResponse {
    FirstOrder,
    /// With an inertia, which oscillates.
    SecondOrder,
    /// With a largest change.
    Limited,
}

/// How an effect acts on a log. Its first parameter is the number that is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// By the functions of [`super::Effect`] alone.
    InStages,
    /// An error that does not change during a flight: every fit allows for it, and it is reported beyond what is usual.
    ConstantError,
    /// The gyro's samples are stamped so much late, s.
    GyroLate,
    /// Gyro and accelerometer are both stamped so much late, s, and the odometry was moved to them.
    ImuLate,
    /// The odometry is stamped so much late, s: every fit allows for it.
    OdometryLate,
    /// The sensors' clock runs fast by this share.
    ClockFast,
    /// The velocity went through a first-order lag, s.
    VelocityLag,
    /// This share of the commands is lost; the one before is held.
    CommandsLost,
    /// A random force of this deviation, m/s2, and the time that forgets it, s.
    RandomForce,
    /// One motor gives less than the others: what they are driven with tells which.
    OneMotor,
    /// Air that moves alike everywhere: what differs from place to place is something else.
    UniformWind,
}

/// Numbers of the compact model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompactNumber {
    RollTime,
    PitchTime,
    YawTime,
    ThrustTime,
    Thrust,
    Drag,
}

/// What a flight controller makes of commands beyond a lag, by the first parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ControllerPart {
    /// Delay of all rates, s.
    Delay,
    /// By how much more yaw is delayed, s.
    YawDelay,
    /// T2 of the second order of all rates, s2.
    Inertia,
    /// T2 of yaw's second order, s2.
    YawInertia,
    /// One over the largest angular acceleration of roll and pitch, s2/rad.
    Slew,
    /// Throttle that the mixer keeps free for turns, over the error of the rates, s/rad.
    Room,
}

impl ControllerPart {
    /// Those of how the rates follow.
    pub const OF_RATES: [Self; 5] = [Self::Delay, Self::YawDelay, Self::Inertia, Self::YawInertia, Self::Slew];
}

/// An effect that has the same mean as another.
#[derive(Clone, Copy, Debug)]
pub struct Twin {
    /// Identifier of the other.
    pub effect: &'static str,
    pub told_by: Evidence,
}

/// What tells two effects of the same mean apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The time by which the odometry's clock had to be moved to the gyro's: a gyro that is stamped late is late
    /// against the odometry, too. Of a whole IMU the motors' outputs tell as well: its stamp does not delay them.
    OdometryClock,
    /// What single stick movements leave: the whole of an error or none of it.
    SingleMovements,
}
