//! Attitude: unit quaternions (w, x, y, z), body to world.

use crate::base::lane::{Real, build, each};

pub type Quaternion<R> = [R; 4];

/// Inner product of two vectors.
#[inline(always)]
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// Vector product a x b.
#[inline(always)]
pub fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1].mul_add(b[2], -(a[2] * b[1])), a[2].mul_add(b[0], -(a[0] * b[2])), a[0].mul_add(b[1], -(a[1] * b[0]))]
}

/// c0 + c1 x + .. + c4 x^4.
#[inline(always)]
fn polynomial<R: Real>(c: [f64; 5], x: R) -> R {
    let mut y = R::of(c[4]);
    for k in (0..4).rev() {
        y = y.mul_add(x, R::of(c[k]));
    }
    y
}

/// The rotation that constant body rates (rad/s) make in `dt` seconds.
///
/// Series in the squared half angle, exact to double precision up to a turn of half a radian.
#[inline(always)]
pub fn small_rotation<R: Real>(rates: [R; 3], dt: R) -> Quaternion<R> {
    let h = dt * R::of(0.5);
    let v = each!(rates, |w| w * h);
    let x = dot(v, v);
    let sinc = polynomial([1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0], x);
    let cos = polynomial([1.0, -0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0], x);
    [cos, v[0] * sinc, v[1] * sinc, v[2] * sinc]
}

/// The product q r: `q` followed, in the body frame, by `r`.
#[inline(always)]
pub fn compose<R: Real>(q: Quaternion<R>, r: Quaternion<R>) -> Quaternion<R> {
    let (qv, rv) = ([q[1], q[2], q[3]], [r[1], r[2], r[3]]);
    let c = cross(qv, rv);
    [
        q[0].mul_add(r[0], -dot(qv, rv)),
        q[0].mul_add(rv[0], r[0].mul_add(qv[0], c[0])),
        q[0].mul_add(rv[1], r[0].mul_add(qv[1], c[1])),
        q[0].mul_add(rv[2], r[0].mul_add(qv[2], c[2])),
    ]
}

/// One Newton step back to unit length; exact for the rounding errors that a step leaves.
#[inline(always)]
pub fn normalized<R: Real>(q: Quaternion<R>) -> Quaternion<R> {
    let n = q[0].mul_add(q[0], dot([q[1], q[2], q[3]], [q[1], q[2], q[3]]));
    let scale = n.mul_add(R::of(-0.5), R::of(1.5));
    each!(q, |x| x * scale)
}

/// A vector of the body, in the world, by the body's axes there.
#[inline(always)]
pub fn in_world(axes: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    build!(|k| axes[0][k] * v[0] + axes[1][k] * v[1] + axes[2][k] * v[2])
}

/// The rotation vector of a rotation of at most half a turn, rad; of the two quaternions of a rotation, either will do.
#[inline(always)]
pub fn rotation_vector(q: Quaternion<f64>) -> [f64; 3] {
    let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
    let axis = q[1].hypot(q[2]).hypot(q[3]);
    let scale = if axis > 1e-12 { 2.0 * axis.atan2(sign * q[0]) * sign / axis } else { 2.0 * sign };
    [q[1] * scale, q[2] * scale, q[3] * scale]
}

/// The same of a rotation of at most a whole turn: of the two ways round that end alike the one nearer to `near`, rad.
#[inline(always)]
pub fn rotation_vector_near(q: Quaternion<f64>, near: impl FnOnce() -> [f64; 3]) -> [f64; 3] {
    let short = rotation_vector(q);
    let angle = dot(short, short).sqrt();
    // The other way round is longer by two of what this one is short of half a turn.
    if angle < std::f64::consts::FRAC_PI_2 {
        return short;
    }
    let long = each!(short, |v| v * (1.0 - std::f64::consts::TAU / angle));
    let near = near();
    let apart = |v: [f64; 3]| -> f64 { (0..3).map(|k| (v[k] - near[k]).powi(2)).sum() };
    if apart(long) < apart(short) { long } else { short }
}

/// The body's x, y and z axes in the world.
#[inline(always)]
pub fn body_axes<R: Real>(q: Quaternion<R>) -> [[R; 3]; 3] {
    let [w, x, y, z] = q;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let one = R::one();
    [
        [one - (yy + zz), x.mul_add(y2, w * z2), x.mul_add(z2, -(w * y2))],
        [x.mul_add(y2, -(w * z2)), one - (xx + zz), y.mul_add(z2, w * x2)],
        [x.mul_add(z2, w * y2), y.mul_add(z2, -(w * x2)), one - (xx + yy)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flip_of_more_than_half_a_turn_is_told_the_way_round_that_was_flown() {
        for angle in [0.3, 3.0, 3.4, 4.5, -3.4_f64] {
            let q = [(0.5 * angle).cos(), (0.5 * angle).sin(), 0.0, 0.0];
            let told = rotation_vector_near(q, || [0.9 * angle, 0.1, 0.0]);
            assert!((told[0] - angle).abs() < 1e-12, "{angle}: {told:?}");
        }
    }
}
