//! The rules of the race: passing and missing gates, ends of episodes, resets, rewards, observations.

use racer::base::lane::{LANES, Lane, Portable};
use racer::base::rng::{Philox, RngStream};
use racer::learn::ppo::Environment;
use racer::model::dynamics::{Craft, Factors, State};
use racer::model::track::Track;
use racer::model::vehicle::Vehicle;
use racer::race::config::Config;
use racer::race::env::gates::crossing;
use racer::race::env::observe::{LAYOUT, OBSERVATIONS, layout};
use racer::race::env::reset::{self, Start, StartPlace};
use racer::race::env::reward::TERMS;
use racer::race::env::tally::RaceTally;
use racer::race::env::terminate::CAUSES;
use racer::race::env::{Block, Race};

type L = Portable<f32>;

fn race(settings: &str) -> (Race, Track) {
    let settings: Vec<_> =
        settings.split_whitespace().map(|s| racer::race::config::Setting::parse(s).unwrap()).collect();
    let config = Config::load("a2rl", &settings).unwrap();
    let track = Track::load("a2rl_s2").unwrap();
    let vehicle = Vehicle::load("seed_class").unwrap();
    (Race { noisy: false, ..Race::new(&config.env, &track, &vehicle, 1) }, track)
}

/// A block whose lanes all start at `position` with `velocity`, level and facing west, flying to `target`.
fn block(race: &Race, position: [f64; 3], velocity: [f64; 3], target: usize) -> Block<L> {
    let command = [0.0, 0.0, 0.0, race.hover_command];
    let state = State::new(position, velocity, [0.0, 0.0, 0.0, 1.0], command, 23.5);
    let start = Start {
        craft: Craft::new(&race.vehicle, &Factors::NOMINAL, racer::model::constants::CONTROL_S, state),
        target,
    };
    let mut block = race.empty_block(0);
    (0..LANES).for_each(|lane| block.begin(race, lane, &start));
    block
}

fn hover(race: &Race) -> [L; 4] {
    [0.0, 0.0, 0.0, race.hover_command as f32].map(L::splat)
}

fn observation(block: &Block<L>, race: &Race) -> Vec<Vec<f32>> {
    let mut out = vec![0.0; OBSERVATIONS * LANES];
    block.observe(race, &mut out, LANES);
    out.chunks(LANES).map(<[f32]>::to_vec).collect()
}

/// Whatever the speed, a straight line through the disk passes, one outside misses, and one from behind does nothing.
#[test]
fn a_gate_is_crossed_at_any_speed_and_from_one_side() {
    for speed in [1e-3, 0.1, 1.0, 20.0, 500.0] {
        for (y, z) in [(0.0, 0.0), (0.7, 0.2), (-0.5, -0.5), (0.8, 0.0), (0.0, -3.0)] {
            let (before, after) = ([-0.3 * speed, y, z], [0.7 * speed, y, z]);
            let there = crossing(before, after, 0.75);
            let inside = y * y + z * z <= 0.75 * 0.75;
            assert_eq!((there.passed, there.missed), (inside, !inside), "{speed} {y} {z}");
            assert!((there.fraction - 0.3f64).abs() < 1e-9);
            let back = crossing(after, before, 0.75);
            assert!(!back.passed && !back.missed);
        }
    }
    // A slanted line is judged where it meets the plane, not where the step ends.
    let slanted = crossing([-1.0f64, -2.0, 0.0], [1.0, 2.0, 0.0], 0.75);
    assert!(slanted.passed && slanted.fraction == 0.5);
    let parallel = crossing([-1.0f64, 0.0, 0.0], [-1.0, 5.0, 0.0], 0.75);
    assert!(!parallel.passed && !parallel.missed);
}

/// Flying west through gate 0 (12.5, 2, 1.35) gives the bonus, and gate 1 is next.
#[test]
fn passing_a_gate_pays_and_aims_at_the_next() {
    let (race, _) = race("");
    let mut block = block(&race, [12.55, 2.0, 1.35], [-10.0, 0.0, 0.0], 0);
    let outcome = block.step(&race, hover(&race));
    assert_eq!((outcome.passed, outcome.terminated), (0xffff, 0));
    assert!((outcome.fraction.get(0) - 0.5).abs() < 0.01);
    assert_eq!((block.target[3], block.passed[3]), (1, 1));
    let gate = TERMS.iter().position(|&t| t == "gate").unwrap();
    assert_eq!(outcome.terms[gate].get(0), race.config.reward.gate as f32);
    let sum: f32 = outcome.terms.iter().map(|t| t.get(0)).sum();
    assert!((outcome.reward.get(0) - sum).abs() < 1e-6);
    // The new target's frame: gate 1 stands 6 m further west and 4 m north.
    let distance = block.in_gate.iter().map(|x| x.get(0).powi(2)).sum::<f32>().sqrt();
    assert!((distance - 52.0f32.sqrt()).abs() < 0.1, "{distance}");
}

/// Every cause ends the episode it should end, and is logged as itself.
#[test]
fn causes_of_termination() {
    let cause = |settings: &str, position: [f64; 3], velocity: [f64; 3], change: fn(&mut Block<L>)| {
        let (race, _) = race(settings);
        let mut block = block(&race, position, velocity, 0);
        change(&mut block);
        let outcome = block.step(&race, hover(&race));
        assert!(outcome.truncated & outcome.terminated == 0);
        let causes: Vec<_> = (0..CAUSES.len()).filter(|&c| outcome.causes[c] & 1 == 1).map(|c| CAUSES[c]).collect();
        assert_eq!(outcome.terminated & 1 == 1, !causes.is_empty());
        causes
    };
    let still = [0.0; 3];
    assert!(cause("", [15.0, 2.0, 1.5], still, |_| {}).is_empty());
    assert_eq!(cause("", [12.55, 3.5, 1.35], [-10.0, 0.0, 0.0], |_| {}), ["missed_gate"]);
    assert_eq!(cause("", [1e3, 2.0, 1.5], still, |_| {}), ["left_volume"]);
    assert_eq!(cause("", [15.0, 2.0, -1.0], still, |_| {}), ["altitude"]);
    assert_eq!(cause("", [15.0, 2.0, 100.0], still, |_| {}), ["altitude"]);
    assert_eq!(cause("", [15.0, 2.0, 1.5], still, |b| b.craft.state.voltage = L::splat(21.9)), ["battery"]);
    assert_eq!(cause("", [15.0, 2.0, 1.5], still, |b| b.gate_clock = L::splat(399.0)), ["gate_timeout"]);
    assert_eq!(cause("", [15.0, 2.0, 1.5], still, |b| b.craft.state.velocity[1] = L::splat(f32::NAN)), ["non_finite"]);
}

/// At the horizon an episode that could have gone on is truncated; one that ended in the same step is terminated.
#[test]
fn the_horizon_truncates() {
    let (race, _) = race("env.horizon_steps=50");
    let mut block = block(&race, [15.0, 2.0, 1.5], [0.0; 3], 0);
    block.clock = L::splat(49.0);
    block.craft.state.position[2].set(5, -1.0);
    let outcome = block.step(&race, hover(&race));
    assert_eq!((outcome.truncated, outcome.terminated), (0xffff & !(1 << 5), 1 << 5));
}

/// Progress is the distance gained on the gate, time costs each step, a change of action costs its square.
#[test]
fn rewards_by_hand() {
    let (race, _) = race("env.reward.action_change=0.5 env.reward.progress=2 env.reward.time=0.25");
    let mut block = block(&race, [15.5, 2.0, 1.35], [-10.0, 0.0, 0.0], 0);
    let mut action = hover(&race);
    action[0] = L::splat(0.2);
    action[3] = action[3] + L::splat(0.4);
    let outcome = block.step(&race, action);
    let term = |name: &str| outcome.terms[TERMS.iter().position(|&t| t == name).unwrap()].get(0);
    assert!((term("progress") - 0.2).abs() < 1e-3, "{}", term("progress"));
    assert_eq!(term("time"), -0.25);
    assert!((term("action_change") + 0.5 * (0.04 + 0.16)).abs() < 1e-6);
    // It looks at the gate.
    assert!(term("facing").abs() < 1e-3);
    assert_eq!((term("gate"), term("timeout"), term("altitude")), (0.0, 0.0, 0.0));
    assert_eq!(block.history[0][0].get(0), 0.2);
}

/// Starts lie inside the volume, on the side from which their gate is passed wherever they are near it, with finite
/// states; the pad's are exactly the pad.
#[test]
fn starts() {
    let (race, track) = race("");
    let rng = Philox::new(3);
    for i in 0..5000 {
        let start = reset::draw(&race, &mut rng.sequence(RngStream::Reset, i, 0), StartPlace::Spline, None);
        let p: nalgebra::Vector3<f64> = start.craft.state.position.into();
        assert!(track.volume.contains(&p), "{p}");
        let gate = &track.gates[start.target];
        let seen = gate.rotation().transpose() * (p - gate.position());
        assert!(seen.x <= 0.0 || seen.norm() > 1.0, "start {i}, gate {}: {seen}", start.target);
        let norm = start.craft.state.attitude.iter().map(|x| x * x).sum::<f64>();
        assert!((norm - 1.0).abs() < 1e-12);
        let speed = start.craft.state.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        assert!(speed <= race.config.reset.speed_m_s[1]);
        assert!((22.2..24.0).contains(&start.craft.state.voltage));
    }
    for i in 0..200 {
        let gate = i as usize % track.gates.len();
        let start = reset::draw(&race, &mut rng.sequence(RngStream::Reset, i, 0), StartPlace::Toward(gate), None);
        let before = (gate + track.gates.len() - 1) % track.gates.len();
        assert!([before, gate].contains(&start.target), "toward {gate}, but to {} first", start.target);
    }
    let pad = reset::draw(&race, &mut rng.sequence(RngStream::Reset, 0, 0), StartPlace::Pad, Some(Factors::NOMINAL));
    assert_eq!((pad.craft.state.position, pad.target, pad.craft.state.voltage), (track.start.position_m, 0, 24.0));
}

/// After a failure, and after no other end, the next episode starts on the way to the gate that was missed.
#[test]
fn a_failure_is_tried_again() {
    let (race, _) = race("env.reset.retry_share=1");
    let targets = |clock: f32| {
        let mut block = block(&race, [5.0, 12.0, 1.35], [0.0; 3], 7);
        block.clock = L::splat(clock);
        Environment::reset(&race, &mut block, u16::MAX, &mut RaceTally::default());
        block.target
    };
    let again = targets(100.0);
    assert!(again.iter().all(|target| [6, 7].contains(target)), "{again:?}");
    let anywhere = targets(race.config.horizon_steps as f32);
    assert!(anywhere.iter().any(|target| ![6, 7].contains(target)), "{anywhere:?}");
}

/// Apertures are twice as wide when training begins, and as they are after five million steps or half of the budget.
#[test]
fn gates_are_wide_at_first() {
    let (race, _) = race("");
    let radius = |(steps, share)| Environment::at(&race, steps, share, 1.0).gates[0].radius;
    let found = [(0, 0.0), (2_500_000, 0.1), (5_000_000, 0.2), (1_000_000_000, 1.0), (50_000, 0.25)].map(radius);
    assert!(found.iter().zip([1.2, 0.9, 0.6, 0.6, 0.9]).all(|(r, expected)| (r - expected).abs() < 1e-6), "{found:?}");
    let outside = |race: &Race| {
        let mut block = block(race, [12.6, 2.9, 1.35], [-20.0, 0.0, 0.0], 0);
        let outcome = block.step(race, hover(race));
        (outcome.passed, outcome.terminated)
    };
    assert_eq!(outside(&race.at(0, 0.0, 1.0)), (u32::from(u16::MAX), 0));
    assert_eq!(outside(&race.at(5_000_000, 0.2, 1.0)), (0, u32::from(u16::MAX)));
}

/// Each factor stays in its range, fills it, and none follows another.
#[test]
fn randomised_parameters() {
    let (race, _) = race("");
    let rng = Philox::new(9);
    let draws: Vec<[f64; 9]> = (0..4000)
        .map(|i| {
            let f = race.config.randomize.draw(&mut rng.sequence(RngStream::Reset, i, 0));
            let [a, b, c, d] = f.time_constant;
            let [x, y, z] = f.max_rate;
            [a, b, c, d, x, y, z, f.thrust, f.drag]
        })
        .collect();
    for i in 0..9 {
        let column: Vec<f64> = draws.iter().map(|d| d[i]).collect();
        let (low, high) = column.iter().fold((2.0f64, 0.0f64), |(l, h), &x| (l.min(x), h.max(x)));
        assert!((0.8..0.801).contains(&low) && (1.199..1.2).contains(&high), "{i}: {low} {high}");
        for j in 0..i {
            let covariance = draws.iter().map(|d| (d[i] - 1.0) * (d[j] - 1.0)).sum::<f64>() / 4000.0;
            // The variance is 0.4^2 / 12; five standard errors of a correlation of zero.
            assert!(covariance.abs() < 5.0 * 0.0133 / 4000f64.sqrt(), "{i} {j}: {covariance}");
        }
    }
}

/// The observation holds what its layout says, in its units and frame.
#[test]
fn the_observation_is_its_layout() {
    let (race, track) = race("");
    let block = block(&race, [15.5, 3.0, 1.85], [-10.0, 1.0, 0.0], 0);
    let seen = observation(&block, &race);
    let of = |name: &str| {
        let layout = layout(&race.vehicle.battery);
        let at: usize = layout.iter().take_while(|g| g.name != name).map(|g| g.entries.len()).sum();
        let group = layout.iter().find(|g| g.name == name).unwrap();
        (0..group.entries.len()).map(|k| f64::from(seen[at + k][7]) / group.scale + group.offset).collect::<Vec<_>>()
    };
    let near = |a: Vec<f64>, b: &[f64]| {
        assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5), "{a:?} {b:?}")
    };
    // Gate 0 is crossed westwards: its x is west, its y south.
    near(of("position"), &[-3.0, -1.0, 0.5]);
    near(of("velocity"), &[10.0, -1.0, 0.0]);
    near(of("attitude"), &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    near(of("angular_rate"), &[0.0; 3]);
    near(of("command"), &[0.0, 0.0, 0.0, race.hover_command]);
    near(of("voltage"), &[23.5]);
    let to_next = track.gates[0].rotation().transpose() * (track.gates[1].position() - track.gates[0].position());
    near(of("next_gate"), to_next.as_slice());
    assert_eq!(OBSERVATIONS, LAYOUT.iter().map(|g| g.entries.len()).sum::<usize>());
}

/// Noise has the configured size and is drawn anew each step; without it the observation is exact.
#[test]
fn observation_noise() {
    let (quiet, _) = race("");
    let noisy = Race { noisy: true, ..quiet.clone() };
    let mut block = block(&quiet, [15.5, 3.0, 1.85], [-10.0, 1.0, 0.0], 0);
    let exact = observation(&block, &quiet);
    let (mut position, mut voltage, n) = (0.0, 0.0, 2000);
    for step in 0..n {
        block.step = step;
        let seen = observation(&block, &noisy);
        for lane in 0..LANES {
            position += f64::from(seen[1][lane] - exact[1][lane]).powi(2);
            voltage += f64::from(seen[34][lane] - exact[34][lane]).powi(2);
        }
    }
    let sd = |sum: f64| (sum / f64::from(n * LANES as u32)).sqrt();
    assert!((sd(position) / (0.1 * 0.05) - 1.0).abs() < 0.03 && (sd(voltage) / 0.05 - 1.0).abs() < 0.03);
}
