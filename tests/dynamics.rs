//! The compact model against the continuous-time reference, physical laws, and itself in other precisions.

use racer::dynamics::{Factors, Parameters, State, step};
use racer::lane::{Kernel, Lane, Lane32, Level, Real, dispatch};
use racer::vehicle::Vehicle;
use serde_json::Value;

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

fn state(x: [f64; 15]) -> State<f64> {
    State {
        position: [x[0], x[1], x[2]],
        velocity: [x[3], x[4], x[5]],
        attitude: [x[6], x[7], x[8], x[9]],
        command: [x[10], x[11], x[12], x[13]],
        voltage: x[14],
    }
}

fn distance<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Angle of the rotation between two attitudes, degrees.
fn turn_deg(a: [f64; 4], b: [f64; 4]) -> f64 {
    let d = distance(a, b).min(distance(a, b.map(|x| -x)));
    (4.0 * (0.5 * d).asin()).to_degrees()
}

/// Errors after `n` steps of the reference flight: m, m/s, deg, and the largest of u and V.
fn errors(n: usize) -> [f64; 4] {
    let golden: Value = serde_json::from_str(include_str!("golden/dynamics.json")).expect("JSON");
    let vehicle = Vehicle::load("seed_class").expect("embedded");
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, 0.01);
    let mut s = state(numbers(&golden["initial"]));
    for k in 0..n {
        s = step(&s, &parameters, numbers(&golden["commands"][k]));
    }
    let want = state(numbers(&golden["states"][n]));
    [
        distance(s.position, want.position),
        distance(s.velocity, want.velocity),
        turn_deg(s.attitude, want.attitude),
        distance(s.command, want.command).max((s.voltage - want.voltage).abs()),
    ]
}

/// Issue tolerance: after one second within 5 mm, 1 cm/s, 0.02 degrees.
#[test]
fn one_second_of_the_reference_flight() {
    let [p, v, q, u] = errors(100);
    println!("after 1 s: {:.2} mm, {:.2} mm/s, {q:.4} deg, {u:.1e}", p * 1e3, v * 1e3);
    println!("after 2 s: {:?}", errors(200));
    assert!(p < 5e-3 && v < 1e-2 && q < 0.02, "{p} m, {v} m/s, {q} deg");
    // Response and battery are exact up to the six digits of the reference's commands.
    assert!(u < 1e-9, "{u}");
}
