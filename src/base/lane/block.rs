//! A block in the registers of a CPU: all of its traits, from a table of what one register can do.
//!
//! Soundness: blocks are private to `lane` and are reached only through [`super::dispatch`], which has checked the CPU;
//! so the instructions they use exist wherever they do.

/// The array of a function of each register, written out: a loop would have to be unrolled in thousands of places.
macro_rules! registers {
    (1, $f:ident, $($a:expr),*) => { [$f($($a[0]),*)] };
    (2, $f:ident, $($a:expr),*) => { [$f($($a[0]),*), $f($($a[1]),*)] };
    (4, $f:ident, $($a:expr),*) => { [$f($($a[0]),*), $f($($a[1]),*), $f($($a[2]),*), $f($($a[3]),*)] };
}
pub(super) use registers;

/// Functions of registers, each an instruction or a few.
macro_rules! operations {
    ($($name:ident $(<const $n:ident>)? ($($arg:ident: $t:ty),*) -> $out:ty = $body:expr;)*) => {
        $(
            #[inline(always)]
            fn $name $(<const $n: u32>)? ($($arg: $t),*) -> $out {
                // SAFETY: see `lane/block.rs`; of pointers, what the caller promises.
                #[allow(unused_unsafe)]
                unsafe { $body }
            }
        )*
    };
}
pub(super) use operations;

/// `impl Trait for Type` of an operator on two blocks.
macro_rules! operator {
    ($n:tt, $t:ty, $trait:ident, $method:ident, $f:ident) => {
        impl std::ops::$trait for $t {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                Self($crate::base::lane::block::registers!($n, $f, self.0, b.0))
            }
        }
    };
}
pub(super) use operator;

/// Block, words and truth values of `$n` registers, out of the operations in scope: on numbers `R`, truth values `T`
/// and words `W`.
macro_rules! block {
    ($block:ident, $words:ident, $truth:ident, $n:tt registers, fuses: $fuses:literal,
     tile: $rows:literal x $blocks:literal, features: $features:literal $(, dot: $dot:literal if $has_dot:path)?) => {
        use $crate::base::lane::block::{operator, registers};
        use $crate::base::lane::{Bits, Lane, Lane32, Mask, Real, Single, Tiled, Word, math};

        /// Lanes of a register.
        const WIDTH: usize = LANES / $n;

        /// Numbers.
        #[derive(Clone, Copy)]
        pub struct $block([R; $n]);
        /// Words of 32 bits.
        #[derive(Clone, Copy)]
        pub struct $words([W; $n]);
        /// Truth values.
        #[derive(Clone, Copy)]
        pub struct $truth([T; $n]);

        operator!($n, $block, Add, add, add);
        operator!($n, $block, Sub, sub, sub);
        operator!($n, $block, Mul, mul, mul);
        operator!($n, $block, Div, div, div);
        operator!($n, $words, BitXor, bitxor, word_xor);
        operator!($n, $words, BitAnd, bitand, word_and);
        operator!($n, $truth, BitAnd, bitand, truth_and);
        operator!($n, $truth, BitOr, bitor, truth_or);

        impl std::ops::Neg for $block {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(registers!($n, neg, self.0))
            }
        }

        impl std::ops::Not for $truth {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(registers!($n, truth_not, self.0))
            }
        }

        impl Mask for $truth {
            #[inline(always)]
            fn bits(self) -> u32 {
                let parts: [u32; $n] = registers!($n, truth_bits, self.0);
                let mut all = 0;
                for (i, part) in parts.into_iter().enumerate() {
                    all |= part << (WIDTH * i);
                }
                all
            }
            #[inline(always)]
            fn from_bits(bits: u32) -> Self {
                let parts: [u32; 4] = [bits, bits >> WIDTH % 32, bits >> (2 * WIDTH) % 32, bits >> (3 * WIDTH) % 32];
                Self(registers!($n, truth_of, parts))
            }
        }

        impl Real for $block {
            type Mask = $truth;
            const FUSES: bool = $fuses;
            #[inline(always)]
            fn vectorize<X>(f: impl FnOnce() -> X) -> X {
                #[inline(never)]
                #[target_feature(enable = $features)]
                fn inner<X>(f: impl FnOnce() -> X) -> X {
                    f()
                }
                // SAFETY: see `lane/block.rs`.
                #[allow(unused_unsafe)]
                unsafe {
                    inner(f)
                }
            }
            #[inline(always)]
            fn of(x: f64) -> Self {
                Self([splat(x as f32); $n])
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                Self(registers!($n, mul_add, self.0, a.0, b.0))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(registers!($n, sqrt, self.0))
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(registers!($n, abs, self.0))
            }
            #[inline(always)]
            fn min(self, b: Self) -> Self {
                Self(registers!($n, min, self.0, b.0))
            }
            #[inline(always)]
            fn max(self, b: Self) -> Self {
                Self(registers!($n, max, self.0, b.0))
            }
            #[inline(always)]
            fn lt(self, b: Self) -> $truth {
                $truth(registers!($n, lt, self.0, b.0))
            }
            #[inline(always)]
            fn le(self, b: Self) -> $truth {
                $truth(registers!($n, le, self.0, b.0))
            }
            #[inline(always)]
            fn select(mask: $truth, yes: Self, no: Self) -> Self {
                Self(registers!($n, select, mask.0, yes.0, no.0))
            }
            #[inline(always)]
            fn exp(self) -> Self {
                math::exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                math::ln(self)
            }
            #[inline(always)]
            fn tanh(self) -> Self {
                math::tanh(self)
            }
            #[inline(always)]
            fn tanh_pair(pair: [Self; 2]) -> [Self; 2] {
                math::tanh_pair(pair)
            }
            #[inline(always)]
            fn sin_cos_turns(self) -> (Self, Self) {
                math::sin_cos_turns(self)
            }
        }

        impl Single for $block {
            #[inline(always)]
            fn round(self) -> Self {
                Self(registers!($n, round, self.0))
            }
            #[inline(always)]
            fn pow2(self) -> Self {
                Self(registers!($n, pow2, self.0))
            }
            #[inline(always)]
            fn split_exponent(self) -> (Self, Self) {
                (Self(registers!($n, mantissa, self.0)), Self(registers!($n, exponent, self.0)))
            }
        }

        impl Lane for $block {
            type Elem = f32;
            #[inline(always)]
            fn tiled<X: Tiled>(work: X) {
                work.run::<$rows, $blocks>()
            }
            #[inline(always)]
            fn splat(x: f32) -> Self {
                Self::of(x as f64)
            }
            #[inline(always)]
            fn from_array(x: [f32; LANES]) -> Self {
                // SAFETY: the array has the length of a block.
                unsafe { Self::load(x.as_ptr()) }
            }
            #[inline(always)]
            fn to_array(self) -> [f32; LANES] {
                let mut x = [0.0; LANES];
                // SAFETY: the array has the length of a block.
                unsafe { self.store(x.as_mut_ptr()) };
                x
            }
            #[inline(always)]
            unsafe fn load(p: *const f32) -> Self {
                let at = [p, p.wrapping_add(WIDTH), p.wrapping_add(2 * WIDTH), p.wrapping_add(3 * WIDTH)];
                Self(registers!($n, load, at))
            }
            #[inline(always)]
            unsafe fn store(self, p: *mut f32) {
                let at = [p, p.wrapping_add(WIDTH), p.wrapping_add(2 * WIDTH), p.wrapping_add(3 * WIDTH)];
                let _: [(); $n] = registers!($n, store, self.0, at);
            }
            #[inline(always)]
            fn transpose(rows: &mut [Self; LANES]) {
                transpose(rows)
            }
            #[inline(always)]
            fn row_sums(rows: [Self; LANES]) -> Self {
                row_sums(rows)
            }
        }

        impl Lane32 for $block {
            type Bits = $words;
            #[inline(always)]
            fn from_bits(bits: $words) -> Self {
                Self(registers!($n, number, bits.0))
            }
            #[inline(always)]
            fn bf16_pairs(first: Self, second: Self) -> Self {
                Self(registers!($n, bf16_pairs, first.0, second.0))
            }
            $(
                #[inline(always)]
                fn has_dot() -> bool {
                    $has_dot()
                }
                #[inline(always)]
                fn vectorize_dot<X>(f: impl FnOnce() -> X) -> X {
                    #[inline(never)]
                    #[target_feature(enable = $features, enable = $dot)]
                    fn inner<X>(f: impl FnOnce() -> X) -> X {
                        f()
                    }
                    assert!(Self::has_dot());
                    // SAFETY: the CPU has what was asserted; of the rest, see `lane/block.rs`.
                    unsafe { inner(f) }
                }
                #[inline(always)]
                fn dot(self, a: Self, b: Self) -> Self {
                    Self(registers!($n, dot, self.0, a.0, b.0))
                }
                #[inline(always)]
                fn dot_pairs(first: Self, second: Self) -> Self {
                    Self(registers!($n, dot_pairs, first.0, second.0))
                }
            )?
        }

        impl Word for $words {
            #[inline(always)]
            fn splat(x: u32) -> Self {
                Self([word_splat(x); $n])
            }
            #[inline(always)]
            fn mul_wide(self, x: u32) -> (Self, Self) {
                let x = [word_splat(x); $n];
                (Self(registers!($n, mul_high, self.0, x)), Self(registers!($n, mul_low, self.0, x)))
            }
            #[inline(always)]
            fn shift_right<const N: u32>(self) -> Self {
                let right = |a| shift_right::<N>(a);
                Self(registers!($n, right, self.0))
            }
        }

        impl Bits for $words {
            #[inline(always)]
            fn from_array(x: [u32; LANES]) -> Self {
                // SAFETY: as many words as numbers, in the same registers.
                unsafe { std::mem::transmute(x) }
            }
            #[inline(always)]
            fn to_array(self) -> [u32; LANES] {
                // SAFETY: as many words as numbers, in the same registers.
                unsafe { std::mem::transmute(self) }
            }
        }
    };
}
pub(super) use block;
