//! What every thrust curve has to satisfy, as inequalities that are linear in its coefficients: those who fit a curve
//! fit it under them, so that the reader of vehicle files takes whatever they write.

use super::specific_thrust;

/// Coefficients with `row . c >= least`, in the unit of the thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrustLimit {
    pub row: [f64; 6],
    pub least: f64,
}

/// Commands at which the slope is held, in steps of this: a cubic dips between two by far less than the reader minds.
const STEPS: i32 = 40;
/// Thrust over weight at full command that a vehicle has at least: one that flies climbs.
const LEAST_LIFT: f64 = 1.02;
/// Beyond what was flown: share of the slope at its end that stays at least, and the power of the throttle with which
/// thrust grows at most. Thrust goes with the square of a rotor's speed and the speed with a power below 1 of the
/// throttle.
const LEAST_SLOPE: f64 = 0.5;
const MOST_POWER: i32 = 3;
/// Power of the voltage with which thrust grows at most: 2 for a motor at a given duty, and the sag under load on top.
pub const MOST_VOLTAGE_POWER: f64 = 3.0;

/// The thrust of the curve at `u` and `v` is this row times its coefficients.
pub fn at(u: f64, v: f64) -> [f64; 6] {
    row(|c| specific_thrust(c, u, v))
}

/// The same for its slope with the command.
fn slope(u: f64, v: f64) -> [f64; 6] {
    [0.0, 1.0, 2.0 * u, 3.0 * u * u, 0.0, v]
}

/// Least and most thrust at `u` that a curve with this thrust and slope at the command `flown`, which is less, may
/// have.
pub fn beyond(c: &[f64; 6], v: f64, flown: f64, u: f64) -> [f64; 2] {
    let end = flown.clamp(-0.9, u);
    let steep: f64 = slope(end, v).iter().zip(c).map(|(row, c)| row * c).sum();
    let here = specific_thrust(c, end, v);
    let power = f64::from(MOST_POWER);
    let grown = ((1.0 + u).powf(power) / (1.0 + end).powf(power - 1.0) - (1.0 + end)) / power;
    [here + LEAST_SLOPE * steep * (u - end), here + steep * grown]
}

fn row(of: impl Fn(&[f64; 6]) -> f64) -> [f64; 6] {
    std::array::from_fn(|k| {
        let mut unit = [0.0; 6];
        unit[k] = 1.0;
        of(&unit)
    })
}

/// `a - factor * b` is at least zero.
fn more(a: [f64; 6], factor: f64, b: [f64; 6]) -> ThrustLimit {
    ThrustLimit { row: std::array::from_fn(|k| a[k] - factor * b[k]), least: 0.0 }
}

/// Limits of a curve between `volts`, of a vehicle of this `weight` (in the unit of the thrust), flown between the
/// commands `flown`: thrust grows with the command, starts at zero or above, lifts the vehicle, grows with the voltage
/// and no faster than a motor does, and goes on growing beyond what was flown.
pub fn limits(volts: [f64; 2], weight: f64, flown: [f64; 2]) -> Vec<ThrustLimit> {
    const NOTHING: [f64; 6] = [0.0; 6];
    let end = flown[1].clamp(-0.9, 1.0);
    let mut out = vec![ThrustLimit { row: at(1.0, volts[1]), least: LEAST_LIFT * weight }];
    for v in volts {
        out.push(more(at(-1.0, v), 0.0, NOTHING));
        for u in (0..=STEPS).map(|k| 2.0 * f64::from(k) / f64::from(STEPS) - 1.0) {
            out.push(more(slope(u, v), 0.0, NOTHING));
            if u > end {
                out.push(more(slope(u, v), LEAST_SLOPE, slope(end, v)));
                let most = ((1.0 + u) / (1.0 + end)).powi(MOST_POWER - 1);
                out.push(more(slope(end, v).map(|x| most * x), 1.0, slope(u, v)));
            }
        }
        for u in [end, 1.0] {
            let by_voltage = [0.0, 0.0, 0.0, 0.0, 1.0, u];
            out.push(more(by_voltage, 0.0, NOTHING));
            out.push(more(at(u, v).map(|x| MOST_VOLTAGE_POWER * x / v), 1.0, by_voltage));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::{Philox, RngStream};
    use crate::model::vehicle::Vehicle;
    use rand::RngExt;

    #[test]
    fn built_in_vehicles_lie_within() {
        for name in ["seed_class", "a2rl_class"] {
            let v = Vehicle::load(name).unwrap();
            for limit in limits([v.battery.empty_v, v.battery.full_v], v.mass_kg * v.gravity_m_s2, [-0.9, 0.8]) {
                let found: f64 = limit.row.iter().zip(&v.thrust_n).map(|(a, c)| a * c).sum();
                assert!(found >= limit.least, "{name}: {limit:?} gives {found}");
            }
        }
    }

    /// What lies within the limits is read, whatever it is.
    #[test]
    fn whatever_keeps_the_limits_is_read() {
        let mut rng = Philox::new(11).sequence(RngStream::Noise, 0, 0);
        let base = Vehicle::load("seed_class").unwrap();
        let mut kept = 0;
        for _ in 0..20_000 {
            let mut v = base.clone();
            let full = rng.random_range(4.0..26.0);
            (v.battery.full_v, v.battery.empty_v) = (full, full * rng.random_range(0.75..0.97));
            v.thrust_n = std::array::from_fn(|k| base.thrust_n[k] * rng.random_range(0.2..1.8));
            let limits = limits([v.battery.empty_v, v.battery.full_v], v.mass_kg * v.gravity_m_s2, [-0.8, 0.4]);
            let inside = |l: &ThrustLimit| l.row.iter().zip(&v.thrust_n).map(|(a, c)| a * c).sum::<f64>() >= l.least;
            if limits.iter().all(inside) {
                kept += 1;
                v.check_thrust().unwrap();
            }
        }
        assert!(kept > 50, "only {kept} of the draws keep the limits");
    }

    #[test]
    fn rows_by_hand() {
        assert_eq!(at(0.5, 10.0), [1.0, 0.5, 0.25, 0.125, 10.0, 5.0]);
        assert_eq!(slope(0.5, 10.0), [0.0, 1.0, 1.0, 0.75, 0.0, 10.0]);
    }
}
