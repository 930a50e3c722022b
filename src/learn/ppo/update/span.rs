//! A span of the parameters, with all that a step changes of them: each is summed and moved by one thread, so that
//! little of it goes from one processor's cache to another's.

use crate::base::lane::{LANES, Lane, Real};
use crate::learn::nn::adam::{Adam, Rates};
use std::ops::Range;
use std::sync::Mutex;

pub struct ParameterSpan<'a, E> {
    /// Its place among the parameters; it begins with a block.
    from: usize,
    /// The minibatch's gradient, before clipping.
    gradient: &'a mut [E],
    first: &'a mut [E],
    second: &'a mut [E],
    /// The parameters after the step.
    next: &'a mut [E],
}

/// All parameters in at most so many `parts`.
pub fn spans<'a, E>(
    parts: usize,
    gradient: &'a mut [E],
    adam: &'a mut Adam<E>,
    next: &'a mut [E],
) -> Vec<Mutex<ParameterSpan<'a, E>>>
where
    E: Copy + Default,
{
    let len = gradient.len().div_ceil(LANES).div_ceil(parts) * LANES;
    let moments = adam.first.chunks_mut(len).zip(adam.second.chunks_mut(len));
    let rest = gradient.chunks_mut(len).zip(next.chunks_mut(len)).zip(moments).enumerate();
    rest.map(|(i, ((gradient, next), (first, second)))| {
        Mutex::new(ParameterSpan { from: i * len, gradient, first, second, next })
    })
    .collect()
}

impl<E: Real<Mask = bool> + PartialOrd + Default> ParameterSpan<'_, E> {
    /// Takes chunk `number`'s gradient `from` to those of the chunks before.
    pub fn add<L: Lane<Elem = E>>(&mut self, number: usize, from: &[E]) {
        let from = &from[self.from..self.from + self.gradient.len()];
        L::vectorize(
            #[inline(always)]
            || {
                for (sum, from) in self.gradient.chunks_exact_mut(LANES).zip(from.chunks_exact(LANES)) {
                    let before = if number == 0 { L::zero() } else { L::from_slice(sum) };
                    (before + L::from_slice(from)).write(sum);
                }
            },
        );
    }

    /// Adds the gradient of the entropy, of which every sample has the same.
    pub fn entropy(&mut self, weight: f64, log_std: Range<usize>) {
        for (g, _) in self.gradient.iter_mut().zip(self.from..).filter(|(_, at)| log_std.contains(at)) {
            *g = *g - E::of(weight);
        }
    }

    /// Squares of the gradient's numbers, added to those of the spans `before`.
    pub fn squares<L: Lane<Elem = E>>(&self, before: L) -> L {
        L::vectorize(
            #[inline(always)]
            || {
                let mut squares = before;
                for g in self.gradient.chunks_exact(LANES) {
                    squares = L::from_slice(g).mul_add(L::from_slice(g), squares);
                }
                squares
            },
        )
    }

    /// Steps from `parameters` against the gradient times `scale`.
    pub fn descend<L: Lane<Elem = E>>(&mut self, rates: &Rates, parameters: &[E], scale: E) {
        self.next.copy_from_slice(&parameters[self.from..self.from + self.next.len()]);
        L::vectorize(
            #[inline(always)]
            || rates.step::<L>(self.next, self.first, self.second, self.gradient, scale),
        );
    }
}
