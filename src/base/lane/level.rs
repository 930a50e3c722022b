//! Which blocks this CPU has, and running a kernel on them.

#[cfg(not(target_arch = "x86_64"))]
use super::Portable;
#[cfg(target_arch = "aarch64")]
use super::neon;
#[cfg(target_arch = "x86_64")]
use super::x86;
use super::{Lane32, Real};
use std::fmt;

/// Work to be run on the best blocks this CPU has.
pub trait Kernel {
    type Output;
    /// The body; mark it `#[inline(always)]`.
    fn run<L: Lane32>(self) -> Self::Output;
}

/// An implementation of the 16-lane block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One 512-bit register a block.
    Avx512,
    /// Two 256-bit registers a block, fused multiply-add.
    Avx2,
    /// Four 128-bit registers of a 64-bit Arm a block, fused multiply-add.
    Neon,
    /// Four 128-bit registers a block, which every x86-64 has; elsewhere what the compiler makes of a loop over 16
    /// numbers. Multiply-add is not fused.
    Portable,
}

impl Level {
    /// All levels this CPU can run, best first.
    pub fn available() -> Vec<Level> {
        [Level::Avx512, Level::Avx2, Level::Neon, Level::Portable].into_iter().filter(|l| l.is_available()).collect()
    }

    /// The best level of this CPU.
    pub fn best() -> Level {
        Level::available()[0]
    }

    fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => x86::has_avx512(),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => x86::has_avx2(),
            #[cfg(not(target_arch = "x86_64"))]
            Level::Avx512 | Level::Avx2 => false,
            Level::Neon => cfg!(target_arch = "aarch64"),
            Level::Portable => true,
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Level::Avx512 => "AVX-512",
            Level::Avx2 => "AVX2",
            Level::Neon => "NEON",
            Level::Portable => "portable",
        })
    }
}

/// Runs `kernel` at `level`.
///
/// # Panics
/// If this CPU does not have `level`.
pub fn dispatch<K: Kernel>(level: Level, kernel: K) -> K::Output {
    assert!(level.is_available(), "this CPU does not have {level}");
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => x86::Avx512::vectorize(
            #[inline(always)]
            || kernel.run::<x86::Avx512>(),
        ),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => x86::Avx2::vectorize(
            #[inline(always)]
            || kernel.run::<x86::Avx2>(),
        ),
        #[cfg(target_arch = "x86_64")]
        Level::Portable => x86::Sse2::vectorize(
            #[inline(always)]
            || kernel.run::<x86::Sse2>(),
        ),
        #[cfg(target_arch = "aarch64")]
        Level::Neon => neon::Neon::vectorize(
            #[inline(always)]
            || kernel.run::<neon::Neon>(),
        ),
        #[cfg(target_arch = "x86_64")]
        Level::Neon => unreachable!("not available"),
        #[cfg(not(target_arch = "x86_64"))]
        _ => kernel.run::<Portable<f32>>(),
    }
}

/// Runs `work` on scalars where a fused multiply-add is one instruction, if this CPU has it; elsewhere it is a call of
/// a function, with the same result.
pub fn fused<T>(work: impl FnOnce() -> T) -> T {
    #[cfg(target_arch = "x86_64")]
    if x86::has_avx2() {
        return x86::Avx2::vectorize(work);
    }
    work()
}
