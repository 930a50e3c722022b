//! A multilayer perceptron with two hidden layers of 64 tanh units, forward and backward.
//!
//! Hidden activations lie `[sample][64]`: then every product of both passes is one [`multiply`], whose other operand is
//! read by broadcast at whatever stride it has, and nothing is transposed but the second layer's weights, once a step.
//! Observations, outputs and their derivatives lie `[feature][sample]`: a sample is a lane, as in the simulator and the
//! loss. Narrow heads are dot products whose lanes are summed 16 samples at a time.

use super::HIDDEN;
use super::aligned::Aligned;
use super::finish::{Accumulate, Activate, Descend};
use super::gemm::{Broadcast, Precision};
use crate::base::lane::{LANES, Lane, build};
use std::ops::Range;

/// Where the parameters of one network lie in the flat vector, in ranges that begin at multiples of 16.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    pub inputs: usize,
    pub outputs: usize,
    /// Offset of the first parameter.
    pub offset: usize,
}

impl Layout {
    /// First layer, `[inputs + 1][64]`: weights, and the biases as last row.
    pub fn first(&self) -> Range<usize> {
        self.offset..self.offset + (self.inputs + 1) * HIDDEN
    }
    /// Second layer, `[65][64]`: weights, and the biases as last row.
    pub fn second(&self) -> Range<usize> {
        let start = self.first().end;
        start..start + (HIDDEN + 1) * HIDDEN
    }
    /// Weights of the head, `[outputs][64]`.
    pub fn head(&self) -> Range<usize> {
        let start = self.second().end;
        start..start + self.outputs * HIDDEN
    }
    /// Biases of the head, `[outputs]`.
    pub fn head_biases(&self) -> Range<usize> {
        let start = self.head().end;
        start..start + self.outputs
    }
    /// Offset after the last parameter, rounded up to a multiple of 16.
    pub fn end(&self) -> usize {
        self.head_biases().end.next_multiple_of(LANES)
    }
}

/// Activations of the hidden layers, `[sample][64]` each.
#[derive(Clone)]
pub struct Hidden<E> {
    first: Aligned<E>,
    second: Aligned<E>,
}

impl<E: Copy + Default> Hidden<E> {
    /// Room for `samples` samples.
    pub fn new(samples: usize) -> Self {
        let layer = Aligned::zeros(samples * HIDDEN);
        Hidden { first: layer.clone(), second: layer }
    }
}

/// y = W3' tanh(W2' tanh(W1' x + b1) + b2) + b3 of the first `samples` of `pitch` samples: `x` `[inputs][pitch]`,
/// `y` `[outputs][pitch]`.
#[inline(always)]
pub fn forward<L: Lane, P: Precision<L>>(
    shape: &Layout,
    p: &[L::Elem],
    samples: usize,
    pitch: usize,
    x: &[L::Elem],
    h: &mut Hidden<L::Elem>,
    y: &mut [L::Elem],
) {
    let layer = |a: Broadcast<L::Elem>, p: &[L::Elem], out: &mut [L::Elem]| {
        let inner = p.len() / HIDDEN - 1;
        P::multiply(samples, inner, a, p, Activate::new(&p[inner * HIDDEN..], out));
    };
    layer(Broadcast { data: x, row: 1, column: pitch }, &p[shape.first()], &mut h.first);
    layer(Broadcast { data: &h.first, row: HIDDEN, column: 1 }, &p[shape.second()], &mut h.second);
    head::<L>(&p[shape.head()], &p[shape.head_biases()], samples, pitch, &h.second, y);
}

/// y[k][sample] = b[k] + w[k] . h[sample].
#[inline(always)]
fn head<L: Lane>(w: &[L::Elem], b: &[L::Elem], samples: usize, pitch: usize, h: &[L::Elem], y: &mut [L::Elem]) {
    L::vectorize(
        #[inline(always)]
        || {
            for (k, (w, b)) in w.chunks_exact(HIDDEN).zip(b).enumerate() {
                let w: [L; HIDDEN / LANES] = build!(|j| L::from_slice(&w[j * LANES..]));
                for (block, h) in h[..samples * HIDDEN].chunks_exact(LANES * HIDDEN).enumerate() {
                    let products = build!(|i| {
                        let h = |j: usize| L::from_slice(&h[i * HIDDEN + j * LANES..]);
                        (1..HIDDEN / LANES).fold(w[0] * h(0), |sum, j| w[j].mul_add(h(j), sum))
                    });
                    (L::row_sums(products) + L::splat(*b)).write(&mut y[k * pitch + block * LANES..]);
                }
            }
        },
    );
}

/// Writes the transpose of the second layer's weights to `turned` `[64][64]`, for [`backward`].
#[inline(always)]
pub fn turn<L: Lane>(shape: &Layout, p: &[L::Elem], turned: &mut [L::Elem]) {
    let p = &p[shape.second()];
    for i in 0..HIDDEN * HIDDEN / LANES / LANES {
        let (r, c) = (i / 4 * LANES, i % 4 * LANES);
        let mut block = build!(|i| L::from_slice(&p[(r + i) * HIDDEN + c..]));
        L::transpose(&mut block);
        for (i, row) in block.into_iter().enumerate() {
            row.write(&mut turned[(c + i) * HIDDEN + r..]);
        }
    }
}

/// Adds the gradient of a tile to `g`, but for the head's biases: `x` and `h` as [`forward`] left them, `dy`
/// `[outputs][pitch]` the derivative by the outputs. Destroys `h`.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the operands of one formula
pub fn backward<L: Lane, P: Precision<L>>(
    shape: &Layout,
    p: &[L::Elem],
    turned: &[L::Elem],
    samples: usize,
    pitch: usize,
    x: &[L::Elem],
    h: &mut Hidden<L::Elem>,
    dy: &[L::Elem],
    g: &mut [L::Elem],
) {
    let Hidden { first, second } = h;
    let by_feature = |data| Broadcast { data, row: pitch, column: 1 };
    let by_sample = |data| Broadcast { data, row: 1, column: pitch };

    let head = Accumulate::<_, false>(&mut g[shape.head()]);
    P::multiply(shape.outputs, samples, by_feature(dy), second, head);
    P::multiply(samples, shape.outputs, by_sample(dy), &p[shape.head()], Descend(second));

    let inputs = Broadcast { data: first, row: 1, column: HIDDEN };
    P::multiply(HIDDEN, samples, inputs, second, Accumulate::<_, true>(&mut g[shape.second()]));
    let deltas = Broadcast { data: second, row: HIDDEN, column: 1 };
    P::multiply(samples, HIDDEN, deltas, turned, Descend(first));

    P::multiply(shape.inputs, samples, by_feature(x), first, Accumulate::<_, true>(&mut g[shape.first()]));
}
