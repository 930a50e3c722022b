//! Numbers the equations are written in: one scalar, or a block of 16 lanes.
//!
//! Every equation of the crate is written once, generic over [`Real`], and runs as `f64` (identification, tests), `f32`
//! (replay) and as a 16-lane block (simulator, network). Blocks come in one width and several implementations; which
//! one runs is decided once, at run time, by [`dispatch`]. A block type never leaves its `dispatch`, so code for a CPU
//! that is not there cannot be reached.
//!
//! Everything called inside a [`Kernel`] must be `#[inline(always)]`, or wrapped in [`Real::vectorize`]: a function
//! that is compiled on its own does not know which instructions it may use.

pub mod bf16;
mod block;
mod level;
pub mod math;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;
mod scalar;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::fmt;
use std::mem::MaybeUninit;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

pub use level::{Kernel, Level, dispatch, fused};
pub use portable::Portable;

/// Lanes in a block, on every CPU, so that results do not depend on the vector length.
pub const LANES: usize = 16;
/// Numbers in a row of a product in [`bf16`].
pub const COLUMNS: usize = 4 * LANES;

/// `[f(0), f(1), ..]`, as [`std::array::from_fn`], but inlined: a closure over blocks that is called as a function of
/// its own passes them through memory and does not know which instructions it may use.
#[inline(always)]
pub fn build_with<T: Copy, const N: usize>(mut f: impl FnMut(usize) -> T) -> [T; N] {
    let mut all = [const { MaybeUninit::uninit() }; N];
    // One call only: the compiler inlines a closure that is called in one place, whatever its size.
    for (i, one) in all.iter_mut().enumerate() {
        one.write(f(i));
    }
    // SAFETY: the loop has written every element.
    unsafe { (&raw const all).cast::<[T; N]>().read() }
}

/// `[f(a[0]), f(a[1]), ..]`, as the array's own `map`, but inlined.
#[inline(always)]
pub fn each_with<A: Copy, T: Copy, const N: usize>(a: [A; N], mut f: impl FnMut(A) -> T) -> [T; N] {
    build_with(
        #[inline(always)]
        |i| f(a[i]),
    )
}

/// [`build_with`] and a closure that is inlined wherever it is used: `build!(|i| a[i] + b[i])`.
macro_rules! build {
    (|$i:pat_param| $body:expr) => {
        $crate::base::lane::build_with(
            #[inline(always)]
            |$i| $body,
        )
    };
}
pub(crate) use build;

/// The array of a function of each element, inlined: `each!(a, |x| x * scale)`.
macro_rules! each {
    ($array:expr, |$x:pat_param| $body:expr) => {{
        $crate::base::lane::each_with(
            $array,
            #[inline(always)]
            |$x| $body,
        )
    }};
}
pub(crate) use each;

/// x0^2 + x1^2 + ..
#[inline(always)]
pub fn sum_of_squares<R: Real, const N: usize>(x: [R; N]) -> R {
    let mut sum = x[0] * x[0];
    for &x in &x[1..] {
        sum = x.mul_add(x, sum);
    }
    sum
}

/// A truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Bit `i` is lane `i`; a scalar is lane 0.
    fn bits(self) -> u32;
    /// The inverse of [`Mask::bits`]; higher bits are ignored.
    fn from_bits(bits: u32) -> Self;
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

/// A real number, or 16 of them: the arithmetic that equations use.
pub trait Real:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    type Mask: Mask;
    /// Whether [`Real::mul_add`] rounds once. Implementations of one precision that fuse agree bit for bit.
    const FUSES: bool;

    /// The constant `x`, rounded to this precision.
    fn of(x: f64) -> Self;
    /// `self * a + b`.
    fn mul_add(self, a: Self, b: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The smaller of two; `b` where either is not a number.
    fn min(self, b: Self) -> Self;
    /// The larger of two; `b` where either is not a number.
    fn max(self, b: Self) -> Self;
    fn lt(self, b: Self) -> Self::Mask;
    fn le(self, b: Self) -> Self::Mask;
    /// `yes` where `mask`, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Natural exponential; relative error below 3e-7 in single precision over -87..88, clamped outside.
    fn exp(self) -> Self;
    /// Natural logarithm of a positive normal number; absolute error below 4e-7 near 1, else relative.
    fn ln(self) -> Self;
    /// Hyperbolic tangent; relative error below 2e-6 in single precision, never outside [-1, 1].
    fn tanh(self) -> Self;
    /// Two hyperbolic tangents for less than twice the price of one, with the same bounds.
    fn tanh_pair(pair: [Self; 2]) -> [Self; 2];
    /// `(sin(2 pi x), cos(2 pi x))` of `x` in turns; absolute error below 2e-7 in single precision.
    fn sin_cos_turns(self) -> (Self, Self);

    /// Runs `f` compiled for this number's instructions, as a function of its own.
    #[inline(always)]
    fn vectorize<T>(f: impl FnOnce() -> T) -> T {
        f()
    }

    #[inline(always)]
    fn zero() -> Self {
        Self::of(0.0)
    }
    #[inline(always)]
    fn one() -> Self {
        Self::of(1.0)
    }
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
    /// Whether the number is neither infinite nor NaN.
    #[inline(always)]
    fn is_finite(self) -> Self::Mask {
        self.abs().le(Self::of(f32::MAX as f64))
    }
}

/// The bit-level operations behind the single-precision functions of [`math`].
pub trait Single: Real {
    /// Nearest integer, ties to even.
    fn round(self) -> Self;
    /// `2^self` for a whole number in -126..=127.
    fn pow2(self) -> Self;
    /// `(m, e)` with `self = m 2^e`, `m` in [0.5, 1), for a positive normal number.
    fn split_exponent(self) -> (Self, Self);
}

/// A block of [`LANES`] numbers.
pub trait Lane: Real {
    /// The number in each lane.
    type Elem: Real<Mask = bool> + PartialOrd + Default + fmt::Debug;
    /// Runs `work` with the tile that this CPU's registers hold. A call and not a constant, so that other tiles are
    /// never compiled.
    fn tiled<T: Tiled>(work: T);

    fn splat(x: Self::Elem) -> Self;
    fn from_array(x: [Self::Elem; LANES]) -> Self;
    fn to_array(self) -> [Self::Elem; LANES];
    /// # Safety
    /// `p` must be valid for reading [`LANES`] elements; no alignment is needed.
    unsafe fn load(p: *const Self::Elem) -> Self;
    /// # Safety
    /// `p` must be valid for writing [`LANES`] elements; no alignment is needed.
    unsafe fn store(self, p: *mut Self::Elem);
    /// Transposes a 16 x 16 block: lane `i` of row `j` becomes lane `j` of row `i`.
    fn transpose(rows: &mut [Self; LANES]);
    /// Lane `i` of the answer is `rows[i].sum()`.
    #[inline(always)]
    fn row_sums(mut rows: [Self; LANES]) -> Self {
        Self::transpose(&mut rows);
        let mut half = LANES / 2;
        while half > 0 {
            for i in 0..half {
                rows[i] = rows[i] + rows[i + half];
            }
            half /= 2;
        }
        rows[0]
    }
    /// The number in lane `i`.
    #[inline(always)]
    fn get(&self, i: usize) -> Self::Elem {
        const { assert!(size_of::<Self>() == LANES * size_of::<Self::Elem>()) }
        assert!(i < LANES);
        // SAFETY: a block is its lanes in order, as the size shows and the tests check, and `i` is one of them.
        unsafe { (self as *const Self).cast::<Self::Elem>().add(i).read() }
    }
    /// Replaces the number in lane `i`.
    #[inline(always)]
    fn set(&mut self, i: usize, x: Self::Elem) {
        const { assert!(size_of::<Self>() == LANES * size_of::<Self::Elem>()) }
        assert!(i < LANES);
        // SAFETY: as in `get`.
        unsafe { (self as *mut Self).cast::<Self::Elem>().add(i).write(x) }
    }
    /// Sum over the lanes, always in the same order.
    #[inline(always)]
    fn sum(self) -> Self::Elem {
        let mut x = self.to_array();
        let mut half = LANES / 2;
        while half > 0 {
            for i in 0..half {
                x[i] = x[i] + x[i + half];
            }
            half /= 2;
        }
        x[0]
    }
    #[inline(always)]
    fn from_slice(x: &[Self::Elem]) -> Self {
        assert!(x.len() >= LANES);
        // SAFETY: the length was checked.
        unsafe { Self::load(x.as_ptr()) }
    }
    #[inline(always)]
    fn write(self, x: &mut [Self::Elem]) {
        assert!(x.len() >= LANES);
        // SAFETY: the length was checked.
        unsafe { self.store(x.as_mut_ptr()) }
    }
}

/// Replaces the numbers in one lane of each block.
#[inline(always)]
pub fn set_lanes<L: Lane>(own: &mut [L], lane: usize, new: &[L::Elem]) {
    for (own, &new) in own.iter_mut().zip(new) {
        own.set(lane, new);
    }
}

/// Work of the matrix micro-kernel on register tiles of ROWS rows and BLOCKS 16-lane columns.
pub trait Tiled {
    /// The body; mark it `#[inline(always)]`.
    fn run<const ROWS: usize, const BLOCKS: usize>(self);
}

/// A block of `f32`: what the simulator and the network run on.
pub trait Lane32: Lane<Elem = f32> + Single {
    type Bits: Bits;
    /// `bits` as a number, exact below 2^24.
    fn from_bits(bits: Self::Bits) -> Self;
    /// The bits of [`bf16::pair`] of every lane: a block to be stored, no numbers.
    fn bf16_pairs(first: Self, second: Self) -> Self;

    /// Whether the CPU has [`Lane32::dot`] for this block.
    #[inline(always)]
    fn has_dot() -> bool {
        false
    }
    /// [`Real::vectorize`] where [`Lane32::dot`] and [`Lane32::dot_pairs`] may be called: only if it has them.
    #[inline(always)]
    fn vectorize_dot<X>(f: impl FnOnce() -> X) -> X {
        f()
    }
    /// The sum of this and of both products of pairs, as [`bf16`]'s `Avx512` unit makes it.
    #[inline(always)]
    fn dot(self, _a: Self, _b: Self) -> Self {
        unreachable!("this block has no products of pairs")
    }
    /// [`Lane32::bf16_pairs`] by instructions that take what is below the normal numbers as zero, as `dot` does.
    #[inline(always)]
    fn dot_pairs(first: Self, second: Self) -> Self {
        Self::bf16_pairs(first, second)
    }
}

/// An unsigned 32-bit integer, or 16 of them: what random numbers are made of.
pub trait Word: Copy + BitXor<Output = Self> + BitAnd<Output = Self> {
    fn splat(x: u32) -> Self;
    /// `(high, low)` halves of the 64-bit product.
    fn mul_wide(self, x: u32) -> (Self, Self);
    fn shift_right<const N: u32>(self) -> Self;
}

/// A block of [`LANES`] words.
pub trait Bits: Word {
    fn from_array(x: [u32; LANES]) -> Self;
    #[cfg_attr(not(feature = "internals"), allow(dead_code))]
    fn to_array(self) -> [u32; LANES];
}

impl Word for u32 {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        x
    }
    #[inline(always)]
    fn mul_wide(self, x: u32) -> (Self, Self) {
        let wide = self as u64 * x as u64;
        ((wide >> 32) as u32, wide as u32)
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        self >> N
    }
}
