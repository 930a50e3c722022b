//! What the compact model can get wrong: optional effects, each an extension of the model whose parameters are 0 where it is absent.
//!
//! One file is one effect: its card (names, parameters, signature, rivals, manoeuvre) and its equation, generic over
//! [`Real`]. Simulator and diagnosis call the same equation at the same place of [`crate::model::dynamics::extended`]. To add an effect, write its file
//! and its line in the list below.

mod stages;

use crate::base::lane::{Lane, Real};
pub use stages::{
    Actuator, AerodynamicForces, BatteryLoad, BodyRates, CommandDelay, RelativeWind, Sensed, Setpoint, ThrustInput,
};

/// What a person and the diagnosis have to know about an effect.
#[derive(Debug)]
pub struct Card {
    /// What the program prints, writes and reads, such as `axial_inflow`.
    pub id: &'static str,
    /// The field's name for it.
    pub name: &'static str,
    /// What it means to a pilot, in one sentence.
    pub sentence: &'static str,
    pub kind: EffectKind,
    /// All are 0 where the effect is absent.
    pub parameters: &'static [EffectParameter],
    /// Channels of the residual that it can show in.
    pub channels: &'static [ResidualChannel],
    /// What gives it away.
    pub signature: &'static str,
    /// Identifiers of effects that look alike.
    pub rivals: &'static [&'static str],
    /// What a pilot flies to tell it from its rivals, and the kinds of manoeuvres that `racer fly --pilot` flies for it.
    pub manoeuvre: (&'static str, &'static [&'static str]),
    /// The parameters as people read them, where they differ from those of the equation.
    pub shown: Option<Shown>,
}

/// From the equation's parameters (and the time constant of the roll rate, s, and of the thrust, s) to what people read: name, value, unit.
pub type Shown = fn(&[f64], [f64; 2]) -> Vec<(&'static str, f64, &'static str)>;

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

/// One effect. Every function may change what passes its stage, by the effect's parameters `k` in the order of the card; those
/// it does not write leave their stage alone.
pub trait Effect {
    const CARD: Card;
    /// When commands arrive.
    #[inline(always)]
    fn command_delay<R: Real>(_k: &[R], _delay: &mut CommandDelay<R>) {}
    /// Commands as they were sent, before the lag.
    #[inline(always)]
    fn setpoint<R: Real>(_k: &[R], _setpoint: &mut Setpoint<R>) {}
    /// How rates and thrust follow.
    #[inline(always)]
    fn actuator<R: Real>(_k: &[R], _actuator: &mut Actuator<R>) {}
    /// From filtered commands to body rates.
    #[inline(always)]
    fn body_rates<R: Real>(_k: &[R], _body: &mut BodyRates<R>) {}
    /// What the load takes from the voltage.
    #[inline(always)]
    fn battery_load<R: Real>(_k: &[R], _battery: &mut BatteryLoad<R>) {}
    /// What reaches the thrust curve.
    #[inline(always)]
    fn thrust_input<R: Real>(_k: &[R], _input: &mut ThrustInput<R>) {}
    /// The air's own motion.
    #[inline(always)]
    fn relative_wind<R: Real>(_k: &[R], _wind: &mut RelativeWind<R>) {}
    /// Thrust and drag.
    #[inline(always)]
    fn aerodynamic_forces<R: Real>(_k: &[R], _forces: &mut AerodynamicForces<R>) {}
    /// What the sensors make of the truth.
    fn sense(_k: &[f64], _sensed: &mut Sensed) {}
}

macro_rules! effects {
    (model: $($model:ident::$Model:ident)*; log: $($log:ident::$Log:ident)*;) => {
        $(mod $model;)*
        $(mod $log;)*
        /// Cards of the effects that extend the simulator.
        pub const MODEL: [&Card; [$(stringify!($model)),*].len()] = [$(&$model::$Model::CARD),*];
        /// Cards of the effects of sensors and of chance, which are no dynamics.
        pub const LOG: [&Card; [$(stringify!($log)),*].len()] = [$(&$log::$Log::CARD),*];

        #[allow(clippy::enum_variant_names)]
        enum Index { $($Model),* }
        #[allow(clippy::enum_variant_names)]
        enum LogIndex { $($Log),* }

        effects!(@stage $($model::$Model)*;
            command_delay CommandDelay, setpoint Setpoint, actuator Actuator, body_rates BodyRates, battery_load BatteryLoad,
            thrust_input ThrustInput, relative_wind RelativeWind, aerodynamic_forces AerodynamicForces,);

        /// Every sensor's effect on a reading; `k` holds the parameters of all of [`LOG`].
        #[inline(always)]
        pub fn sense(k: &[f64], sensed: &mut Sensed) {
            $({
                const AT: usize = offset(&LOG, LogIndex::$Log as usize);
                const N: usize = $log::$Log::CARD.parameters.len();
                if k[AT..AT + N].iter().any(|k| *k != 0.0) {
                    $log::$Log::sense(&k[AT..AT + N], sensed);
                }
            })*
        }
    };
    (@stage $($model:ident::$Model:ident)*; ) => {};
    (@stage $($model:ident::$Model:ident)*; $stage:ident $Stage:ident, $($rest:tt)*) => {
        #[doc = concat!("Stage `", stringify!($stage), "` of every effect that is present.")]
        #[inline(always)]
        pub fn $stage<R: Real>(values: &EffectValues<R>, stage: &mut $Stage<R>) {
            $(
                if values.active & 1 << Index::$Model as u32 != 0 {
                    const AT: usize = offset(&MODEL, Index::$Model as usize);
                    const N: usize = $model::$Model::CARD.parameters.len();
                    let k: [R; N] = crate::base::lane::build!(|i| values.numbers[AT + i]);
                    $model::$Model::$stage(&k, stage);
                }
            )*
        }
        effects!(@stage $($model::$Model)*; $($rest)*);
    };
}

// The order is that of every stage: what scales the thrust comes before what adds to it, what scales everything last.
effects! {
    model:
        rate_delay::RateDelay
        yaw_delay::YawDelay
        thrust_delay::ThrustDelay
        rate_second_order::RateSecondOrder
        rate_slew_limit::RateSlewLimit
        rate_expo::RateExpo
        response_voltage::ResponseVoltage
        rate_cross_coupling::RateCrossCoupling
        gyroscopic_coupling::GyroscopicCoupling
        yaw_authority_loss::YawAuthorityLoss
        weak_motor::WeakMotor
        thrust_asymmetric_lag::ThrustAsymmetricLag
        voltage_sag::VoltageSag
        voltage_relaxation::VoltageRelaxation
        ocv_curve::OcvCurve
        voltage_compensation::VoltageCompensation
        throttle_offset::ThrottleOffset
        mixer_thrust_loss::MixerThrustLoss
        thrust_fade::ThrustFade
        ground_effect::GroundEffect
        propwash::Propwash
        axial_inflow::AxialInflow
        translational_lift::TranslationalLift
        rate_thrust_coupling::RateThrustCoupling
        rotor_drag::RotorDrag
        drag_asymmetry::DragAsymmetry
        body_lift::BodyLift
        vertical_drag::VerticalDrag
        steady_wind::SteadyWind
        mass_or_density::MassOrDensity;
    log:
        stream_offset::StreamOffset
        clock_skew::ClockSkew
        velocity_lag::VelocityLag
        command_dropout::CommandDropout
        gusts::Gusts
        imu_lever_arm::ImuLeverArm
        imu_misalignment::ImuMisalignment
        accel_scale::AccelScale
        gyro_scale::GyroScale
        accel_bias::AccelBias
        gyro_bias::GyroBias
        vibration_rectification::VibrationRectification;
}

/// Where the parameters of effect `index` of `cards` begin among those of all.
const fn offset(cards: &[&Card], index: usize) -> usize {
    let (mut sum, mut i) = (0, 0);
    while i < index {
        sum += cards[i].parameters.len();
        i += 1;
    }
    sum
}

/// How many parameters all effects of the simulator have together, and all others.
pub const COUNT: usize = offset(&MODEL, MODEL.len());
pub const LOG_COUNT: usize = offset(&LOG, LOG.len());

/// The card of this name.
pub fn card(id: &str) -> Option<&'static Card> {
    MODEL.iter().chain(&LOG).find(|card| card.id == id).copied()
}

/// Where the parameters of effect `id` are among those of [`MODEL`] followed by those of [`LOG`].
pub fn span(id: &str) -> Option<std::ops::Range<usize>> {
    let i = MODEL.iter().chain(&LOG).position(|card| card.id == id)?;
    let from = if i < MODEL.len() { offset(&MODEL, i) } else { COUNT + offset(&LOG, i - MODEL.len()) };
    Some(from..from + card(id)?.parameters.len())
}

/// The parameters of all effects of the simulator.
#[derive(Clone, Copy, Debug)]
pub struct EffectValues<R> {
    pub numbers: [R; COUNT],
    /// Bit i: effect i of [`MODEL`] is present. What is absent costs a test of its bit.
    active: u64,
}

impl EffectValues<f64> {
    /// Effects with a number that is not 0 are present.
    pub fn new(numbers: [f64; COUNT]) -> Self {
        let present = |i: usize| {
            let from = offset(&MODEL, i);
            numbers[from..from + MODEL[i].parameters.len()].iter().any(|k| *k != 0.0)
        };
        EffectValues { numbers, active: (0..MODEL.len()).filter(|&i| present(i)).fold(0, |all, i| all | 1 << i) }
    }
}

impl<R: Copy> EffectValues<R> {
    /// Whether any effect is present.
    #[inline(always)]
    pub fn any(&self) -> bool {
        self.active != 0
    }

    /// Whether the rates oscillate, and whether their change is limited.
    #[inline(always)]
    pub fn shapes(&self) -> (bool, bool) {
        let has = |i: Index| self.active & 1 << i as u32 != 0;
        (has(Index::RateSecondOrder), has(Index::RateSlewLimit))
    }

    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, f: impl FnMut(R) -> S) -> EffectValues<S> {
        EffectValues { numbers: self.numbers.map(f), active: self.active }
    }
}

impl<L: Lane> EffectValues<L> {
    /// Replaces the numbers of one lane; the block has every effect that one of its lanes has.
    pub fn set_lane(&mut self, lane: usize, new: &EffectValues<L::Elem>) {
        self.active |= new.active;
        self.numbers.iter_mut().zip(&new.numbers).for_each(|(own, &new)| own.set(lane, new));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn all() -> impl Iterator<Item = &'static Card> {
        MODEL.iter().chain(&LOG).copied()
    }

    #[test]
    fn names_are_unique_and_every_rival_is_one() {
        let ids: BTreeSet<_> = all().map(|card| card.id).collect();
        assert_eq!(ids.len(), MODEL.len() + LOG.len());
        for card in all() {
            let names: BTreeSet<_> = card.parameters.iter().map(|p| p.name).collect();
            assert_eq!(names.len(), card.parameters.len(), "{}", card.id);
            for rival in card.rivals {
                let other = super::card(rival).unwrap_or_else(|| panic!("{}: {rival} is no effect", card.id));
                assert!(rival != &card.id && other.rivals.contains(&card.id), "{} and {rival}", card.id);
            }
        }
    }

    #[test]
    fn the_pilot_can_fly_every_manoeuvre() {
        for card in all() {
            assert!(!card.manoeuvre.1.is_empty(), "{}", card.id);
            for kind in card.manoeuvre.1 {
                assert!(crate::flight::pilot::Manoeuvre::named(kind).is_some(), "{}: {kind}", card.id);
            }
        }
    }

    #[test]
    fn bounds_hold_absence_and_the_typical() {
        for card in all() {
            assert!(!card.parameters.is_empty() && !card.channels.is_empty(), "{}", card.id);
            for EffectParameter { name, low, high, typical: [least, most], .. } in card.parameters {
                assert!((*low..=*high).contains(&0.0), "{}.{name}", card.id);
                assert!(0.0 < *least && least < most && most <= high, "{}.{name}", card.id);
            }
        }
    }

    #[test]
    fn spans_are_side_by_side() {
        let mut end = 0;
        for card in all() {
            let span = span(card.id).expect("listed");
            assert_eq!((span.start, span.len()), (end, card.parameters.len()), "{}", card.id);
            end = span.end;
        }
        assert_eq!(end, COUNT + LOG_COUNT);
        assert!(span("nothing").is_none() && card("nothing").is_none());
    }

    #[test]
    fn sensors_read_as_their_equations_say() {
        let read = |id: &str, sizes: &[f64]| {
            let mut k = [0.0; LOG_COUNT];
            let span = span(id).expect("listed");
            k[span.start - COUNT..span.end - COUNT].copy_from_slice(sizes);
            let mut sensed =
                Sensed { rates: [1.0, 2.0, 3.0], acceleration: [0.0; 3], force: [0.0, 0.0, 10.0], throttle: 0.5 };
            sense(&k, &mut sensed);
            (sensed.rates, sensed.force)
        };
        assert_eq!(read("stream_offset", &[0.01]), ([1.0, 2.0, 3.0], [0.0, 0.0, 10.0]));
        // w x (w x r) of r = x: (w . r) w - w^2 r.
        assert_eq!(read("imu_lever_arm", &[1.0, 0.0, 0.0]).1, [1.0 - 14.0, 2.0, 10.0 + 3.0]);
        // r x f of r = x and f = z is -y.
        assert_eq!(read("imu_misalignment", &[0.1, 0.0, 0.0]), ([1.0, 2.0 - 0.1 * 3.0, 3.0 + 0.2], [0.0, -1.0, 10.0]));
        assert_eq!(read("accel_scale", &[0.5]).1, [0.0, 0.0, 15.0]);
        assert_eq!(read("accel_bias", &[0.5, 0.25, 1.0]).1, [0.5, 0.25, 11.0]);
        assert_eq!(read("gyro_scale", &[0.5]).0, [1.5, 3.0, 4.5]);
        assert_eq!(read("gyro_bias", &[0.5, 0.25, 1.0]).0, [1.5, 2.25, 4.0]);
        assert_eq!(read("vibration_rectification", &[4.0, 8.0, 12.0]).1, [1.0, 2.0, 13.0]);
    }
}
