//! The independent simulator obeys physics, the pilot keeps its box and covers the ranges, and the crate's own model
//! agrees with it.

mod truth;

use nalgebra::Vector3;
use truth::{State, Vehicle};

/// Smallest and largest of the numbers.
fn range(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    numbers.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[test]
#[ignore]
fn survey() {
    for seed in 0..12 {
        let v = Vehicle::draw(seed);
        let log = truth::fly(&v, seed, 300.0, 0.0);
        let column = |k: usize| range(log.odometry.column(k));
        let hover = v.command_for(9.8, 0.5 * (v.full_v + v.empty_v));
        let tw = truth::thrust::per_mass(&v, 1.0, v.full_v) / 9.8;
        print!("{seed} tw {tw:.1} hover {hover:.2} rates {:.0?} ", v.configured_rate.map(f64::to_degrees));
        print!("x {:.0?} y {:.0?} z {:.0?} ", column(0), column(1), column(2));
        let low = log.odometry.time_s.iter().zip(&log.odometry.rows).filter(|(t, _)| **t > 8.0 && **t < 285.0);
        print!("z flying {:.0?} ", range(low.map(|(_, r)| r[2])));
        print!("v {:.0?} {:.0?} {:.0?} ", column(7), column(8), column(9));
        for k in 0..3 {
            print!("w{k} {:.2?} ", range(log.imu.column(k)).map(|w| w / v.max_rate[k]));
        }
        println!("end {:.1?}", log.odometry.rows.last().unwrap()[2]);
    }
    let _ = (State::on_ground(&Vehicle::seed_class()), Vector3::<f64>::zeros());
}
