//! The machine's multiply-add peak, measured: the limit that training is compared with.

use crate::base::lane::{Kernel, Lane32, Level, build, dispatch};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Independent chains of multiply-adds; more than any CPU needs to hide the instruction's latency.
const CHAINS: usize = 12;
const ROUNDS: usize = 2_000_000;

struct MultiplyAdds;
impl Kernel for MultiplyAdds {
    type Output = f32;
    #[inline(always)]
    fn run<L: Lane32>(self) -> f32 {
        let (a, b) = (L::splat(black_box(0.9999)), L::splat(black_box(0.001)));
        let mut x: [L; CHAINS] = build!(|i| L::splat(black_box(i as f32)));
        for _ in 0..ROUNDS {
            for x in &mut x {
                *x = x.mul_add(a, b);
            }
        }
        x.iter().skip(1).fold(x[0], |s, &x| s + x).sum()
    }
}

/// Single-precision operations a second, a multiply-add counted as two, with every thread of the current rayon pool
/// busy for about `time`; the best of the rounds that fit.
pub fn flops_per_s(level: Level, time: Duration) -> f64 {
    let work = (ROUNDS * CHAINS * crate::base::lane::LANES * 2) as f64;
    let started = Instant::now();
    let mut best = 0.0f64;
    while started.elapsed() < time {
        let begin = Instant::now();
        let sums = rayon::broadcast(|_| dispatch(level, MultiplyAdds));
        black_box(&sums);
        best = best.max(work * sums.len() as f64 / begin.elapsed().as_secs_f64());
    }
    best
}
