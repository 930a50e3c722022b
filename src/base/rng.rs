//! Counter-based random numbers: Philox 4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011).
//!
//! A number is a function of (seed, stream, environment, step, index) and of nothing else, so results do not depend on
//! threads, on the order of work or on the vector length.

use crate::base::lane::{Bits, Lane32, Word};
use rand::rand_core::block::{BlockRng, Generator};
use rand::{RngExt, TryRng};
use std::convert::Infallible;

/// What a number is drawn for; streams never share numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum RngStream {
    /// Exploration of the policy.
    Action = 1,
    /// Noise on observations and on the applied action.
    Noise = 2,
    /// Start states and vehicle parameters.
    Reset = 3,
    /// Order of the minibatches.
    Shuffle = 4,
    /// Initial weights.
    Weights = 5,
    /// Start states and vehicle parameters of an evaluation.
    Evaluation = 6,
    /// Order and sizes of the excitation pilot's manoeuvres.
    Pilot = 7,
    /// Noise and bias of recorded flights.
    Sensors = 8,
    /// Seeds drawn again for the ranking of a study.
    Bootstrap = 9,
    /// First laps that a reference lap is looked for from.
    Reference = 10,
    /// Frequencies of a regression's random features.
    Features = 11,
}

/// The generator's key.
#[derive(Clone, Copy, Debug)]
pub struct Philox {
    key: [u32; 2],
}

impl Philox {
    pub fn new(seed: u64) -> Self {
        Philox { key: [seed as u32, (seed >> 32) as u32] }
    }

    /// Ten rounds over the counter: four independent uniform words for each lane.
    #[inline(always)]
    pub fn words<W: Word>(&self, counter: [W; 4]) -> [W; 4] {
        self.rounds::<W, 10>(counter)
    }

    #[inline(always)]
    fn rounds<W: Word, const ROUNDS: usize>(&self, counter: [W; 4]) -> [W; 4] {
        let [mut c0, mut c1, mut c2, mut c3] = counter;
        let [mut k0, mut k1] = self.key;
        for _ in 0..ROUNDS {
            let (h0, l0) = c0.mul_wide(0xd251_1f53);
            let (h1, l1) = c2.mul_wide(0xcd9e_8d57);
            (c0, c1, c2, c3) = (h1 ^ c1 ^ W::splat(k0), l1, h0 ^ c3 ^ W::splat(k1), l0);
            k0 = k0.wrapping_add(0x9e37_79b9);
            k1 = k1.wrapping_add(0xbb67_ae85);
        }
        [c0, c1, c2, c3]
    }

    /// Four words for each environment of a block at its own step; `index` tells further draws of the step apart.
    #[inline(always)]
    pub fn block<B: Bits>(&self, stream: RngStream, environments: B, step: u32, index: u32) -> [B; 4] {
        self.words([B::splat(index), environments, B::splat(step), B::splat(stream as u32)])
    }

    /// As [`Philox::block`] with seven rounds, the fewest that pass every test of randomness (Table 2 of the paper):
    /// for noise of sensors, of which every step takes much.
    #[inline(always)]
    pub fn noise<B: Bits>(&self, stream: RngStream, environments: B, step: u32, index: u32) -> [B; 4] {
        self.rounds::<B, 7>([B::splat(index), environments, B::splat(step), B::splat(stream as u32)])
    }

    /// A sequence of numbers for one environment.
    pub fn sequence(&self, stream: RngStream, environment: u32, step: u32) -> Sequence {
        Sequence(BlockRng::new(Counter { rng: *self, next: [0, environment, step, stream as u32] }))
    }
}

/// Numbers drawn one after another, for work that is not vectorised: what the distributions of `rand` and `rand_distr`
/// draw from.
#[derive(Clone, Debug)]
pub struct Sequence(BlockRng<Counter>);

/// The generator at its next counter.
#[derive(Clone, Debug)]
struct Counter {
    rng: Philox,
    next: [u32; 4],
}

impl Generator for Counter {
    type Output = [u32; 4];

    fn generate(&mut self, words: &mut [u32; 4]) {
        *words = self.rng.words(self.next);
        self.next[0] += 1;
    }
}

impl TryRng for Sequence {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.0.next_word())
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.0.next_u64_from_u32())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.0.fill_bytes(bytes);
        Ok(())
    }
}

impl Sequence {
    /// Uniform over a configured range `[low, high]`, which may be a single number.
    pub fn uniform(&mut self, [low, high]: [f64; 2]) -> f64 {
        self.random_range(low..=high)
    }
}

#[inline(always)]
fn box_muller<L: Lane32>(u: L, turns: L) -> (L, L) {
    let radius = (u.ln() * L::of(-2.0)).sqrt();
    let (s, c) = turns.sin_cos_turns();
    (radius * c, radius * s)
}

/// Two standard normals a lane from two words, by 24 bits each: for sampling actions. At most 5.9 in size.
#[inline(always)]
pub fn normals<L: Lane32>(a: L::Bits, b: L::Bits) -> (L, L) {
    let unit = L::of(1.0 / 16_777_216.0);
    let u = L::from_bits(a.shift_right::<8>()).mul_add(unit, L::of(0.5 / 16_777_216.0));
    box_muller(u, L::from_bits(b.shift_right::<8>()) * unit)
}

/// Two standard normals a lane from the halves of one word, by 16 bits each: for sensor noise, which nobody can tell
/// from finer at a third of the price. At most 4.9 in size.
///
/// Box and Muller again, with polynomials (minimax fits) no finer than the numbers they take: the squared radius is off
/// by at most 8e-6 of itself, sine and cosine by 7e-6.
#[inline(always)]
pub fn coarse_normals<L: Lane32>(a: L::Bits) -> (L, L) {
    let unit = L::of(1.0 / 65_536.0);
    let (m, e) = L::from_bits(a.shift_right::<16>()).mul_add(unit, L::of(0.5 / 65_536.0)).split_exponent();
    // -2 ln(2^e m), as a series about m = 1.
    let d = m - L::one();
    let tail = polynomial(
        d,
        [-1.999_984_515_5, 1.002_041_283_2, -0.623_333_908_2, 0.829_180_607_6, 0.673_528_250_4, 1.733_841_390_1],
    );
    let radius = d.mul_add(tail, e * L::of(-2.0 * std::f64::consts::LN_2)).sqrt();
    // Half a circle, and the sign for the other half.
    let side = L::from_bits(a & L::Bits::splat(0xffff)) - L::of(32_767.5);
    let radius = L::select(side.lt(L::zero()), -radius, radius);
    let t = side.abs().mul_add(L::of(1.0 / 32_768.0), L::of(-0.5));
    let t2 = t * t;
    let sine = t * polynomial(t2, [3.141_590_283_6, -5.167_407_697_7, 2.544_020_811_1, -0.559_489_91]);
    let cosine = polynomial(t2, [0.999_993_295_3, -4.933_938_015_1, 4.041_283_825_5, -1.222_127_060_7]);
    (radius * cosine, radius * sine)
}

/// c[0] + c[1] x + c[2] x^2 + ..
#[inline(always)]
fn polynomial<L: Lane32, const N: usize>(x: L, c: [f64; N]) -> L {
    let mut y = L::of(c[N - 1]);
    for i in (0..N - 1).rev() {
        y = y.mul_add(x, L::of(c[i]));
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::lane::{Kernel, Level, dispatch};
    use rand::Rng;
    use rand_distr::StandardNormal;

    /// The known answers published with the generator (Random123, philox4x32, 10 and 7 rounds).
    #[test]
    fn known_answers() {
        let ones = u32::MAX;
        assert_eq!(Philox { key: [0, 0] }.words([0u32; 4]), [0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8]);
        assert_eq!(Philox { key: [ones; 2] }.words([ones; 4]), [0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd]);
        let seven = Philox { key: [0, 0] }.rounds::<u32, 7>([0; 4]);
        assert_eq!(seven, [0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48]);
        let pi = Philox { key: [0xa4093822, 0x299f31d0] };
        let counter = [0x243f6a88u32, 0x85a308d3, 0x13198a2e, 0x03707344];
        assert_eq!(pi.words(counter), [0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1]);
    }

    /// A sequence is the generator's words in their order, however they are asked for.
    #[test]
    fn sequences_are_the_words_in_order() {
        let philox = Philox::new(7);
        let words: Vec<u32> = (0..3u32).flat_map(|i| philox.words([i, 5, 9, RngStream::Reset as u32])).collect();
        let mut one = philox.sequence(RngStream::Reset, 5, 9);
        assert_eq!((0..12).map(|_| one.next_u32()).collect::<Vec<_>>(), words);
        let mut two = philox.sequence(RngStream::Reset, 5, 9);
        assert_eq!(two.next_u32(), words[0]);
        assert_eq!((0..5).map(|_| two.next_u64()).collect::<Vec<_>>(), {
            let pairs = words[1..11].chunks(2).map(|w| u64::from(w[0]) | u64::from(w[1]) << 32);
            pairs.collect::<Vec<_>>()
        });
    }

    #[test]
    fn scalar_distributions_have_their_moments() {
        let mut rng = Philox::new(11).sequence(RngStream::Reset, 0, 0);
        let n = 200_000;
        let moments = |x: Vec<f64>| [1, 2, 3, 4].map(|k| x.iter().map(|x| x.powi(k)).sum::<f64>() / x.len() as f64);
        // Five standard errors of each.
        let [m1, m2, m3, m4] = moments((&mut rng).sample_iter(StandardNormal).take(n).collect());
        assert!(m1.abs() < 0.012 && (m2 - 1.0).abs() < 0.016, "{m1} {m2}");
        assert!(m3.abs() < 0.044 && (m4 - 3.0).abs() < 0.11, "{m3} {m4}");
        let [m1, m2, m3, m4] = moments((0..n).map(|_| rng.uniform([-1.0, 1.0])).collect());
        assert!(m1.abs() < 0.0065 && (m2 - 1.0 / 3.0).abs() < 0.0034, "{m1} {m2}");
        assert!(m3.abs() < 0.0043 && (m4 - 0.2).abs() < 0.003, "{m3} {m4}");
        assert_eq!(rng.uniform([1.0, 1.0]), 1.0);
    }

    struct Moments;
    impl Kernel for Moments {
        type Output = [f64; 4];
        #[inline(always)]
        fn run<L: Lane32>(self) -> [f64; 4] {
            let rng = Philox::new(7);
            let ids = L::Bits::from_array(std::array::from_fn(|i| i as u32));
            let scalar = rng.words([2u32, 5, 3, RngStream::Noise as u32]);
            assert_eq!(rng.block(RngStream::Noise, ids, 3, 2).map(|w| w.to_array()[5]), scalar);
            let mut sums = [0.0; 4];
            let n = 20_000;
            for step in 0..n {
                let [a, b, c, _] = rng.block(RngStream::Action, ids, step, 0);
                let (x, y) = normals::<L>(a, b);
                let (z, w) = coarse_normals::<L>(c);
                for v in [x, y, z, w] {
                    for v in v.to_array() {
                        (0..4).for_each(|k| sums[k] += (v as f64).powi(k as i32 + 1));
                    }
                }
            }
            sums.map(|s| s / (n as f64 * 64.0))
        }
    }

    #[test]
    fn normals_have_the_moments_of_a_normal() {
        for level in Level::available() {
            let [m1, m2, m3, m4] = dispatch(level, Moments);
            // Five standard errors of 1.28 million samples.
            assert!(m1.abs() < 0.005 && (m2 - 1.0).abs() < 0.007, "{level}: {m1} {m2}");
            assert!(m3.abs() < 0.018 && (m4 - 3.0).abs() < 0.045, "{level}: {m3} {m4}");
        }
    }
}
