//! What the independent simulator hides does what it says: each effect against numbers worked out by hand.

use crate::truth;
use crate::truth::effects::{Hidden, catalogue, clutter, drifted, outside, unmatched};
use crate::truth::hidden::link::Link;
use crate::truth::hidden::motion::{Inputs, flow, slope, specific_force};
use crate::truth::hidden::motors::Controller;
use crate::truth::hidden::weather::{Air, Weather};
use crate::truth::hidden::{Craft, Setting, Style, World, battery, fly, inflow, inner};
use crate::truth::{State, Vehicle, integrate};
use nalgebra::{Vector3, Vector4};
use rand::SeedableRng;
use rand::rngs::StdRng;
use std::f64::consts::PI;

const DT: f64 = 0.0005;

fn rng() -> StdRng {
    StdRng::seed_from_u64(3)
}

fn one(id: &str, size: f64, vehicle: &Vehicle) -> Hidden {
    Hidden::sized(id, size, vehicle, &mut rng())
}

/// A world with one effect in it.
fn world(id: &str, size: f64) -> World {
    let vehicle = Vehicle::seed_class();
    World::new(&vehicle, &[one(id, size, &vehicle)])
}

fn still() -> Air {
    Air { force: Vector3::zeros(), velocity: Vector3::zeros() }
}

/// Aloft, level, thrust settled at the command `u`.
fn aloft(u: f64) -> Craft {
    let position = Vector3::new(0.0, 0.0, 1e4);
    Craft { position, u, motors: Vector4::repeat(0.5 + 0.5 * u), resting: false, ..Craft::on_ground() }
}

/// Flies `craft` with the commands that `script` gives at 100 Hz; the state at every step of 0.5 ms.
fn flown(world: &World, craft: Craft, seconds: f64, script: &dyn Fn(f64) -> [f64; 4]) -> Vec<Craft> {
    let mut link = Link::new(&world.terms, 1);
    let mut controller = Controller::default();
    let mut states = vec![craft];
    for k in 0..(seconds / DT).round() as usize {
        let now = k as f64 * DT;
        if k % 20 == 0 {
            link.send(now, script(now));
        }
        let craft = &states[k];
        let motors = controller.next(craft, world, &link, now, DT);
        let inputs = Inputs { link: &link, air: still(), motors };
        states.push(flow(craft, world, &inputs, now, now + DT));
    }
    states
}

/// Force and change of the state of `craft` while `command` is held.
fn moment(world: &World, craft: &Craft, command: [f64; 4], time: f64) -> (Vector3<f64>, Craft) {
    let mut link = Link::new(&world.terms, 1);
    link.send(time - 0.2, command);
    let inputs = Inputs { link: &link, air: still(), motors: Vector4::zeros() };
    (specific_force(craft, world, &inputs, command, time), slope(craft, world, &inputs, command, time))
}

fn roll_step(_: f64) -> [f64; 4] {
    [0.5, 0.0, 0.0, 0.0]
}

fn setting(seconds: f64, noise: f64, style: Style) -> Setting {
    Setting { seed: 11, seconds, noise, imu_hz: 500.0, style }
}

#[test]
fn without_anything_hidden_it_is_the_simulator_it_extends() {
    let vehicle = Vehicle::draw(4);
    let world = World::new(&vehicle, &[]);
    let script = |t: f64| [(3.0 * t).sin(), (2.0 * t).cos(), 0.3, 0.2];
    let states = flown(&world, aloft(0.1), 2.0, &script);
    let response = Vector4::new(0.0, 0.0, 0.0, 0.1);
    let position = Vector3::new(0.0, 0.0, 1e4);
    let mut state = State { position, response, resting: false, ..State::on_ground(&vehicle) };
    for k in 0..4000 {
        state = integrate::step(&state, &vehicle, script((k / 20) as f64 * 0.01), DT);
    }
    let last = states.last().expect("states");
    assert!((last.velocity - state.velocity).norm() < 1e-9, "{last:?} {state:?}");
    assert!((inner::body_rates(last, &world.terms) - state.rates(&vehicle)).norm() < 1e-9);
}

#[test]
fn a_delayed_command_acts_later_by_exactly_the_delay() {
    let script = |t: f64| [(40.0 * t).sin(), 0.0, 0.0, (25.0 * t).cos()];
    let prompt = flown(&world("rate_delay", 0.0), aloft(0.0), 0.5, &script);
    let late = flown(&world("rate_delay", 0.0123), aloft(0.0), 0.5, &script);
    // 12.3 ms are no whole number of steps: between two states the lag is exact to the fourth order.
    let world = world("rate_delay", 0.0);
    let link = Link::new(&world.terms, 1);
    for k in [200, 431, 777] {
        let (now, edge) = (k as f64 * DT - 0.0123, ((k as f64 * DT - 0.0123) / DT).floor() as usize);
        let mut held = Link::new(&world.terms, 1);
        held.send(now - 0.05, script((edge / 20) as f64 * 0.01));
        let inputs = Inputs { link: &held, air: still(), motors: Vector4::zeros() };
        let exact = flow(&prompt[edge], &world, &inputs, edge as f64 * DT, now);
        assert!((late[k].rates - exact.rates).norm() < 1e-6, "{k}: {} {}", late[k].rates, exact.rates);
        assert!((late[k].u - prompt[k].u).abs() < 1e-6, "thrust is not delayed");
    }
    assert_eq!(link.at(0.0), [0.0, 0.0, 0.0, -1.0]);
}

#[test]
fn the_second_order_overshoots_as_it_must() {
    for zeta in [0.5, 0.9] {
        let mut world = world("rate_second_order", 80.0);
        world.terms.second_order = Some([80.0, zeta]);
        let reached = 0.5 * world.vehicle.max_rate[0];
        let most = flown(&world, aloft(0.0), 0.4, &roll_step).iter().map(|s| s.rates.x).fold(0.0, f64::max);
        let wanted = 1.0 + (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
        assert!((most / reached - wanted).abs() < 2e-3, "zeta {zeta}: {} instead of {wanted}", most / reached);
    }
}

#[test]
fn limits_and_curves_of_the_inner_loop() {
    let limited = flown(&world("rate_slew_limit", 150.0), aloft(0.0), 0.1, &|_| [1.0, 0.0, 1.0, 0.0]);
    assert!((limited[40].rates.x - 150.0 * 0.02).abs() < 1e-9, "{}", limited[40].rates.x);
    assert!((limited[20].rates.z - 45.0 * 0.01).abs() < 1e-9, "{}", limited[20].rates.z);

    let limited = flown(&world("yaw_slew_limit", 30.0), aloft(0.0), 0.1, &|_| [1.0, 0.0, 1.0, 0.0]);
    assert!((limited[20].rates.z - 30.0 * 0.01).abs() < 1e-9, "{}", limited[20].rates.z);

    let world_of = world("rate_expo", 0.4);
    let wanted = inner::wanted(&aloft(0.0), &world_of, [0.5, 1.0, 0.0, 0.0]);
    assert!((wanted.x / world_of.vehicle.max_rate[0] - (0.6 * 0.5 + 0.4 * 0.125)).abs() < 1e-12);
    assert!((wanted.y - world_of.vehicle.max_rate[1]).abs() < 1e-12);

    let world_of = world("yaw_authority_loss", 0.5);
    let yaw = |u: f64| inner::wanted(&aloft(u), &world_of, [0.0, 0.0, 1.0, 0.0]).z / world_of.vehicle.max_rate[2];
    assert_eq!([yaw(0.6), yaw(0.8), yaw(1.0)].map(|x| (x * 1e9).round() / 1e9), [1.0, 0.75, 0.5]);
}

#[test]
fn responses_slow_down_with_the_voltage() {
    let world = world("response_voltage", 0.2);
    let early = moment(&world, &aloft(0.0), [1.0, 0.0, 0.0, 0.0], 0.0).1.rates.x;
    let late = moment(&world, &aloft(0.0), [1.0, 0.0, 0.0, 0.0], 150.0).1.rates.x;
    // A volt less after half of two volts.
    assert!((early / late - 1.2).abs() < 1e-9, "{early} {late}");
}

#[test]
fn rates_couple() {
    let turning = Craft { rates: Vector3::new(2.0, 3.0, 5.0), ..aloft(0.0) };
    let world_of = world("rate_cross_coupling", 0.1);
    let [xy, yx] = world_of.terms.cross;
    let w = inner::body_rates(&turning, &world_of.terms);
    assert!((w - Vector3::new(2.0 + 3.0 * xy, 3.0 + 2.0 * yx, 5.0)).norm() < 1e-12 && xy.abs() == 0.1);

    let of = |size: f64| moment(&world("gyroscopic_coupling", size), &turning, [0.0; 4], 0.0).1.rates;
    assert!((of(0.04) - of(0.0) - Vector3::new(0.04 * 15.0, -0.04 * 10.0, 0.0)).norm() < 1e-12);

    let world_of = world("weak_motor", 0.4);
    let w = inner::body_rates(&aloft(0.5), &world_of.terms);
    assert!(w.iter().all(|x| (x.abs() - 0.3).abs() < 1e-12) && w.x * w.y * w.z < 0.0, "{w}");
}

#[test]
fn voltage_sags_relaxes_and_curves() {
    let sag = world("voltage_sag", 3.0);
    let volts = |world: &World, u: f64, t: f64| battery::terminal(&aloft(u), world, t);
    assert!((volts(&sag, -1.0, 0.0) - volts(&sag, 0.2, 0.0) - 3.0 * 0.36).abs() < 1e-12);

    let mut relaxing = world("voltage_relaxation", 1.5);
    relaxing.terms.relaxation = Some([1.5, 0.2]);
    let lost = flown(&relaxing, aloft(0.0), 0.2, &|_| [0.0; 4]).last().expect("states").relaxed;
    assert!((lost - 1.5 * 0.25 * (1.0 - (-1.0f64).exp())).abs() < 1e-9, "{lost}");

    let curved = world("ocv_curve", 0.5);
    let plain = world("ocv_curve", 0.0);
    let more = |t: f64| volts(&curved, 0.0, t) - volts(&plain, 0.0, t);
    assert!((more(0.0) - 0.5).abs() < 1e-12 && more(150.0).abs() < 1e-12 && (more(300.0) + 0.5).abs() < 1e-12);

    let held = world("voltage_compensation", 1.0);
    assert!(
        (moment(&held, &aloft(0.0), [0.0; 4], 0.0).0 - moment(&held, &aloft(0.0), [0.0; 4], 290.0).0).norm() < 1e-12
    );

    // A cell under full load loses what its two resistances take, in the end.
    let vehicle = Vehicle::seed_class();
    let circuit = World::new(&vehicle, &[unmatched::draw("cell_circuit", &vehicle, &mut rng())]);
    let of = circuit.terms.circuit.expect("a circuit");
    let loaded = Craft { relaxed: of.later, ..aloft(1.0) };
    assert!((battery::terminal(&loaded, &circuit, 0.0) - (vehicle.full_v - of.at_once - of.later)).abs() < 1e-9);
    assert!(battery::change(&loaded, &circuit)[0].abs() < 1e-12);
}

/// What the effect adds to the specific force of a craft at `v` (body is world), thrust command `u`.
fn added(id: &str, size: f64, u: f64, v: [f64; 3], rates: [f64; 3], time: f64) -> Vector3<f64> {
    let craft = Craft { velocity: Vector3::from(v), rates: Vector3::from(rates), ..aloft(u) };
    let of = |size: f64| moment(&world(id, size), &craft, [0.0, 0.0, 0.0, u], time).0;
    of(size) - of(0.0)
}

#[test]
fn forces_are_those_of_the_catalogue() {
    let v = [6.0, -3.0, 2.0];
    let thrust = |u: f64, volts: f64| truth::thrust::per_mass(&Vehicle::seed_class(), u, volts);
    let full = thrust(0.2, 24.0);
    for (id, size, expected) in [
        ("axial_inflow", 1.0, [0.0, 0.0, -0.6 * 2.0]),
        ("translational_lift", 0.01, [0.0, 0.0, 0.45]),
        ("rotor_drag", 0.4, [-0.4 * 0.6 * 6.0, 0.4 * 0.6 * 3.0, 0.0]),
        ("drag_asymmetry", 0.005, [-0.18, 0.0, 0.0]),
        ("body_lift", 0.01, [0.12, 0.0, -0.01 * 45.0f64.sqrt() * 2.0]),
        ("vertical_drag", 0.2, [0.0, 0.0, -0.4]),
        ("rate_thrust_coupling", 0.01, [0.0, 0.0, -0.01 * 5.0]),
        ("throttle_offset", 0.05, [0.0, 0.0, thrust(0.3, 24.0) - full]),
        ("mixer_thrust_loss", 0.1, {
            let max = Vehicle::seed_class().max_rate;
            [0.0, 0.0, -0.1 * full * (1.0 / max[0] + 2.0 / max[1] + 0.5 / max[2])]
        }),
    ] {
        let got = added(id, size, 0.2, v, [1.0, 2.0, 0.5], 0.0);
        assert!((got - Vector3::from(expected)).norm() < 1e-9, "{id}: {got} instead of {expected:?}");
    }
    // Along an axis nothing changes; between two, the same axis brakes as much as the whole speed does along it.
    let vehicle = Vehicle::seed_class();
    let along = |v: [f64; 3]| truth::drag::per_mass(&vehicle, &Vector3::from(v));
    assert!(added("axis_drag", 1.0, 0.2, [0.0, 0.0, 5.0], [0.0; 3], 0.0).norm() < 1e-12);
    let askew = added("axis_drag", 0.5, 0.2, [3.0, 0.0, 4.0], [0.0; 3], 0.0);
    let wanted = Vector3::new(along([5.0, 0.0, 0.0]).x * 0.6, 0.0, along([0.0, 0.0, 5.0]).z * 0.8);
    assert!((askew - (wanted - along([3.0, 0.0, 4.0])) * 0.5).norm() < 1e-12, "{askew}");
    let faded = added("thrust_fade", 0.06, 0.2, [0.0; 3], [0.0; 3], 150.0);
    assert!((faded.z + 0.03 * thrust(0.2, 23.0)).abs() < 1e-9, "{faded}");
    let heavy = added("mass_or_density", -0.2, 0.2, v, [0.0; 3], 0.0);
    let plain =
        moment(&world("mass_or_density", 0.0), &Craft { velocity: Vector3::from(v), ..aloft(0.2) }, [0.0; 4], 0.0).0;
    assert!((heavy + plain * 0.2).norm() < 1e-9);
}

#[test]
fn flow_through_the_rotor() {
    // Sinking at 1.2 induced velocities costs the share, climbing nothing, and near the ground there is more.
    let full = truth::thrust::per_mass(&Vehicle::seed_class(), 0.0, 24.0);
    let sink = -1.2 * 1.6 * full.sqrt();
    assert!((added("propwash", 0.3, 0.0, [0.0, 0.0, sink], [0.0; 3], 0.0).z + 0.3 * full).abs() < 1e-9);
    assert_eq!(added("propwash", 0.3, 0.0, [0.0, 0.0, 4.0], [0.0; 3], 0.0).z, 0.0);
    let low = Craft { position: Vector3::new(0.0, 0.0, 0.2), ..aloft(0.0) };
    let gain = moment(&world("ground_effect", 10.0), &low, [0.0; 4], 0.0).0.z / full - 1.0;
    assert!((gain - 10.0 * (0.0635f64 / 1.0).powi(2)).abs() < 1e-9, "{gain}");

    // Glauert's equation holds, hover is hover, and climbing slowly costs about what the catalogue says.
    for v in [[0.0, 0.0, 0.0], [8.0, 2.0, 0.0], [3.0, 0.0, 4.0], [5.0, 0.0, -3.0]].map(Vector3::from) {
        let induced = inflow::induced(5.0, &v);
        let residual = induced * (v.xy().norm_squared() + (v.z + induced).powi(2)).sqrt() - 25.0;
        assert!(residual.abs() < 1e-6, "{v}: {residual}");
    }
    assert!((inflow::thrust(10.0, &Vector3::zeros(), 0.1) - 10.0).abs() < 1e-6);
    assert!(inflow::thrust(10.0, &Vector3::z(), 0.1) < 10.0 && inflow::thrust(10.0, &(Vector3::x() * 9.0), 0.1) > 10.0);
}

#[test]
fn thrust_lags_by_its_direction() {
    let world = world("thrust_asymmetric_lag", 2.0);
    let change = |u: f64, to: f64| moment(&world, &aloft(u), [0.0, 0.0, 0.0, to], 0.0).1.u.abs();
    assert!((change(0.0, 0.5) / change(0.5, 0.0) - 2.0).abs() < 1e-9);
    let [up, down] = world.terms.thrust_lag.expect("two lags");
    assert!(((up * down).sqrt() - world.vehicle.tau[3]).abs() < 1e-12);
}

#[test]
fn weather_is_as_strong_and_as_slow_as_it_says() {
    for (id, size) in [("gusts", 0.7), ("turbulence", 2.0)] {
        let vehicle = Vehicle::seed_class();
        let mut terms = World::new(&vehicle, &[]).terms;
        let strength = Some([size, 0.5]);
        if id == "gusts" {
            terms.gusts = strength
        } else {
            terms.turbulence = strength
        }
        let mut weather = Weather::new(&terms, 5);
        let series: Vec<f64> = (0..800_000)
            .map(|_| weather.next(0.005))
            .map(|air| if id == "gusts" { air.force.x } else { air.velocity.x })
            .collect();
        let with = |lag: usize| {
            series.iter().zip(&series[lag..]).map(|(a, b)| a * b).sum::<f64>() / (series.len() - lag) as f64
        };
        assert!((with(0).sqrt() / size - 1.0).abs() < 0.06, "{id}: {}", with(0).sqrt());
        let half_second = with(100) / with(0);
        let wanted = if id == "gusts" { (-1.0f64).exp() } else { 2.0 * (-1.0f64).exp() };
        assert!((half_second - wanted).abs() < 0.06, "{id}: {half_second}");
    }
    // Wind is felt by what stands still in the world.
    let world = world("steady_wind", 3.0);
    assert!(moment(&world, &aloft(0.0), [0.0; 4], 0.0).0.xy().norm() > 0.1);
    assert!((world.terms.wind[0].hypot(world.terms.wind[1]) - 3.0).abs() < 1e-12);
}

#[test]
fn commands_are_lost_as_often_as_said() {
    let world = world("command_dropout", 0.2);
    let mut link = Link::new(&world.terms, 9);
    let sent = 20_000;
    let lost = (1..=sent)
        .filter(|k| {
            let (time, command) = (f64::from(*k) * 0.01, f64::from(*k) / f64::from(sent));
            link.send(time, [command; 4]);
            link.at(time)[0] != command
        })
        .count();
    assert!((lost as f64 / f64::from(sent) - 0.2).abs() < 0.01, "{lost}");
}

#[test]
fn sensors_are_wrong_as_said() {
    let vehicle = Vehicle::draw(2);
    let quiet = setting(28.0, 0.0, Style::Excited);
    let clean = fly(&vehicle, &[], &quiet);
    let of = |id: &str, size: f64| fly(&vehicle, &[one(id, size, &vehicle)], &quiet);

    // The gyro of 4 ms, two samples, ago; the accelerometer is not touched.
    let late = of("stream_offset", 0.004);
    for k in [4000, 6123, 8888] {
        assert!((0..3).all(|i| (late.imu.rows[k][i] - clean.imu.rows[k - 2][i]).abs() < 1e-6), "{k}");
        assert_eq!(late.imu.rows[k][3..], clean.imu.rows[k][3..]);
    }
    let skewed = of("clock_skew", -0.01);
    assert!((skewed.imu.time_s[9000] - 0.99 * clean.imu.time_s[9000]).abs() < 1e-9);
    assert_eq!(skewed.setpoint.time_s, clean.setpoint.time_s);
    assert_eq!(skewed.imu.rows, clean.imu.rows);

    let scaled = of("gyro_scale", 0.02);
    let biased = of("accel_bias", 0.3);
    let turned = of("imu_misalignment", 0.05);
    let shaken = of("vibration_rectification", 0.4);
    let row = |log: &racer::flight::Log, k: usize, from: usize| Vector3::from_fn(|i, _| log.imu.rows[k][from + i]);
    let lengths = |k: usize| (row(&clean, k, 3).norm(), row(&turned, k, 3).norm());
    for k in [5000, 7000] {
        assert!((row(&scaled, k, 0) - row(&clean, k, 0) * 1.02).norm() < 1e-9);
        assert!(((row(&biased, k, 3) - row(&clean, k, 3)).norm() - 0.3).abs() < 1e-9);
        assert!((lengths(k).0 - lengths(k).1).abs() < 1e-9 && (row(&turned, k, 3) - row(&clean, k, 3)).norm() > 0.01);
        let more = row(&shaken, k, 3) - row(&clean, k, 3);
        assert!((more.x - 0.3 * more.z).abs() < 1e-9 && more.z >= 0.0 && more.z < 0.4);
    }
    assert!((0..9000).any(|k| row(&shaken, k, 3).z - row(&clean, k, 3).z > 0.05), "throttle shakes");
    // A steady spin about z throws what sits aside outwards.
    let mut world = world("imu_lever_arm", 0.02);
    world.terms.lever = Vector3::new(0.02, 0.0, 0.0);
    let spinning = Craft { rates: Vector3::new(0.0, 0.0, 10.0), ..aloft(0.0) };
    let w = inner::body_rates(&spinning, &world.terms);
    assert!((w.cross(&w.cross(&world.terms.lever)).x + 2.0).abs() < 1e-12);
    let long = setting(60.0, 0.0, Style::Excited);
    let [apart, centred] =
        [&[one("imu_lever_arm", 0.02, &vehicle)][..], &[]].map(|hidden| fly(&vehicle, hidden, &long));
    assert!((0..centred.imu.len()).any(|k| (row(&apart, k, 3) - row(&centred, k, 3)).norm() > 0.5));

    // The velocity of a ramp is late by the lag: compare in the world.
    let slow = of("velocity_lag", 0.05);
    let north = |log: &racer::flight::Log, k: usize| {
        let row = log.odometry.rows[k];
        let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]));
        q * Vector3::new(row[7], row[8], row[9])
    };
    let times = &clean.odometry.time_s;
    let period = times[1] - times[0];
    let mut estimate = Vector3::zeros();
    for k in 0..times.len() {
        // Of a low-pass fed with samples; finer than the tolerance by far.
        estimate += (north(&clean, k) - estimate) * (1.0 - (-period / 0.05).exp());
        assert!((estimate - north(&slow, k)).norm() < 1.0, "{k}");
    }
    assert!((0..times.len()).any(|k| (north(&slow, k) - north(&clean, k)).norm() > 0.3));
}

#[test]
fn the_motors_follow_their_commands_but_not_as_a_lag() {
    let vehicle = Vehicle::seed_class();
    let hidden = unmatched::draw("motor_loop", &vehicle, &mut rng());
    let world = World::new(&vehicle, &[hidden]);
    let states = flown(&world, aloft(0.0), 0.6, &roll_step);
    let wanted = 0.5 * vehicle.max_rate[0];
    let last = states.last().expect("states");
    assert!((last.rates.x / wanted - 1.0).abs() < 0.02, "{} of {wanted}", last.rates.x);
    // Slow at first, which no first-order lag is, and there in time.
    let at = |ms: usize| states[2 * ms].rates.x / wanted;
    assert!(at(3) < 0.12 && at(60) > 0.8, "{} {}", at(3), at(60));
    assert!(last.u.abs() < 0.05, "thrust stays: {}", last.u);
}

/// Whether the flight is one: finite, in the air, within bounds, back on the ground.
fn assert_sane(log: &racer::flight::Log, name: &str, seconds: f64) {
    assert!(log.imu.rows.iter().flatten().all(|x| x.is_finite()), "{name}: the IMU");
    assert!(log.odometry.rows.iter().flatten().all(|x| x.is_finite()), "{name}: odometry");
    assert!((log.imu.len() as f64 - 500.0 * seconds).abs() < 2.0, "{name}: {} samples", log.imu.len());
    let reach = log.odometry.rows.iter().map(|row| row[0].hypot(row[1])).fold(0.0, f64::max);
    let height = log.odometry.rows.iter().map(|row| row[2]).fold(0.0, f64::max);
    let speed = log.odometry.rows.iter().map(|row| Vector3::new(row[7], row[8], row[9]).norm()).fold(0.0, f64::max);
    assert!(reach < 170.0 && height < 110.0, "{name}: {reach} m away, {height} m high");
    assert!(speed > 4.0 && speed < 60.0, "{name}: {speed} m/s");
    // Nobody sits on the ground in the middle of a flight.
    let grounded = log
        .odometry
        .rows
        .iter()
        .zip(&log.odometry.time_s)
        .filter(|(row, t)| row[2] < 0.01 && **t > 6.0 && **t < seconds - 17.0);
    assert!(grounded.count() < 10, "{name}: on the ground");
}

#[test]
fn everything_that_can_be_hidden_flies_and_shows() {
    let seconds = 30.0;
    let quiet = setting(seconds, 0.0, Style::Excited);
    let mut random = rng();
    let mut vehicle = Vehicle::draw(21);
    // So that shares of two packs need no scaling here.
    vehicle.full_v = 25.0;
    let clean = fly(&vehicle, &[], &quiet);
    let catalogue = catalogue::CATALOGUE.iter().map(|entry| Hidden::draw(entry.id, &vehicle, &mut random));
    let mut all: Vec<Hidden> = catalogue.collect();
    all.extend(unmatched::KINDS.map(|kind| unmatched::draw(kind, &vehicle, &mut random)));
    all.extend(outside::KINDS.map(|kind| outside::draw(kind, 20.0, &mut random)));
    for hidden in all {
        let log = fly(&vehicle, std::slice::from_ref(&hidden), &quiet);
        assert_sane(&log, &hidden.id, seconds);
        assert!(log != clean, "{} shows nowhere", hidden.id);
    }
}

/// `cargo test --test inside -- --ignored --nocapture truth_hidden::largest`
#[test]
#[ignore = "a minute; prints a table"]
fn the_largest_sizes_fly_too() {
    let mut random = rng();
    for (k, entry) in catalogue::CATALOGUE.iter().enumerate() {
        let vehicle = Vehicle::draw(100 + k as u64);
        let extreme = if entry.grows_downwards() { 0 } else { 1 };
        let hidden = [Hidden::sized(entry.id, entry.range(&vehicle)[extreme], &vehicle, &mut random)];
        for style in [Style::Excited, Style::Race] {
            let log = fly(&vehicle, &hidden, &Setting { seed: k as u64, ..setting(120.0, 1.0, style) });
            let most = |f: &dyn Fn(&[f64; 10]) -> f64| log.odometry.rows.iter().map(f).fold(0.0, f64::max);
            let (reach, height) = (most(&|row| row[0].hypot(row[1])), most(&|row| row[2]));
            let speed = most(&|row| Vector3::new(row[7], row[8], row[9]).norm());
            let low = log
                .odometry
                .rows
                .iter()
                .zip(&log.odometry.time_s)
                .filter(|(row, t)| row[2] < 0.06 && **t > 6.0 && **t < 103.0);
            let low = low.count() as f64 / log.odometry.len() as f64;
            println!(
                "{:<26}{style:?}: {reach:.0} m away, {height:.0} m high, {speed:.0} m/s, on the ground {:.1} %",
                entry.id,
                100.0 * low
            );
            assert!(reach < 250.0 && height < 130.0);
        }
    }
}

#[test]
fn nothing_of_size_zero_shows() {
    let vehicle = Vehicle::draw(5);
    let short = setting(4.0, 1.0, Style::Excited);
    let clean = fly(&vehicle, &[], &short);
    for entry in catalogue::CATALOGUE.iter().filter(|entry| entry.shrinks()) {
        let log = fly(&vehicle, &[one(entry.id, 0.0, &vehicle)], &short);
        let apart = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let most = log.imu.rows.iter().zip(&clean.imu.rows).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
        assert!(most < 1e-6, "{}: {most}", entry.id);
    }
}

#[test]
fn races_are_flown_without_excitation() {
    for seed in 0..4 {
        let vehicle = Vehicle::draw(seed);
        let hidden = if seed == 3 { clutter(&vehicle, &mut rng()) } else { Vec::new() };
        let log = fly(&vehicle, &hidden, &Setting { seed, ..setting(60.0, 1.0, Style::Race) });
        assert_sane(&log, &format!("race {seed}"), 60.0);
        let speeds = log.odometry.rows.iter().map(|row| Vector3::new(row[7], row[8], row[9]).norm());
        let mean = speeds.sum::<f64>() / log.odometry.len() as f64;
        assert!(mean > 3.5, "race {seed}: {mean} m/s on average");
    }
}

/// What is hidden is the only thing wrong: without it, the check of a log has nothing to say.
#[test]
fn a_clean_flight_is_clean() {
    for (imu_hz, style) in [(100.0, Style::Excited), (1000.0, Style::Excited), (333.0, Style::Race)] {
        let log = fly(&Vehicle::draw(6), &[], &Setting { imu_hz, ..setting(60.0, 1.0, style) });
        let quality = racer::insight::quality::check(&log);
        let worst = quality.findings.iter().map(|finding| finding.severity).max();
        assert!(worst <= Some(racer::insight::quality::Severity::Note), "{imu_hz} Hz: {:?}", quality.findings);
    }
}

#[test]
fn draws_are_of_the_catalogues_sizes() {
    let mut random = rng();
    for entry in catalogue::CATALOGUE {
        let mut signs = [false; 2];
        for seed in 0..40 {
            let vehicle = Vehicle::draw(seed);
            let hidden = Hidden::draw(entry.id, &vehicle, &mut random);
            let [low, high] = entry.range(&vehicle);
            assert!(hidden.size.abs() >= low && hidden.size.abs() <= high && !hidden.parameters().is_empty());
            signs[usize::from(hidden.size > 0.0)] = true;
            assert!(hidden.is(entry.id));
        }
        assert_eq!(signs, [entry.signed, true], "{}", entry.id);
    }
    let vehicle = Vehicle::draw(8);
    let moved = drifted(&vehicle, &mut random);
    assert!(moved.tau != vehicle.tau || moved.max_rate != vehicle.max_rate || moved.thrust_n != vehicle.thrust_n);
    let many = clutter(&vehicle, &mut random);
    assert_eq!(many.len(), 11);
}
