//! The compact model against the continuous-time reference, physical laws, and itself in other precisions.

use racer::base::lane::{Kernel, Lane32, Level, dispatch};
use racer::model::dynamics::{Craft, Factors, Parameters, State, step};
use racer::model::sim::Batch;
use racer::model::vehicle::Vehicle;
use serde_json::Value;

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|i| value[i].as_f64().expect("a number"))
}

fn state(x: [f64; 15]) -> State<f64> {
    State::new([x[0], x[1], x[2]], [x[3], x[4], x[5]], [x[6], x[7], x[8], x[9]], [x[10], x[11], x[12], x[13]], x[14])
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
    let golden: Value = serde_json::from_str(include_str!("../golden/dynamics.json")).expect("JSON");
    let vehicle = Vehicle::load("seed_class").expect("embedded");
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, 0.01);
    let mut s = state(numbers(&golden["initial"]));
    for k in 0..n {
        step(&mut s, &parameters, numbers(&golden["commands"][k]));
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

const DT: f64 = 0.01;

fn vehicle() -> Vehicle {
    Vehicle::load("seed_class").expect("embedded")
}

fn level_at_rest(voltage: f64) -> State<f64> {
    state([0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, voltage])
}

/// A vehicle whose thrust and drag are zero.
fn inert() -> Vehicle {
    let mut vehicle = vehicle();
    vehicle.thrust_n = [0.0; 6];
    vehicle.drag.coefficient = 0.0;
    vehicle
}

/// Without thrust and drag, z = z0 + v0 t - g t^2 / 2 exactly, whatever the commands.
#[test]
fn free_fall() {
    let parameters = Parameters::new(&inert(), &Factors::NOMINAL, DT);
    let mut s = level_at_rest(24.0);
    s.velocity = [3.0, -2.0, 5.0];
    for k in 0..100 {
        step(&mut s, &parameters, [(k as f64 * 0.3).sin(), 0.7, -0.2, 1.0]);
    }
    let g = parameters.gravity;
    assert!(distance(s.position, [3.0, -2.0, 10.0 + 5.0 - 0.5 * g]) < 1e-10, "{:?}", s.position);
    assert!(distance(s.velocity, [3.0, -2.0, 5.0 - g]) < 1e-11);
}

/// With the hover command settled and no discharge, nothing moves.
#[test]
fn hover() {
    let mut vehicle = vehicle();
    vehicle.battery.rate_v_s = 0.0;
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, DT);
    let command = vehicle.hover_command(23.0);
    let mut s = level_at_rest(23.0);
    s.command[3] = command;
    for _ in 0..500 {
        step(&mut s, &parameters, [0.0, 0.0, 0.0, command]);
    }
    assert!(distance(s.position, [0.0, 0.0, 10.0]) < 1e-9 && distance(s.velocity, [0.0; 3]) < 1e-9, "{s:?}");
}

/// Falling flat without thrust, drag balances weight at v = sqrt(2 m g / (rho C_D pi a b)): a disk of the ellipsoid's
/// largest section; on its side the sections are smaller and it falls faster.
#[test]
fn terminal_velocity() {
    let mut vehicle = vehicle();
    vehicle.thrust_n = [0.0; 6];
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, DT);
    let [a, b, c] = vehicle.drag.semi_axes_m;
    let half = 0.5_f64.sqrt();
    for (attitude, area) in [([1.0, 0.0, 0.0, 0.0], a * b), ([half, half, 0.0, 0.0], a * c)] {
        let mut s = level_at_rest(24.0);
        s.attitude = attitude;
        for _ in 0..6000 {
            step(&mut s, &parameters, [0.0; 4]);
        }
        let k = 0.5 * vehicle.drag.air_density_kg_m3 * vehicle.drag.coefficient * std::f64::consts::PI * area;
        let v = (vehicle.mass_kg * vehicle.gravity_m_s2 / k).sqrt();
        // The step's drag correction is of first order: (g dt / v)^2, a few parts in 100,000.
        assert!((s.velocity[2] + v).abs() < 1e-4 * v, "{} for {v}", s.velocity[2]);
    }
}

/// Drag without thrust only takes energy away, in any attitude and turning.
#[test]
fn drag_takes_energy() {
    let mut vehicle = vehicle();
    vehicle.thrust_n = [0.0; 6];
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, DT);
    let mut s = level_at_rest(24.0);
    s.velocity = [15.0, -8.0, 12.0];
    let energy = |s: &State<f64>| 0.5 * distance(s.velocity, [0.0; 3]).powi(2) + parameters.gravity * s.position[2];
    for k in 0..300 {
        let before = energy(&s);
        step(&mut s, &parameters, [(0.1 * k as f64).sin(), 0.8, -0.5, 0.0]);
        assert!(energy(&s) < before, "step {k}");
    }
}

/// The response to a step is 1 - exp(-t / tau) at every sample, the body rate is the filtered command times the maximum
/// rate, and the roll angle is its integral: w (t - tau (1 - exp(-t / tau))).
#[test]
fn exact_step_response() {
    let vehicle = inert();
    let parameters = Parameters::new(&vehicle, &Factors::NOMINAL, DT);
    let mut s = level_at_rest(24.0);
    for k in 1..=30 {
        step(&mut s, &parameters, [0.5, 0.0, 0.0, 1.0]);
        let t = k as f64 * DT;
        let follow = |i: usize| 1.0 - (-t / vehicle.time_constants()[i]).exp();
        assert!((s.command[0] - 0.5 * follow(0)).abs() < 1e-12 && (s.command[3] - follow(3)).abs() < 1e-12);
        let w = 0.5 * vehicle.max_rates_rad_s()[0];
        assert!((s.body_rates(&parameters)[0] - w * follow(0)).abs() < 1e-11);
        let angle = w * (t - vehicle.time_constants()[0] * follow(0));
        let turned = 2.0 * s.attitude[1].atan2(s.attitude[0]);
        assert!((angle - turned).rem_euclid(std::f64::consts::TAU).min(1.0) < 1e-9, "{angle} {turned}");
    }
}

/// The quaternion keeps its length over ten minutes of full rates, in single precision too.
#[test]
fn quaternion_norm() {
    let parameters = Parameters::new(&vehicle(), &Factors::NOMINAL, DT).map(|x| x as f32);
    let mut s = level_at_rest(24.0).map(|x| x as f32);
    for k in 0..60_000 {
        let sign = if k / 37 % 2 == 0 { 1.0 } else { -1.0 };
        step(&mut s, &parameters, [1.0, sign, -1.0, 0.0]);
        let norm = s.attitude.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
        assert!((norm - 1.0).abs() < 5e-7, "step {k}: {norm}");
    }
}

/// The silhouette of a sphere is the same from everywhere; of an ellipsoid, the disk of the two other axes.
#[test]
fn drag_follows_the_projected_area() {
    let mut vehicle = vehicle();
    let half_rho_cd = 0.5 * vehicle.drag.air_density_kg_m3 * vehicle.drag.coefficient;
    vehicle.drag.semi_axes_m = [0.1; 3];
    let sphere = racer::model::dynamics::drag::ellipsoid(&vehicle.drag);
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for v in [[3.0, 4.0, 0.0], [0.0, 0.0, -5.0], [0.0, 3.0, 4.0]] {
        let k = racer::model::dynamics::drag::damping(&sphere, &axes, v);
        assert!((k - half_rho_cd * std::f64::consts::PI * 0.01 * 5.0).abs() < 1e-12);
    }
}

struct Fly {
    start: State<f64>,
    steps: usize,
}

impl Kernel for Fly {
    type Output = Option<Vec<State<f32>>>;
    #[inline(always)]
    fn run<L: Lane32>(self) -> Self::Output {
        let parameters = Parameters::new(&vehicle(), &Factors::NOMINAL, DT).map(L::of);
        let mut s = self.start.map(L::of);
        for k in 0..self.steps {
            step(&mut s, &parameters, command(k).map(L::of));
        }
        L::FUSES.then(|| (0..16).map(|i| s.map(|x| x.get(i))).collect())
    }
}

fn command(k: usize) -> [f64; 4] {
    let t = k as f64 * DT;
    [(7.0 * t).sin(), (5.0 * t).cos(), 0.3 * (3.0 * t).sin(), 0.5 + 0.5 * (2.0 * t).sin()]
}

/// One vehicle in `f32` and each of 16 lanes end a wild flight with the same bits, wherever multiply-add is fused.
#[test]
fn scalar_is_simd_bit_for_bit() {
    let start = level_at_rest(23.9);
    let parameters = Parameters::new(&vehicle(), &Factors::NOMINAL, DT).map(|x| x as f32);
    let mut s = start.map(|x| x as f32);
    for k in 0..300 {
        step(&mut s, &parameters, command(k).map(|x| x as f32));
    }
    let bits = |s: &State<f32>| {
        let mut bits = Vec::new();
        s.map(|x| bits.push(x.to_bits()));
        bits
    };
    for level in Level::available() {
        for lane in dispatch(level, Fly { start, steps: 300 }).into_iter().flatten() {
            assert_eq!(bits(&lane), bits(&s), "{level}");
        }
    }
}

/// A batch flies each vehicle as if it were alone; the padding of the last block changes nothing.
#[test]
fn a_batch_is_its_vehicles() {
    let vehicles: Vec<_> = (0..37)
        .map(|i| {
            let factors = Factors { thrust: 0.8 + 0.01 * i as f64, ..Factors::NOMINAL };
            Craft::new(&vehicle(), &factors, DT, level_at_rest(23.0 + 0.01 * i as f64))
        })
        .collect();
    let actions: Vec<_> = (0..37).map(|i| [0.01 * i as f32, -0.2, 0.1, 0.3]).collect();
    for level in Level::available() {
        let mut all = Batch::new(&vehicles);
        all.advance(level, &actions, 50);
        assert_eq!(all.len(), 37);
        for i in [0, 15, 16, 36] {
            let mut one = Batch::new(&vehicles[i..=i]);
            one.advance(level, &actions[i..=i], 50);
            assert_eq!(format!("{:?}", one.state(0)), format!("{:?}", all.state(i)), "{level}, vehicle {i}");
        }
    }
}
