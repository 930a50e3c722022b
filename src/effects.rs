//! What the compact model can get wrong: optional effects, each an extension of the model whose parameters are 0 where it is absent.
//!
//! One file is one effect: its card (names, parameters, signature, rivals, manoeuvre) and its equation, generic over
//! [`Real`]. Simulator and diagnosis call the same equation at the same place of [`crate::dynamics::extended`]. To add an effect, write its file
//! and its line in the list below.

mod stages;

use crate::lane::{Lane, Real};
pub use stages::{Air, Asked, Cell, Flow, Lag, Late, Sensed, Spin, Supply};

/// What a person and the diagnosis have to know about an effect.
#[derive(Debug)]
pub struct Card {
    /// What the program prints, writes and reads, such as `axial_inflow`.
    pub id: &'static str,
    /// The field's name for it.
    pub name: &'static str,
    /// What it means to a pilot, in one sentence.
    pub sentence: &'static str,
    pub kind: Kind,
    /// All are 0 where the effect is absent.
    pub parameters: &'static [Parameter],
    /// Channels of the residual that it can show in.
    pub channels: &'static [Channel],
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
pub struct Parameter {
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
pub enum Kind {
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
pub enum Channel {
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
    fn late<R: Real>(_k: &[R], _late: &mut Late<R>) {}
    /// Commands as they were sent, before the lag.
    #[inline(always)]
    fn ask<R: Real>(_k: &[R], _asked: &mut Asked<R>) {}
    /// How rates and thrust follow.
    #[inline(always)]
    fn lag<R: Real>(_k: &[R], _lag: &mut Lag<R>) {}
    /// From filtered commands to body rates.
    #[inline(always)]
    fn spin<R: Real>(_k: &[R], _spin: &mut Spin<R>) {}
    /// What the load takes from the voltage.
    #[inline(always)]
    fn cell<R: Real>(_k: &[R], _cell: &mut Cell<R>) {}
    /// What reaches the thrust curve.
    #[inline(always)]
    fn supply<R: Real>(_k: &[R], _supply: &mut Supply<R>) {}
    /// The air's own motion.
    #[inline(always)]
    fn air<R: Real>(_k: &[R], _air: &mut Air<R>) {}
    /// Thrust and drag.
    #[inline(always)]
    fn flow<R: Real>(_k: &[R], _flow: &mut Flow<R>) {}
    /// What the sensors make of the truth.
    fn sense(_k: &[f64], _sensed: &mut Sensed) {}
}

macro_rules! effects {
    (model: $($model:ident)*; log: $($log:ident)*;) => {
        $(mod $model;)*
        $(mod $log;)*
        /// Cards of the effects that extend the simulator.
        pub const MODEL: [&Card; [$(stringify!($model)),*].len()] = [$(&$model::It::CARD),*];
        /// Cards of the effects of sensors and of chance, which are no dynamics.
        pub const LOG: [&Card; [$(stringify!($log)),*].len()] = [$(&$log::It::CARD),*];

        #[allow(non_camel_case_types, clippy::enum_variant_names)]
        enum Index { $($model),* }
        #[allow(non_camel_case_types, clippy::enum_variant_names)]
        enum LogIndex { $($log),* }

        effects!(@stage $($model)*; late Late, ask Asked, lag Lag, spin Spin, cell Cell, supply Supply, air Air, flow Flow,);

        /// Every sensor's effect on a reading; `k` holds the parameters of all of [`LOG`].
        pub fn sense(k: &[f64], sensed: &mut Sensed) {
            $({
                const AT: usize = offset(&LOG, LogIndex::$log as usize);
                const N: usize = $log::It::CARD.parameters.len();
                $log::It::sense(&k[AT..AT + N], sensed);
            })*
        }
    };
    (@stage $($model:ident)*; ) => {};
    (@stage $($model:ident)*; $stage:ident $flow:ident, $($rest:tt)*) => {
        #[doc = concat!("Stage `", stringify!($stage), "` of every effect that is present.")]
        #[inline(always)]
        pub fn $stage<R: Real>(values: &Values<R>, flow: &mut $flow<R>) {
            $(
                if values.active & 1 << Index::$model as u32 != 0 {
                    const AT: usize = offset(&MODEL, Index::$model as usize);
                    const N: usize = $model::It::CARD.parameters.len();
                    let k: [R; N] = crate::lane::build!(|i| values.numbers[AT + i]);
                    $model::It::$stage(&k, flow);
                }
            )*
        }
        effects!(@stage $($model)*; $($rest)*);
    };
}

effects! {
    model:
        rate_delay thrust_delay rate_second_order rate_slew_limit
        axial_inflow;
    log:
        imu_lever_arm;
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
pub struct Values<R> {
    pub numbers: [R; COUNT],
    /// Bit i: effect i of [`MODEL`] is present. What is absent costs a test of its bit.
    active: u64,
}

impl Values<f64> {
    /// Effects with a number that is not 0 are present.
    pub fn new(numbers: [f64; COUNT]) -> Self {
        let present = |i: usize| {
            let from = offset(&MODEL, i);
            numbers[from..from + MODEL[i].parameters.len()].iter().any(|k| *k != 0.0)
        };
        Values { numbers, active: (0..MODEL.len()).filter(|&i| present(i)).fold(0, |all, i| all | 1 << i) }
    }
}

impl<R: Copy> Values<R> {
    /// Whether any effect is present.
    #[inline(always)]
    pub fn any(&self) -> bool {
        self.active != 0
    }

    /// Whether the rates oscillate, and whether their change is limited.
    #[inline(always)]
    pub fn shapes(&self) -> (bool, bool) {
        let has = |i: Index| self.active & 1 << i as u32 != 0;
        (has(Index::rate_second_order), has(Index::rate_slew_limit))
    }

    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, f: impl FnMut(R) -> S) -> Values<S> {
        Values { numbers: self.numbers.map(f), active: self.active }
    }
}

impl<L: Lane> Values<L> {
    /// Replaces the numbers of one lane; the block has every effect that one of its lanes has.
    pub fn set_lane(&mut self, lane: usize, new: &Values<L::Elem>) {
        self.active |= new.active;
        self.numbers.iter_mut().zip(&new.numbers).for_each(|(own, &new)| own.set(lane, new));
    }
}
