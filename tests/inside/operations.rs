//! The operations that `racer bench` holds against the machine's peak, counted by flying a block whose arithmetic
//! counts itself.

use racer::base::lane::{Bits, LANES, Lane, Lane32, Mask, Portable, Real, Single, Tiled, Word, math};
use racer::learn::ppo::Environment;
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Factors, Parameters, State, step};
use racer::present::bench::{ENVIRONMENT_OPERATIONS, PHYSICS_OPERATIONS};
use racer::race::config::{DEFAULT, Setup};
use racer::race::env::Race;
use std::cell::Cell;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

thread_local!(static COUNT: Cell<usize> = const { Cell::new(0) });

fn count<T>(operations: usize, value: T) -> T {
    COUNT.set(COUNT.get() + operations);
    value
}

/// Operations of `work`.
fn counted(work: impl FnOnce()) -> usize {
    COUNT.set(0);
    work();
    COUNT.get()
}

type F = Portable<f32>;
type U = Portable<u32>;

#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
struct Counted(F);
#[derive(Clone, Copy, Debug)]
struct CountedMask(<F as Real>::Mask);
#[derive(Clone, Copy)]
struct CountedBits(U);

macro_rules! binary {
    ($($t:ident $trait:ident $f:ident),*) => {
        $(impl $trait for $t {
            type Output = Self;
            fn $f(self, b: Self) -> Self {
                count(1, Self(self.0.$f(b.0)))
            }
        })*
    };
}
binary!(Counted Add add, Counted Sub sub, Counted Mul mul, Counted Div div, CountedMask BitAnd bitand);
binary!(CountedMask BitOr bitor, CountedBits BitXor bitxor, CountedBits BitAnd bitand);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        count(1, Self(-self.0))
    }
}
impl Not for CountedMask {
    type Output = Self;
    fn not(self) -> Self {
        count(1, Self(!self.0))
    }
}
impl Mask for CountedMask {
    fn bits(self) -> u32 {
        count(1, self.0.bits())
    }
    fn from_bits(bits: u32) -> Self {
        count(1, Self(Mask::from_bits(bits)))
    }
}

impl Real for Counted {
    type Mask = CountedMask;
    const FUSES: bool = false;
    fn of(x: f64) -> Self {
        Self(F::of(x))
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        count(1, Self(self.0.mul_add(a.0, b.0)))
    }
    fn sqrt(self) -> Self {
        count(1, Self(self.0.sqrt()))
    }
    fn abs(self) -> Self {
        count(1, Self(self.0.abs()))
    }
    fn min(self, b: Self) -> Self {
        count(1, Self(self.0.min(b.0)))
    }
    fn max(self, b: Self) -> Self {
        count(1, Self(self.0.max(b.0)))
    }
    fn lt(self, b: Self) -> CountedMask {
        count(1, CountedMask(self.0.lt(b.0)))
    }
    fn le(self, b: Self) -> CountedMask {
        count(1, CountedMask(self.0.le(b.0)))
    }
    fn select(mask: CountedMask, yes: Self, no: Self) -> Self {
        count(1, Self(F::select(mask.0, yes.0, no.0)))
    }
    fn exp(self) -> Self {
        math::exp(self)
    }
    fn ln(self) -> Self {
        math::ln(self)
    }
    fn tanh(self) -> Self {
        math::tanh(self)
    }
    fn tanh_pair(pair: [Self; 2]) -> [Self; 2] {
        math::tanh_pair(pair)
    }
    fn sin_cos_turns(self) -> (Self, Self) {
        math::sin_cos_turns(self)
    }
}

impl Single for Counted {
    fn round(self) -> Self {
        count(1, Self(self.0.round()))
    }
    fn pow2(self) -> Self {
        count(1, Self(self.0.pow2()))
    }
    fn split_exponent(self) -> (Self, Self) {
        let (m, e) = self.0.split_exponent();
        count(2, (Self(m), Self(e)))
    }
}

impl Lane for Counted {
    type Elem = f32;
    fn tiled<T: Tiled>(work: T) {
        F::tiled(work)
    }
    fn splat(x: f32) -> Self {
        Self(F::splat(x))
    }
    fn from_array(x: [f32; LANES]) -> Self {
        Self(F::from_array(x))
    }
    fn to_array(self) -> [f32; LANES] {
        self.0.to_array()
    }
    unsafe fn load(p: *const f32) -> Self {
        // SAFETY: promised by the caller.
        Self(unsafe { F::load(p) })
    }
    unsafe fn store(self, p: *mut f32) {
        // SAFETY: promised by the caller.
        unsafe { self.0.store(p) }
    }
    fn transpose(_rows: &mut [Self; LANES]) {
        unimplemented!("the environment transposes nothing")
    }
}

impl Lane32 for Counted {
    type Bits = CountedBits;
    fn from_bits(bits: CountedBits) -> Self {
        count(1, Self(F::from_bits(bits.0)))
    }
    fn bf16_pairs(first: Self, second: Self) -> Self {
        Self(F::bf16_pairs(first.0, second.0))
    }
}

impl Word for CountedBits {
    fn splat(x: u32) -> Self {
        Self(U::splat(x))
    }
    fn mul_wide(self, x: u32) -> (Self, Self) {
        let (high, low) = self.0.mul_wide(x);
        count(2, (Self(high), Self(low)))
    }
    fn shift_right<const N: u32>(self) -> Self {
        count(1, Self(self.0.shift_right::<N>()))
    }
}
impl Bits for CountedBits {
    fn from_array(x: [u32; LANES]) -> Self {
        Self(U::from_array(x))
    }
    fn to_array(self) -> [u32; LANES] {
        self.0.to_array()
    }
}

fn race() -> Race {
    let Setup { config, track, vehicle } = Setup::load(DEFAULT, &[]).expect("built in");
    Race::new(&config.env, &track, &vehicle, 1)
}

#[test]
fn physics_has_as_many_operations_as_the_benchmark_says() {
    let race = race();
    let p = Parameters::new(&race.vehicle, &Factors::NOMINAL, CONTROL_S).map(Counted::of);
    let mut s = State::new([0.0; 3], [5.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0; 4], 23.0).map(Counted::of);
    let operations = counted(|| step(&mut s, &p, [0.1, -0.1, 0.0, 0.2].map(Counted::of)));
    assert_eq!(operations as f64, PHYSICS_OPERATIONS);
}

/// Of a step in which nobody passes a gate and nobody begins anew, as nearly all are.
#[test]
fn the_environment_has_as_many_operations_as_the_benchmark_says() {
    let race = race();
    let mut block = race.load::<Counted>(&race.start(0));
    let mut seen = vec![0.0; race.observations() * LANES];
    let action = [0.0, 0.0, 0.0, race.hover_command].map(Counted::of);
    let operations = counted(|| {
        block.observe(&race, &mut seen, LANES);
        block.step(&race, action);
    });
    assert_eq!(operations as f64, ENVIRONMENT_OPERATIONS);
}
