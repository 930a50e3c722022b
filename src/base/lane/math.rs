//! exp, ln, tanh and sin/cos for single precision, written once for scalars and blocks.
//!
//! Coefficients are minimax fits made for these ranges; `tests/lane.rs` measures the errors stated at [`super::Real`].

use super::Single;

#[inline(always)]
fn horner<R: Single, const N: usize>(x: R, c: [f64; N]) -> R {
    let mut y = R::of(c[N - 1]);
    for i in (0..N - 1).rev() {
        y = y.mul_add(x, R::of(c[i]));
    }
    y
}

/// `exp(x)` as `2^n 2^f` with `f` in [-1/2, 1/2].
#[inline(always)]
pub fn exp<R: Single>(x: R) -> R {
    let x = x.clamp(R::of(-87.0), R::of(88.0));
    let n = (x * R::of(std::f64::consts::LOG2_E)).round();
    // x - n ln 2 in two parts, so that the remainder keeps its digits.
    let high = 0.693_359_375;
    let f = n.mul_add(R::of(-high), x);
    let f = n.mul_add(R::of(high - std::f64::consts::LN_2), f) * R::of(std::f64::consts::LOG2_E);
    let c = [
        1.000_000_000_554_172_3,
        0.693_147_205_737_453_9,
        0.240_226_468_906_063,
        0.055_503_287_765_563_6,
        0.009_618_488_958_662_717,
        0.001_339_993_138_522_7,
        0.000_153_458_119_751_064,
    ];
    horner(f, c) * n.pow2()
}

/// `ln(x)` as `e ln 2 + ln(m)` with `m` in [sqrt(1/2), sqrt(2)).
#[inline(always)]
pub fn ln<R: Single>(x: R) -> R {
    let (m, e) = x.split_exponent();
    let small = m.lt(R::of(std::f64::consts::FRAC_1_SQRT_2));
    let e = R::select(small, e - R::one(), e);
    let f = R::select(small, m + m, m) - R::one();
    let c = [
        0.333_338_580_707_608_7,
        -0.250_017_469_486_148_4,
        0.199_653_979_275_287_25,
        -0.165_656_339_361_955_34,
        0.148_769_627_068_345_37,
        -0.143_502_068_167_087,
        0.089_178_713_610_015,
    ];
    let f2 = f * f;
    let tail = f2.mul_add(R::of(-0.5), horner(f, c) * f2 * f);
    e.mul_add(R::of(std::f64::consts::LN_2), f + tail)
}

/// Rational approximation of degree 7 over 6; saturates at |x| = 7, where 1 - tanh(x) is 1.7e-6.
#[inline(always)]
pub fn tanh<R: Single>(x: R) -> R {
    let (p, q) = tanh_fraction(x);
    p / q
}

/// Two hyperbolic tangents by one division, the dearest instruction here: a/b = a d / (b d).
#[inline(always)]
pub fn tanh_pair<R: Single>([x, y]: [R; 2]) -> [R; 2] {
    let ((a, b), (c, d)) = (tanh_fraction(x), tanh_fraction(y));
    let inverse = R::one() / (b * d);
    [a * d * inverse, c * b * inverse]
}

/// Numerator and denominator of [`tanh`].
#[inline(always)]
fn tanh_fraction<R: Single>(x: R) -> (R, R) {
    let x = x.clamp(R::of(-7.0), R::of(7.0));
    let y = x * x;
    let p = [0.999_998_966_828_175_4, 0.123_220_517_444_534_36, 0.002_293_086_120_959_956, 3.995_859_013_041_447e-6];
    let q = [1.0, 0.456_546_115_714_809, 0.021_151_601_239_747_488, 0.000_143_984_169_425_929_43];
    (x * horner(y, p), horner(y, q))
}

/// Sine and cosine of `x` turns: reduced to an eighth of a turn, then swapped and signed by quadrant.
#[inline(always)]
pub fn sin_cos_turns<R: Single>(x: R) -> (R, R) {
    let x = x - x.round();
    let quadrant = (x * R::of(4.0)).round();
    let t = x.mul_add(R::of(4.0), -quadrant);
    let y = t * t;
    let s = [1.570_796_305_085_291_8, -0.645_962_938_160_668_1, 0.079_675_905_902_998_37, -0.004_592_288_905_032_227];
    let c = [
        0.999_999_999_952_595_7,
        -1.233_700_540_647_083,
        0.253_669_203_934_430_8,
        -0.020_860_071_289_425_262,
        0.000_903_631_644_806_208_4,
    ];
    let (s, c) = (horner(y, s) * t, horner(y, c));
    // Quadrant -2..=2: odd ones swap, and signs follow sin and cos of the quadrant's own angle.
    let odd = (quadrant.abs() - R::one()).abs().lt(R::of(0.5));
    let negative = quadrant.lt(R::of(-0.5));
    let half_turn = R::of(1.5).lt(quadrant.abs());
    let sign = |m: R::Mask, v: R| R::select(m, -v, v);
    let sin = R::select(odd, sign(negative, c), sign(half_turn, s));
    let cos = R::select(odd, sign(!negative, s), sign(half_turn, c));
    (sin, cos)
}
