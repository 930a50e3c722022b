//! Effects beyond the compact model: each changes the flight as its equation says, in every precision, and hardly where
//! it is hardly there.

use racer::base::lane::Level;
use racer::base::rng::{Philox, RngStream};
use racer::model::dynamics::extended::Extended;
use racer::model::dynamics::{Craft, Factors, Parameters, State, step};
use racer::model::effects::{self, COUNT, Card, LOG_COUNT, MODEL, Sensed};
use racer::model::sim::Batch;
use racer::model::thrust::specific_thrust;
use racer::model::vehicle::Vehicle;
use racer::model::vehicle::extension::Extension;
use std::collections::BTreeMap;

const DT: f64 = 0.01;

fn seed_class() -> Vehicle {
    Vehicle::load("seed_class").expect("embedded")
}

/// `vehicle` with one effect of these sizes, the first of its parameters; the others are absent.
fn with(mut vehicle: Vehicle, id: &str, sizes: &[f64]) -> Vehicle {
    let card = effects::card(id).expect("an effect");
    assert!(card.parameters.len() >= sizes.len(), "{id}");
    let named = card.parameters.iter().zip(sizes).map(|(p, size)| (p.name.to_string(), *size));
    vehicle.effects.sizes.insert(id.to_string(), named.collect());
    vehicle
}

fn parameters(vehicle: &Vehicle) -> Parameters<f64> {
    Parameters::new(vehicle, &Factors::NOMINAL, DT)
}

fn craft(vehicle: &Vehicle, state: State<f64>) -> Craft<f64> {
    Craft::new(vehicle, &Factors::NOMINAL, DT, state)
}

/// [`seed_class`] with one effect.
fn one(id: &str, sizes: &[f64]) -> Vehicle {
    with(seed_class(), id, sizes)
}

fn typical(card: &Card) -> Vec<f64> {
    card.parameters.iter().map(|p| p.typical[1]).collect()
}

/// Sinking fast and slanted, close to the ground, with a third of the battery left: no effect sleeps.
fn start() -> State<f64> {
    State::new([0.0, 0.0, 0.6], [7.0, -3.0, -4.0], [1.0, 0.0, 0.0, 0.0], [0.2, -0.1, 0.3, 0.0], 22.7)
}

/// Steps and curves on every axis, full throttle with yaw, and cuts.
fn command(k: usize) -> [f64; 4] {
    let t = k as f64 * DT;
    let sign = if (k / 12).is_multiple_of(2) { 1.0 } else { -1.0 };
    let thrust = [0.0, 1.0, -0.6, 0.9][k / 10 % 4];
    [0.4 * sign + 0.2 * (31.0 * t).sin(), 0.5 * (17.0 * t).cos(), 0.8 * sign, thrust]
}

/// What a flight's end is compared by.
fn numbers(craft: &Craft<f64>) -> Vec<f64> {
    let s = &craft.state;
    let flown = s.position.iter().chain(&s.velocity).chain(&s.attitude).chain(&s.command);
    flown.copied().chain(craft.body_rates()).chain([craft.terminal_voltage()]).collect()
}

fn fly(mut craft: Craft<f64>, steps: usize) -> Craft<f64> {
    for k in 0..steps {
        craft.step(command(k));
    }
    craft
}

fn largest(a: &[f64], b: &[f64], scaled: bool) -> f64 {
    let off = |(a, b): (&f64, &f64)| (a - b).abs() / if scaled { 1.0 + b.abs() } else { 1.0 };
    a.iter().zip(b).map(off).fold(0.0, f64::max)
}

/// In one batch, so that every lane shares its block with effects that it has not; a vehicle without effects has a
/// block of its own.
#[test]
fn every_effect_changes_the_flight_and_a_batch_agrees() {
    const STEPS: usize = 50;
    let plain = numbers(&fly(craft(&seed_class(), start()), STEPS));
    let mut all: Vec<_> = MODEL.iter().map(|card| (card.id, craft(&one(card.id, &typical(card)), start()))).collect();
    all.insert(7, ("none", craft(&seed_class(), start())));
    let vehicles: Vec<_> = all.iter().map(|(_, craft)| craft.clone()).collect();
    for level in Level::available() {
        let mut batch = Batch::new(&vehicles);
        for k in 0..STEPS {
            batch.advance(level, &vec![command(k).map(|x| x as f32); all.len()], 1);
        }
        for (i, (id, craft)) in all.iter().enumerate() {
            let alone = numbers(&fly(craft.clone(), STEPS));
            let change = largest(&alone, &plain, false);
            let lane = numbers(&batch.craft(i).map(f64::from));
            let error = largest(&lane, &alone, true);
            println!("{level} {id}: changes {change:.1e}, lanes off by {error:.1e}");
            if *id == "none" {
                assert!(change == 0.0 && error < 1e-4, "{level}: {change}, {error}");
                continue;
            }
            assert!(change > 1e-3, "{id} changes nothing: {change}");
            assert!(error < 1e-3 && error < 0.1 * change, "{level}, {id}: {error} of {change}");
        }
    }
}

/// Position (m) and velocity (m/s) that two states differ by.
fn apart(a: &State<f64>, b: &State<f64>) -> (f64, f64) {
    (largest(&a.position, &b.position, false), largest(&a.velocity, &b.velocity, false))
}

/// The extended model tends to the compact one as each effect tends to nothing: nearly to its steps of 2 ms, which are
/// as long as its own, and to those of 10 ms as far as these may be off themselves (5 mm and 1 cm/s, as in the test of
/// the compact model).
#[test]
fn a_negligible_effect_is_none() {
    const STEPS: usize = 100;
    let smooth = |k: usize| {
        let t = k as f64 * DT;
        [(7.0 * t).sin(), (5.0 * t).cos(), 0.3 * (3.0 * t).sin(), 0.5 * (4.0 * t).sin()]
    };
    let compact = parameters(&seed_class());
    let fine = Parameters::new(&seed_class(), &Factors::NOMINAL, DT / 5.0);
    let (mut long, mut short) = (start(), start());
    for k in 0..STEPS {
        step(&mut long, &compact, smooth(k));
        (0..5).for_each(|_| step(&mut short, &fine, command(k)));
    }
    for card in MODEL {
        let sizes = vec![1e-12; card.parameters.len()];
        let small = craft(&one(card.id, &sizes), start());
        assert!(small.is_extended());
        let mut smoothly = small.clone();
        (0..STEPS).for_each(|k| smoothly.step(smooth(k)));
        for (steps, most, (far, fast)) in
            [("short", 2e-3, apart(&fly(small, STEPS).state, &short)), ("long", 5e-3, apart(&smoothly.state, &long))]
        {
            println!("{}, {steps} steps: {:.2} mm, {:.2} mm/s", card.id, 1e3 * far, 1e3 * fast);
            assert!(far < most && fast < 1e-2, "{}, {steps} steps: {far} m, {fast} m/s", card.id);
        }
    }
}

/// A vehicle file with these lines after those of `seed_class`.
fn load(more: &str) -> Result<Vehicle, racer::base::check::BadInput> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, toml::to_string(&seed_class()).expect("TOML") + more).expect("written");
    Vehicle::load(path.to_str().expect("UTF-8"))
}

#[test]
fn a_vehicle_file_keeps_its_effects() {
    let text = "\n[effects]\nsource = \"flights\"\nuncertain = [\"axial_inflow.k\", \"steady_wind.wy\"]\n\
        covariance = [[0.04, 0.01], [0.01, 0.25]]\n[effects.sizes.axial_inflow]\nk = 0.5\n\
        [effects.sizes.steady_wind]\nwx = 1.5\nwy = -2.0\n";
    let vehicle = load(text).expect("a sound file");
    assert_eq!(vehicle.effects.sizes["axial_inflow"]["k"], 0.5);
    let again: Vehicle = toml::from_str(&toml::to_string(&vehicle).expect("TOML")).expect("itself");
    assert_eq!(again, vehicle);
    let numbers = Extended::new(&vehicle, &Factors::NOMINAL, DT).values.numbers;
    assert_eq!(numbers[effects::span("axial_inflow").expect("listed")], [0.5, 0.0]);
    assert_eq!(numbers[effects::span("steady_wind").expect("listed")], [1.5, -2.0]);
    assert_eq!(numbers.iter().filter(|k| **k != 0.0).count(), 3);
    assert_eq!(load("\n[effects.sizes.axial_inflow]\nk = 0.5\n").expect("alone").effects.sizes.len(), 1);
}

#[test]
fn a_vehicle_file_with_wrong_effects_is_refused() {
    for (text, parts) in [
        ("[effects.sizes.axial_outflow]\nk = 0.5", ["axial_outflow", "axial_inflow"]),
        ("[effects.sizes.gyro_bias]\nx = 0.01", ["gyro_bias", "do not belong to a vehicle"]),
        ("[effects.sizes.axial_inflow]\ngain = 0.5", ["effects.sizes.axial_inflow.gain", "one of k, across"]),
        ("[effects.sizes.axial_inflow]\nk = 4.5", ["effects.sizes.axial_inflow.k", "0 to 4 1/s"]),
        ("[effects.sizes.axial_inflow]\nk = -0.5", ["effects.sizes.axial_inflow.k", "-0.5"]),
        ("[effects.sizes.axial_inflow]\nk = nan", ["effects.sizes.axial_inflow.k", "NaN"]),
        (
            "[effects]\nuncertain = [\"axial_inflow.gain\"]\ncovariance = [[1.0]]",
            ["effects.uncertain", "axial_inflow.gain"],
        ),
        (
            "[effects]\nuncertain = [\"axial_inflow.k\"]\ncovariance = [[-1.0]]\n[effects.sizes.axial_inflow]\nk = 0.5",
            ["effects.covariance", "positive definite"],
        ),
        (
            "[effects]\nuncertain = [\"axial_inflow.k\"]\n[effects.sizes.axial_inflow]\nk = 0.5",
            ["effects.covariance", "1 rows of 1"],
        ),
    ] {
        let message = load(&format!("\n{text}\n")).expect_err(text).to_string();
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in:\n{message}");
        }
    }
}

/// An angle lags by the delay times the rate, whether or not the delay is a multiple of anything.
#[test]
fn rate_delay_is_exact() {
    let mut inert = seed_class();
    inert.thrust_n = [0.0; 6];
    inert.drag.coefficient = 0.0;
    // Angles rolled after each step, and filtered commands.
    let roll = |id: &str, size: f64| {
        let s = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0; 4], 24.0);
        let mut craft = craft(&with(inert.clone(), id, &[size]), s);
        let mut all = Vec::new();
        for _ in 0..30 {
            craft.step([0.5, 0.0, 0.0, 0.0]);
            let s = &craft.state;
            all.push((2.0 * s.attitude[1].atan2(s.attitude[0]), s.command[0]));
        }
        all
    };
    let (rate, tau) = (0.5 * inert.max_rates_rad_s()[0], inert.time_constants()[0]);
    let prompt = roll("vertical_drag", 1e-12);
    for delay in [0.001, 0.0137, 0.02, 0.0333, 0.05, 0.0999, 0.12] {
        let late = roll("rate_delay", delay);
        let lag = (prompt[29].0 - late[29].0) / rate;
        assert!((lag - delay).abs() < 1e-6, "{lag} for {delay}");
        // Within a part of a step, what arrives is its mean: exact up to (h / tau)^2 / 24.
        for (k, (_, command)) in late.iter().enumerate() {
            let t = ((k + 1) as f64 * DT - delay).max(0.0);
            let want = 0.5 * (1.0 - (-t / tau).exp());
            assert!((command - want).abs() < 0.012 * 0.5, "{delay}, step {k}: {command} for {want}");
        }
    }
    for (late, prompt) in roll("rate_delay", 0.03)[3..].iter().zip(&prompt) {
        assert!((late.0 - prompt.0).abs() < 1e-9 && (late.1 - prompt.1).abs() < 1e-9);
    }
}

/// Yaw has a time of its own; no command comes before it was sent.
#[test]
fn yaw_comes_later_than_roll() {
    let commands = |effects: &[(&str, f64)]| {
        let vehicle = effects.iter().fold(seed_class(), |vehicle, (id, size)| with(vehicle, id, &[*size]));
        let s = State::new([0.0, 0.0, 10.0], [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0; 4], 24.0);
        let mut craft = craft(&vehicle, s);
        let mut next = || {
            craft.step([0.5, 0.0, 0.5, 0.0]);
            [craft.state.command[0], craft.state.command[2]]
        };
        (0..12).map(|_| next()).collect::<Vec<_>>()
    };
    let prompt = commands(&[("vertical_drag", 1e-12)]);
    let late = commands(&[("yaw_delay", 0.03)]);
    for i in 0..9 {
        assert!((late[i][0] - prompt[i][0]).abs() < 1e-9, "roll, step {i}");
        assert!((late[i + 3][1] - prompt[i][1]).abs() < 1e-9, "yaw, step {i}");
    }
    let earlier = commands(&[("rate_delay", 0.05), ("yaw_delay", -0.02)]);
    assert!((0..7).all(|i| (earlier[i + 5][0] - prompt[i][0]).abs() < 1e-9));
    assert!((0..9).all(|i| (earlier[i + 3][1] - prompt[i][1]).abs() < 1e-9));
    assert_eq!(commands(&[("yaw_delay", -0.02)]), commands(&[("vertical_drag", 1e-12)]));
}

/// After `steps` steps of `action` from rest at 10 m.
fn held(vehicle: &Vehicle, from: [f64; 4], action: [f64; 4], voltage: f64, steps: usize) -> Craft<f64> {
    let s = State::new([0.0, 0.0, 10.0], [0.0; 3], [1.0, 0.0, 0.0, 0.0], from, voltage);
    let mut craft = craft(vehicle, s);
    (0..steps).for_each(|_| craft.step(action));
    craft
}

fn close(a: f64, b: f64, within: f64, what: &str) {
    assert!((a - b).abs() < within, "{what}: {a}, not {b}");
}

#[test]
fn rates_follow_the_equations() {
    let vehicle = seed_class();
    let (max, tau) = (vehicle.max_rates_rad_s(), vehicle.time_constants());
    let settled =
        |id: &str, sizes: &[f64], action: [f64; 4]| held(&one(id, sizes), [0.0; 4], action, 23.5, 60).body_rates();
    let [x, y, z] = settled("rate_expo", &[0.4], [0.5, -0.5, 1.0, 0.0]);
    let half = 0.6 * 0.5 + 0.4 * 0.125;
    close(x, half * max[0], 1e-9, "expo, roll");
    close(y, -half * max[1], 1e-9, "expo, pitch");
    close(z, max[2], 1e-9, "expo, full yaw");

    let [x, y, z] = settled("rate_cross_coupling", &[0.1, -0.05], [0.5, 0.2, 0.3, 0.0]);
    close(x, 0.5 * max[0] + 0.1 * 0.2 * max[1], 1e-9, "roll by pitch");
    close(y, 0.2 * max[1] - 0.05 * 0.5 * max[0], 1e-9, "pitch by roll");
    close(z, 0.3 * max[2], 1e-9, "yaw alone");

    let [x, y, z] = settled("gyroscopic_coupling", &[0.1], [0.5, 0.8, 0.9, 0.0]);
    close(x, 0.5 * max[0] + 0.1 * y * z * tau[0], 1e-9, "roll by pitch and yaw");
    close(y, 0.8 * max[1] - 0.1 * z * x * tau[1], 1e-9, "pitch by yaw and roll");

    close(settled("yaw_authority_loss", &[0.4], [0.0, 0.0, 0.5, 1.0])[2], 0.6 * 0.5 * max[2], 1e-9, "at full throttle");
    close(settled("yaw_authority_loss", &[0.4], [0.0, 0.0, 0.5, 0.8])[2], 0.8 * 0.5 * max[2], 1e-9, "at 90 %");
    close(settled("yaw_authority_loss", &[0.4], [0.0, 0.0, 0.5, 0.5])[2], 0.5 * max[2], 1e-9, "at 75 %");

    let rates = settled("weak_motor", &[0.1, -0.2, 0.3], [0.0, 0.0, 0.0, 0.5]);
    close(rates[0], 0.075, 1e-9, "roll at 75 %");
    close(rates[2], 0.225, 1e-9, "yaw at 75 %");

    // 1 V below full and falling by 0.2 mV a step.
    let p = one("response_voltage", &[0.2]);
    let s = held(&p, [0.0; 4], [1.0, 0.0, 0.0, 0.0], 23.0, 2);
    close(s.state.command[0], 1.0 - (-0.02 / (1.2 * tau[0])).exp(), 1e-4, "response at 1 V less");
    let limited = with(p.clone(), "rate_slew_limit", &[0.01]);
    let s = held(&limited, [0.0; 4], [1.0, 0.0, 0.0, 0.0], 23.0, 2);
    close(s.state.command[0], 0.02 * 100.0 / 1.2 / max[0], 1e-4, "largest angular acceleration at 1 V less");
    let swings = with(p, "rate_second_order", &[4e-4]);
    let mut slower = with(seed_class(), "rate_second_order", &[1.2 * 4e-4]);
    slower.time_constant_s.roll *= 1.2;
    let [s, want] = [swings, slower].map(|v| held(&v, [0.0; 4], [1.0, 0.0, 0.0, 0.0], 23.0, 2).state.command[0]);
    close(s, want, 1e-4, "swing at 1 V less");

    let p = one("thrust_asymmetric_lag", &[0.0125]);
    let up = held(&p, [0.0; 4], [0.0, 0.0, 0.0, 1.0], 23.0, 2);
    close(up.state.command[3], 1.0 - (-0.02 / tau[3]).exp(), 1e-9, "rising thrust");
    let down = held(&p, [0.0; 4], [0.0, 0.0, 0.0, -1.0], 23.0, 2);
    close(down.state.command[3], (-0.02 / (tau[3] + 0.0125)).exp() - 1.0, 1e-9, "falling thrust");
}

#[test]
fn the_battery_follows_the_equations() {
    // Command 0.6 is throttle 0.8, and load 0.64.
    let full = [0.0, 0.0, 0.0, 0.6];
    let p = one("voltage_sag", &[2.0]);
    let s = held(&p, full, full, 23.5, 10);
    close(s.terminal_voltage(), s.state.voltage - 2.0 * 0.64, 1e-12, "sag");
    let idle = [0.0, 0.0, 0.0, -1.0];
    let s = held(&p, idle, idle, 23.5, 10);
    close(s.terminal_voltage(), s.state.voltage, 1e-12, "no sag at rest");

    let p = one("voltage_relaxation", &[1.0, 0.5]);
    let s = held(&p, full, full, 23.5, 50);
    let lost = s.state.voltage - s.terminal_voltage();
    close(lost, 0.64 * (1.0 - (-1.0_f64).exp()), 1e-9, "one time constant of load");

    let p = one("ocv_curve", &[0.5]);
    for (open, want) in [(24.0, 0.5), (22.0, -0.5), (23.0, 0.0), (23.5, 0.5 * (2.5 * 0.125 - 0.75)), (24.4, 0.5)] {
        let s = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], full, open);
        close(craft(&p, s).terminal_voltage(), open + want, 1e-12, "curve");
    }
    let p = one("ocv_curve", &[0.0, 0.4]);
    for (open, want) in [(24.0, 0.4), (22.0, 0.4), (23.0, -0.2), (23.5, 0.4 * (1.5 * 0.25 - 0.5)), (24.4, 0.4)] {
        let s = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], full, open);
        close(craft(&p, s).terminal_voltage(), open + want, 1e-12, "bend");
    }
}

/// The specific force in one moment, by effect, from equations written anew.
#[test]
fn forces_follow_the_equations() {
    let compact = parameters(&seed_class());
    let [vx, vy, vz] = [6.0, -8.0, -4.0];
    // Level at 0.2 m and throttle 0.6, a minute after 24 V, one command ahead of the rates.
    let s = State::new([0.0, 0.0, 0.2], [vx, vy, vz], [1.0, 0.0, 0.0, 0.0], [0.3, -0.2, 0.1, 0.2], 23.0);
    let felt = |vehicle: &Vehicle, s: State<f64>| {
        let mut craft = craft(vehicle, s);
        if let Some((_, memory)) = craft.extension() {
            memory.line[0] = [0.8, -0.4, 0.0, 0.2];
        }
        craft.specific_force()
    };
    let base = felt(&seed_class(), s);
    let lift = specific_thrust(&compact.thrust, 0.2, 23.0);
    let (throttle, error) = (0.6, 0.5 + 0.2 + 0.1);
    let full = seed_class().max_rates_rad_s();
    let behind = 0.5 * full[0] + 0.2 * full[1] + 0.1 * full[2];
    let [wx, wy, _] = s.body_rates(&compact);
    let (height, speed) = (0.25, 10.0);
    let [kx, ky, kz] = compact.drag;
    let damping = ((kx * vx).powi(2) + (ky * vy).powi(2) + (kz * vz).powi(2)).sqrt();
    let askew = (speed * speed + vz * vz).sqrt();
    let sinking = -vz / (1.6 * lift.sqrt());
    let wake = (-((sinking - 1.2) / 0.5_f64).powi(2)).exp() * (sinking / 0.6).min(1.0);
    let fade: f64 = 60.0 / 300.0;
    for (id, k, more) in [
        ("mixer_thrust_loss", 0.1, [0.0, 0.0, -0.1 * error * lift]),
        ("mixer_room", 0.058, [0.0, 0.0, specific_thrust(&compact.thrust, 1.0 - 0.116 * behind, 23.0) - lift]),
        ("thrust_fade", 0.08, [0.0, 0.0, -0.08 * fade * lift]),
        ("ground_effect", 10.0, [0.0, 0.0, 10.0 * (0.0635_f64 / (4.0 * height)).powi(2) * lift]),
        ("propwash", 0.3, [0.0, 0.0, -0.3 * wake * lift]),
        ("axial_inflow", 0.5, [0.0, 0.0, -0.5 * throttle * vz]),
        ("translational_lift", 0.01, [0.0, 0.0, 0.01 * speed * speed]),
        ("rate_thrust_coupling", 0.01, [0.0, 0.0, -0.01 * (wx * wx + wy * wy)]),
        ("axis_drag", 0.5, std::array::from_fn(|i| 0.5 * (damping - compact.drag[i] * askew) * [vx, vy, vz][i])),
        ("rotor_drag", 0.2, [-0.2 * throttle * vx, -0.2 * throttle * vy, 0.0]),
        ("drag_asymmetry", 0.005, [-0.005 * vx * vx, 0.0, 0.0]),
        ("body_lift", 0.01, [0.01 * vz * vx, 0.0, -0.01 * speed * vz]),
        ("vertical_drag", 0.2, [0.0, 0.0, -0.2 * vz]),
        ("mass_or_density", 0.2, base.map(|f| 0.2 * f)),
        ("throttle_offset", 0.03, [0.0, 0.0, specific_thrust(&compact.thrust, 0.26, 23.0) - lift]),
        ("voltage_compensation", 1.0, [0.0; 3]),
    ] {
        let got = felt(&one(id, &[k]), s);
        for i in 0..3 {
            close(got[i] - base[i], more[i], 1e-9, id);
        }
    }

    // Forms: drag that grows more, or less, than the speed, and never pushes, or not one way; of the whole flow; and
    // lift of one direction.
    for (id, k, axis, want) in [
        ("vertical_drag", &[0.2, 0.04, 0.0][..], 2, -(0.2 - 0.04) * vz),
        ("vertical_drag", &[0.02, 0.04, 0.0], 2, 0.0),
        ("vertical_drag", &[0.2, 0.04, 0.5], 2, -(0.2 - 0.04) * (vz + 0.5 * vz.abs())),
        ("vertical_drag", &[0.2, 0.04, -vz.signum()], 2, 0.0),
        ("vertical_drag", &[0.2, 0.0, 0.0, 0.01], 2, -(0.2 + 0.01 * speed) * vz),
        ("axial_inflow", &[0.5, 0.01], 2, -(0.5 * throttle + 0.01 * speed) * vz),
        ("axial_inflow", &[0.5, -1.0], 2, 0.0),
        ("translational_lift", &[0.01, 0.004], 2, 0.014 * vx * vx + 0.006 * vy * vy),
        ("drag_asymmetry", &[0.005, 0.5], 0, -0.005 * vx.abs() * (0.5 * vx.abs() + 0.5 * askew)),
    ] {
        close(felt(&one(id, k), s)[axis] - base[axis], want, 1e-9, id);
    }

    // Half way between full and empty nothing is compensated, elsewhere all or half of it.
    for (share, heard) in [(1.0, 23.0), (0.5, 22.75)] {
        let s = State { voltage: 22.5, ..s };
        let got = felt(&one("voltage_compensation", &[share]), s);
        let rest = base[2] - lift;
        close(got[2], rest + specific_thrust(&compact.thrust, 0.2, heard), 1e-9, "compensation");
    }

    // Nose to the left: y of the world is forward. In the wind, only the air's speed counts.
    let half = 0.5_f64.sqrt();
    let turned = State { attitude: [half, 0.0, 0.0, half], ..s };
    let windy = felt(&one("steady_wind", &[2.0, -3.0]), turned);
    let calm = felt(&seed_class(), State { velocity: [vx - 2.0, vy + 3.0, vz], ..turned });
    for i in 0..3 {
        close(windy[i], calm[i], 1e-9, "wind");
    }
}

/// Effects on one quantity act in the order of the list: what scales the thrust first, what scales everything last.
#[test]
fn effects_act_together() {
    let s = State::new([0.0, 0.0, 9.0], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.2], 23.0);
    let vehicle = with(with(seed_class(), "axial_inflow", &[0.5]), "thrust_fade", &[0.1]);
    let vehicle = with(with(vehicle, "mass_or_density", &[0.2]), "voltage_sag", &[1.0]);
    let p = parameters(&vehicle);
    let drag = craft(&seed_class(), s).specific_force()[2] - specific_thrust(&p.thrust, 0.2, 23.0);
    let lift = specific_thrust(&p.thrust, 0.2, 23.0 - 0.36) * (1.0 - 0.1 * 0.2) - 0.5 * 0.6 * 2.0;
    close(craft(&vehicle, s).specific_force()[2], 1.2 * (lift + drag), 1e-9, "all together");
}

/// Draws have the covariance that the file asks for, and stay within the bounds of the search.
#[test]
fn draws_are_joint() {
    let covariance = vec![vec![0.04, 0.015], vec![0.015, 0.01]];
    let sizes = |id: &str, k: f64| (id.to_string(), BTreeMap::from([("k".to_string(), k)]));
    let extension = Extension {
        source: None,
        sizes: BTreeMap::from([sizes("axial_inflow", 0.1), sizes("rotor_drag", 0.3), sizes("body_lift", 0.01)]),
        uncertain: vec!["axial_inflow.k".into(), "rotor_drag.k".into()],
        covariance: covariance.clone(),
    };
    let at = ["axial_inflow", "rotor_drag"].map(|id| effects::span(id).expect("listed").start);
    let rng = Philox::new(7);
    let n = 2000;
    let (mut mean, mut square) = ([0.0; 2], [[0.0; 2]; 2]);
    for draw in 0..n {
        let by = extension.draw(&mut rng.sequence(RngStream::Reset, draw, 0));
        assert_eq!(by.iter().filter(|k| **k != 0.0).count(), 2);
        let x = at.map(|i| by[i]);
        for i in 0..2 {
            mean[i] += x[i] / f64::from(n);
            (0..2).for_each(|j| square[i][j] += x[i] * x[j] / f64::from(n));
        }
        let drawn = extension.drawn(&by);
        assert_eq!(drawn[at[0]], (0.1 + x[0]).clamp(0.0, 4.0));
        assert_eq!(drawn[effects::span("body_lift").expect("listed").start], 0.01);
    }
    for i in 0..2 {
        // Five standard errors.
        let error = |i: usize, j: usize| {
            let spread = covariance[i][i] * covariance[j][j] + covariance[i][j] * covariance[i][j];
            5.0 * (spread / f64::from(n)).sqrt()
        };
        close(mean[i], 0.0, 5.0 * (covariance[i][i] / f64::from(n)).sqrt(), "mean");
        (0..2).for_each(|j| close(square[i][j], covariance[i][j], error(i, j), "covariance"));
    }
}

#[test]
fn sensors_read_as_their_equations_say() {
    let read = |id: &str, sizes: &[f64]| {
        let mut k = [0.0; LOG_COUNT];
        let span = effects::span(id).expect("listed");
        k[span.start - COUNT..span.end - COUNT].copy_from_slice(sizes);
        let mut sensed =
            Sensed { rates: [1.0, 2.0, 3.0], acceleration: [0.0; 3], force: [0.0, 0.0, 10.0], throttle: 0.5 };
        effects::SensorErrors::new(&k).sense(&mut sensed);
        (sensed.rates, sensed.force)
    };
    assert_eq!(read("stream_offset", &[0.01]), ([1.0, 2.0, 3.0], [0.0, 0.0, 10.0]));
    // w x (w x r) of r = x: (w . r) w - w^2 r.
    assert_eq!(read("imu_lever_arm", &[1.0, 0.0, 0.0]).1, [1.0 - 14.0, 2.0, 10.0 + 3.0]);
    assert_eq!(read("com_offset", &[1.0, 0.0, 0.0]), read("imu_lever_arm", &[1.0, 0.0, 0.0]));
    // r x f of r = x and f = z is -y.
    assert_eq!(read("accel_misalignment", &[0.1, 0.0, 0.0]), ([1.0, 2.0, 3.0], [0.0, -1.0, 10.0]));
    assert_eq!(read("imu_misalignment", &[0.1, 0.0, 0.0]), ([1.0, 2.0 - 0.1 * 3.0, 3.0 + 0.2], [0.0, -1.0, 10.0]));
    assert_eq!(read("accel_scale", &[0.1, 0.2, 0.5]).1, [0.0, 0.0, 15.0]);
    assert_eq!(read("accel_bias", &[0.5, 0.25, 1.0]).1, [0.5, 0.25, 11.0]);
    assert_eq!(read("gyro_scale", &[0.5, 0.1, -0.5]).0, [1.5, 2.2, 1.5]);
    assert_eq!(read("gyro_bias", &[0.5, 0.25, 1.0]).0, [1.5, 2.25, 4.0]);
    assert_eq!(read("vibration_rectification", &[4.0, 8.0, 12.0]).1, [1.0, 2.0, 13.0]);
}
