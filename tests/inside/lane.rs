//! The 16-lane blocks: arithmetic like the scalars', and the stated accuracy of exp, ln, tanh, sin and cos.

use racer::base::lane::{Kernel, LANES, Lane32, Level, Mask, dispatch};

/// Largest errors over dense sweeps, in the order exp (relative), ln (relative or absolute near 1), tanh (relative),
/// sin/cos.
struct Errors;
impl Kernel for Errors {
    type Output = [f64; 4];
    #[inline(always)]
    fn run<L: Lane32>(self) -> [f64; 4] {
        let mut worst = [0.0f64; 4];
        let n = 40_000;
        for i in 0..n {
            let at = |low: f64, high: f64| -> [f32; LANES] {
                std::array::from_fn(|k| (low + (high - low) * (i * LANES + k) as f64 / (n * LANES) as f64) as f32)
            };
            let mut sweep = |which: usize, x: [f32; LANES], y: L, truth: fn(f64) -> f64, floor: f64| {
                for (x, y) in x.into_iter().zip(y.to_array()) {
                    let want = truth(f64::from(x));
                    worst[which] = worst[which].max((f64::from(y) - want).abs() / want.abs().max(floor));
                }
            };
            let x = at(-86.9, 87.9);
            sweep(0, x, L::from_array(x).exp(), f64::exp, 0.0);
            let x = at(1e-6, 4.0);
            sweep(1, x, L::from_array(x).ln(), f64::ln, 1.0);
            let x = at(-9.0, 9.0);
            sweep(2, x, L::from_array(x).tanh(), f64::tanh, 1e-30);
            let x = at(-2.0, 2.0);
            let (sin, cos) = L::from_array(x).sin_cos_turns();
            sweep(3, x, sin, |t| (t * std::f64::consts::TAU).sin(), 1.0);
            sweep(3, x, cos, |t| (t * std::f64::consts::TAU).cos(), 1.0);
        }
        worst
    }
}

#[test]
fn functions_are_as_accurate_as_stated() {
    for level in Level::available() {
        let [exp, ln, tanh, sin_cos] = dispatch(level, Errors);
        assert!(
            exp < 3e-7 && ln < 4e-7 && tanh < 2e-6 && sin_cos < 5e-7,
            "{level}: {exp:e} {ln:e} {tanh:e} {sin_cos:e}"
        );
    }
}

struct Extremes;
impl Kernel for Extremes {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        for x in [1e30, 100.0, 7.5, f64::INFINITY] {
            assert!(L::of(x).tanh().get(3) <= 1.0 && L::of(x).tanh().get(3) > 0.99999);
            assert_eq!(L::of(-x).tanh().get(3), -L::of(x).tanh().get(3));
        }
        assert!(L::of(1e9).exp().get(0).is_finite() && L::of(-1e9).exp().get(0) >= 0.0);
        assert_eq!(L::of(0.0).tanh().get(0), 0.0);
        assert_eq!(L::of(1.0).ln().get(0), 0.0);
        let bad = L::from_array(std::array::from_fn(|i| [1.0, f32::NAN, f32::INFINITY, -2.0][i % 4]));
        assert_eq!(bad.is_finite().bits(), 0b1001_1001_1001_1001);
    }
}

#[test]
fn extremes_stay_finite_and_in_range() {
    Level::available().into_iter().for_each(|level| dispatch(level, Extremes));
}

struct Layout;
impl Kernel for Layout {
    type Output = ();
    #[inline(always)]
    fn run<L: Lane32>(self) {
        let numbers: [f32; LANES] = std::array::from_fn(|i| i as f32 - 3.5);
        let mut x = L::from_array(numbers);
        assert_eq!(x.to_array(), numbers);
        x.set(11, 100.0);
        assert_eq!((x.get(11), x.get(10), x.get(12)), (100.0, 6.5, 8.5));
        assert_eq!(L::from_array(numbers).sum(), numbers.iter().sum::<f32>());

        let negative = L::from_array(numbers).lt(L::zero());
        assert_eq!(negative.bits(), 0b1111);
        assert_eq!(L::Mask::from_bits(0b1010_0000_0000_0001).bits(), 0b1010_0000_0000_0001);
        assert_eq!((!negative).bits() & 0xffff, 0xfff0);
        let picked = L::select(negative, L::one(), L::from_array(numbers)).to_array();
        assert_eq!((picked[3], picked[4]), (1.0, 0.5));

        let mut rows: [L; LANES] = std::array::from_fn(|r| L::from_array(std::array::from_fn(|c| (r * 16 + c) as f32)));
        L::transpose(&mut rows);
        for (r, row) in rows.iter().enumerate() {
            assert_eq!(row.to_array(), std::array::from_fn(|c| (c * 16 + r) as f32));
        }
    }
}

#[test]
fn lanes_are_numbers_in_order() {
    Level::available().into_iter().for_each(|level| dispatch(level, Layout));
}
