//! A multilayer perceptron with two hidden layers of 64 tanh units, on tiles of 64 samples.
//!
//! Activations lie `[feature][64]`: a sample is a lane, so environments, network and loss share one layout and only the
//! weight gradients, which sum over samples, need a transpose.

use super::aligned::Aligned;
use super::gemm::{Broadcast, Start, multiply, transpose};
use super::{HIDDEN, TILE_BLOCKS, TILE_SAMPLES};
use crate::lane::{LANES, Lane};
use std::ops::Range;

/// Where the parameters of one network lie in the flat vector. Weights are `[inputs][outputs]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    pub inputs: usize,
    pub outputs: usize,
    /// Offset of the first parameter.
    pub offset: usize,
}

impl Shape {
    fn inputs_of(&self, layer: usize) -> usize {
        if layer == 0 { self.inputs } else { HIDDEN }
    }
    fn outputs_of(&self, layer: usize) -> usize {
        if layer == 2 { self.outputs } else { HIDDEN }
    }
    /// The weights of layer 0, 1 or 2, `[inputs][outputs]`.
    pub fn weights(&self, layer: usize) -> Range<usize> {
        let before: usize = (0..layer).map(|l| (self.inputs_of(l) + 1) * self.outputs_of(l)).sum();
        let start = self.offset + before;
        start..start + self.inputs_of(layer) * self.outputs_of(layer)
    }
    /// The biases of layer 0, 1 or 2.
    pub fn biases(&self, layer: usize) -> Range<usize> {
        let start = self.weights(layer).end;
        start..start + self.outputs_of(layer)
    }
    /// Offset after the last parameter.
    pub fn end(&self) -> usize {
        self.biases(2).end
    }
}

/// Activations of the hidden layers, `[64][64]` each.
#[derive(Clone)]
pub struct Hidden<E> {
    first: Aligned<E>,
    second: Aligned<E>,
}

impl<E: Default + Copy> Default for Hidden<E> {
    fn default() -> Self {
        let tile = Aligned::zeros(HIDDEN * TILE_SAMPLES);
        Hidden { first: tile.clone(), second: tile }
    }
}

/// y = W3' tanh(W2' tanh(W1' x + b1) + b2) + b3: `x` `[inputs][64]`, `y` `[outputs][64]`.
#[inline]
pub fn forward<L: Lane>(shape: &Shape, p: &[L::Elem], x: &[L::Elem], h: &mut Hidden<L::Elem>, y: &mut [L::Elem]) {
    let layer = |l: usize, x: &[L::Elem], y: &mut [L::Elem]| {
        let (n, m) = (shape.inputs_of(l), shape.outputs_of(l));
        let a = Broadcast { data: &p[shape.weights(l)], row: 1, column: m };
        multiply::<L>(m, n, TILE_SAMPLES, a, x, y, Start::Bias(&p[shape.biases(l)]));
    };
    layer(0, x, &mut h.first);
    tanh::<L>(&mut h.first);
    layer(1, &h.first, &mut h.second);
    tanh::<L>(&mut h.second);
    layer(2, &h.second, y);
}

#[inline]
fn tanh<L: Lane>(x: &mut [L::Elem]) {
    L::vectorize(
        #[inline(always)]
        || {
            for x in x.chunks_exact_mut(LANES) {
                L::from_slice(x).tanh().write(x);
            }
        },
    );
}

/// Scratch of the backward pass.
#[derive(Clone)]
pub struct Backward<E> {
    delta: Aligned<E>,
    turned: Aligned<E>,
}

impl<E: Default + Copy> Default for Backward<E> {
    fn default() -> Self {
        let tile = Aligned::zeros(HIDDEN * TILE_SAMPLES);
        Backward { delta: tile.clone(), turned: tile }
    }
}

/// Adds the gradient of a tile to `g`: `x` and `h` as in [`forward`], `dy` `[outputs][64]` the derivative by the outputs.
#[inline]
pub fn backward<L: Lane>(
    shape: &Shape,
    p: &[L::Elem],
    x: &[L::Elem],
    h: &Hidden<L::Elem>,
    dy: &[L::Elem],
    scratch: &mut Backward<L::Elem>,
    g: &mut [L::Elem],
) {
    let Backward { delta, turned } = scratch;
    let m = shape.outputs;
    head_gradient::<L>(m, &h.second, dy, &mut g[shape.weights(2)]);
    add_row_sums::<L>(dy, &mut g[shape.biases(2)]);
    let a = Broadcast { data: &p[shape.weights(2)], row: m, column: 1 };
    multiply::<L>(HIDDEN, m, TILE_SAMPLES, a, dy, delta, Start::Zero);
    through_tanh::<L>(delta, &h.second, &mut g[shape.biases(1)]);

    transpose::<L>(HIDDEN, TILE_SAMPLES, delta, turned);
    let a = Broadcast { data: &h.first, row: TILE_SAMPLES, column: 1 };
    multiply::<L>(HIDDEN, TILE_SAMPLES, HIDDEN, a, turned, &mut g[shape.weights(1)], Start::Add);
    let a = Broadcast { data: &p[shape.weights(1)], row: HIDDEN, column: 1 };
    // `turned` is free again: the next layer's delta goes there, and its transpose back.
    multiply::<L>(HIDDEN, HIDDEN, TILE_SAMPLES, a, delta, turned, Start::Zero);
    through_tanh::<L>(turned, &h.first, &mut g[shape.biases(0)]);

    transpose::<L>(HIDDEN, TILE_SAMPLES, turned, delta);
    let a = Broadcast { data: x, row: TILE_SAMPLES, column: 1 };
    multiply::<L>(shape.inputs, TILE_SAMPLES, HIDDEN, a, delta, &mut g[shape.weights(0)], Start::Add);
}

/// delta *= 1 - h^2, and adds its sums over the samples to `bias`.
#[inline]
fn through_tanh<L: Lane>(delta: &mut [L::Elem], h: &[L::Elem], bias: &mut [L::Elem]) {
    L::vectorize(
        #[inline(always)]
        || {
            for (d, h) in delta.chunks_exact_mut(LANES).zip(h.chunks_exact(LANES)) {
                let h = L::from_slice(h);
                (L::from_slice(d) * (-h).mul_add(h, L::one())).write(d);
            }
        },
    );
    add_row_sums::<L>(delta, bias);
}

/// sums[r] += sum of row r of `x[rows][64]`.
#[inline]
fn add_row_sums<L: Lane>(x: &[L::Elem], sums: &mut [L::Elem]) {
    L::vectorize(
        #[inline(always)]
        || {
            for (row, sum) in x.chunks_exact(TILE_SAMPLES).zip(sums) {
                let blocks = row.chunks_exact(LANES).skip(1).fold(L::from_slice(row), |s, b| s + L::from_slice(b));
                *sum = *sum + blocks.sum();
            }
        },
    );
}

/// g[i][j] += sum over samples of h[i] dy[j]; the head is too narrow for the matrix product.
#[inline]
fn head_gradient<L: Lane>(outputs: usize, h: &[L::Elem], dy: &[L::Elem], g: &mut [L::Elem]) {
    L::vectorize(
        #[inline(always)]
        || {
            for (i, h) in h.chunks_exact(TILE_SAMPLES).enumerate() {
                let h: [L; TILE_BLOCKS] = std::array::from_fn(|b| L::from_slice(&h[b * LANES..]));
                for (j, dy) in dy.chunks_exact(TILE_SAMPLES).enumerate() {
                    let sum = (0..TILE_BLOCKS).fold(L::zero(), |s, b| h[b].mul_add(L::from_slice(&dy[b * LANES..]), s));
                    let g = &mut g[i * outputs + j];
                    *g = *g + sum.sum();
                }
            }
        },
    );
}
