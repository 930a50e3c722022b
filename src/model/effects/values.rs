//! Numbers of all effects of the simulator, and which of them are present.

use super::card::RateResponse;
use super::quantity::Quantity;
use super::{COUNT, Card, LOG, MODEL, offset};
use crate::base::lane::Lane;

/// The bits of the effects under which the rates follow in this way.
const SECOND_ORDER: u64 = bits(RateResponse::SecondOrder);
const LIMITED: u64 = bits(RateResponse::Limited);

const fn bits(response: RateResponse) -> u64 {
    let (mut all, mut i) = (0, 0);
    while i < MODEL.len() {
        if MODEL[i].response as u8 == response as u8 {
            all |= 1 << i;
        }
        i += 1;
    }
    all
}

/// The parameters of all effects of the simulator.
#[derive(Clone, Copy, Debug)]
pub struct EffectValues<R> {
    pub numbers: [R; COUNT],
    /// Bit i: effect i of [`MODEL`] is present. What is absent costs a test of its bit.
    pub(super) active: u64,
}

/// Bit i: effect i of `cards` has a number that is not 0.
fn active(cards: &[&Card], numbers: &[f64]) -> u64 {
    let present = |i: usize| {
        let from = offset(cards, i);
        numbers[from..from + cards[i].parameters.len()].iter().any(|k| *k != 0.0)
    };
    (0..cards.len()).filter(|&i| present(i)).fold(0, |all, i| all | 1 << i)
}

impl EffectValues<f64> {
    /// Effects with a number that is not 0 are present.
    pub fn new(numbers: [f64; COUNT]) -> Self {
        EffectValues { numbers, active: active(&MODEL, &numbers) }
    }
}

/// The parameters of all effects of [`LOG`], and which of these are present.
#[derive(Clone, Copy, Debug)]
pub struct SensorErrors<'a> {
    pub(super) numbers: &'a [f64],
    pub(super) active: u64,
}

impl<'a> SensorErrors<'a> {
    /// Effects with a number that is not 0 are present.
    pub fn new(numbers: &'a [f64]) -> Self {
        Self { numbers, active: active(&LOG, numbers) }
    }

    /// The same without what attitude and velocity show as well, which readings rightly integrate to.
    pub fn integrated(self) -> Self {
        let integrated = |i: &usize| LOG[*i].writes.contains(&Quantity::Integrated);
        Self { active: self.active & (0..LOG.len()).filter(integrated).fold(0, |all, i| all | 1 << i), ..self }
    }

    /// Whether any effect is present.
    pub fn any(&self) -> bool {
        self.active != 0
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
        (self.active & SECOND_ORDER != 0, self.active & LIMITED != 0)
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
