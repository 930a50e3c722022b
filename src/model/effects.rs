//! What the compact model can get wrong: optional effects, each an extension of the model whose parameters are 0 where
//! it is absent.
//!
//! One file is one effect: its card (names, parameters, what it reads and writes, rivals, manoeuvre) and its equation,
//! generic over [`Real`]. Simulator and diagnosis call the same equation at the same place of
//! [`crate::model::dynamics::extended`]. To add an effect, write its file and its line in the list below.

mod asked;
mod card;
mod dependence;
mod quantity;
mod stages;
mod values;

use crate::base::lane::Real;
pub use card::{
    Card, CompactNumber, ControllerPart, EffectKind, EffectParameter, Evidence, RateResponse, ResidualChannel, Role,
    Twin,
};
pub use dependence::Quantities;
pub use mixer_room::with_room;
pub use quantity::Quantity;
pub use rate_slew_limit::YAW_SLEW_SHARE;
pub use stages::{
    Actuator, AerodynamicForces, BatteryLoad, BodyRates, CommandDelay, CommandSetpoint, RelativeWind, Sensed,
    ThrustInput,
};
pub use values::{EffectValues, SensorErrors};

/// One effect. Every function may change what passes its stage, by the effect's parameters `k` in the order of the
/// card; those it does not write leave their stage alone.
pub trait Effect {
    const CARD: Card;
    /// When commands arrive.
    #[inline(always)]
    fn command_delay<R: Real>(_k: &[R], _delay: &mut CommandDelay<R>) {}
    /// Commands as they were sent, before the lag.
    #[inline(always)]
    fn setpoint<R: Real>(_k: &[R], _setpoint: &mut CommandSetpoint<R>) {}
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
            command_delay CommandDelay, setpoint CommandSetpoint, actuator Actuator, body_rates BodyRates,
            battery_load BatteryLoad, thrust_input ThrustInput, relative_wind RelativeWind,
            aerodynamic_forces AerodynamicForces,);

        impl SensorErrors<'_> {
            /// Every sensor's effect on a reading.
            #[inline(always)]
            pub fn sense(&self, sensed: &mut Sensed) {
                $(
                    if self.active & 1 << LogIndex::$Log as u32 != 0 {
                        const AT: usize = offset(&LOG, LogIndex::$Log as usize);
                        const N: usize = $log::$Log::CARD.parameters.len();
                        $log::$Log::sense(&self.numbers[AT..AT + N], sensed);
                    }
                )*
            }
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
        link_delay::LinkDelay
        rate_second_order::RateSecondOrder
        yaw_second_order::YawSecondOrder
        rate_slew_limit::RateSlewLimit
        yaw_slew_limit::YawSlewLimit
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
        mixer_room::MixerRoom
        voltage_compensation::VoltageCompensation
        throttle_offset::ThrottleOffset
        mixer_thrust_loss::MixerThrustLoss
        thrust_fade::ThrustFade
        ground_effect::GroundEffect
        propwash::Propwash
        axial_inflow::AxialInflow
        translational_lift::TranslationalLift
        rate_thrust_coupling::RateThrustCoupling
        axis_drag::AxisDrag
        rotor_drag::RotorDrag
        drag_asymmetry::DragAsymmetry
        body_lift::BodyLift
        vertical_drag::VerticalDrag
        steady_wind::SteadyWind
        mass_or_density::MassOrDensity;
    log:
        stream_offset::StreamOffset
        imu_late::ImuLate
        odometry_late::OdometryLate
        clock_skew::ClockSkew
        velocity_lag::VelocityLag
        command_dropout::CommandDropout
        gusts::Gusts
        imu_lever_arm::ImuLeverArm
        com_offset::ComOffset
        imu_misalignment::ImuMisalignment
        accel_misalignment::AccelMisalignment
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
    cards().find(|card| card.id == id)
}

/// Where the parameters of effect `id` are among those of [`MODEL`] followed by those of [`LOG`].
pub fn span(id: &str) -> Option<std::ops::Range<usize>> {
    let i = cards().position(|card| card.id == id)?;
    let from = if i < MODEL.len() { offset(&MODEL, i) } else { COUNT + offset(&LOG, i - MODEL.len()) };
    Some(from..from + card(id)?.parameters.len())
}

/// Every effect, those of the simulator first.
pub fn cards() -> impl Iterator<Item = &'static Card> {
    MODEL.into_iter().chain(LOG)
}

/// The effects that act on a log in this way.
pub fn acting(role: Role) -> impl Iterator<Item = &'static Card> {
    cards().filter(move |card| card.role == role)
}

/// The effect that is this part of a flight controller's answer.
pub fn of_controller(part: ControllerPart) -> Option<&'static Card> {
    cards().find(|card| card.controller == Some(part))
}

/// Whether two effects look alike: one of them says so.
pub fn are_rivals(a: &Card, b: &Card) -> bool {
    a.rivals.contains(&b.id) || b.rivals.contains(&a.id)
}

/// Identifiers of the effects that look like this one: those that it names, then those that name it.
pub fn rivals(card: &Card) -> Vec<&'static str> {
    let others = cards().filter(|other| other.rivals.contains(&card.id) && !card.rivals.contains(&other.id));
    card.rivals.iter().copied().chain(others.map(|other| other.id)).collect()
}

/// Pairs of effects of the same mean that this evidence tells apart: the one whose card says so, and the other.
pub fn twins(told_by: Evidence) -> impl Iterator<Item = (&'static Card, &'static Card)> {
    cards().filter_map(move |card| Some((card, self::card(card.twin.filter(|t| t.told_by == told_by)?.effect)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_every_rival_is_one() {
        let ids: BTreeSet<_> = cards().map(|card| card.id).collect();
        assert_eq!(ids.len(), MODEL.len() + LOG.len());
        for card in cards() {
            let names: BTreeSet<_> = card.parameters.iter().map(|p| p.name).collect();
            assert_eq!(names.len(), card.parameters.len(), "{}", card.id);
            for rival in card.rivals {
                let other = super::card(rival).unwrap_or_else(|| panic!("{}: {rival} is no effect", card.id));
                assert!(rival != &card.id && are_rivals(card, other) && rivals(other).contains(&card.id), "{rival}");
            }
        }
    }

    #[test]
    fn the_pilot_can_fly_every_manoeuvre() {
        for card in cards() {
            assert!(!card.manoeuvre.1.is_empty(), "{}", card.id);
            for kind in card.manoeuvre.1 {
                assert!(crate::flight::pilot::Manoeuvre::named(kind).is_some(), "{}: {kind}", card.id);
            }
        }
    }

    #[test]
    fn bounds_hold_absence_and_the_typical() {
        for card in cards() {
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
        for card in cards() {
            let span = span(card.id).expect("listed");
            assert_eq!((span.start, span.len()), (end, card.parameters.len()), "{}", card.id);
            end = span.end;
        }
        assert_eq!(end, COUNT + LOG_COUNT);
        assert!(span("nothing").is_none() && card("nothing").is_none());
    }
}
