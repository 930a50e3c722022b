//! Cards say what their equations read and write: each input of a stage is moved, and what the effect makes of it is
//! watched.

use racer::model::effects::{
    self, Actuator, AerodynamicForces, BatteryLoad, BodyRates as Rates, COUNT, Card, CommandDelay, CommandSetpoint,
    EffectValues, LOG_COUNT, Quantity, RelativeWind, Role, Sensed, ThrustInput,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::collections::BTreeSet;

/// A number that passes a stage: what it is on entry, and what it is part of on leaving, if effects may change it.
type Field = (Option<Quantity>, Option<Quantity>);

/// The numbers that pass a stage, and what an effect of these sizes does to them.
struct Passage {
    fields: Vec<Field>,
    run: fn(&[f64], &mut [f64]),
}

fn values(k: &[f64]) -> EffectValues<f64> {
    EffectValues::new(std::array::from_fn(|i| k[i]))
}

fn three(v: &[f64]) -> [f64; 3] {
    [v[0], v[1], v[2]]
}

fn four(v: &[f64]) -> [f64; 4] {
    [v[0], v[1], v[2], v[3]]
}

/// Fields of a stage, and the stage itself over their numbers.
type StageRow = (Vec<Vec<Field>>, fn(&[f64], &mut [f64]));

/// All stages, each as a row of numbers.
fn passages() -> Vec<Passage> {
    use Quantity::*;
    let fixed = |n: usize| vec![(None, None); n];
    let input = |q: Quantity, n: usize| vec![(Some(q), None); n];
    let changes = |from: Quantity, to: Quantity, n: usize| vec![(Some(from), Some(to)); n];
    let own = |q: Quantity, n: usize| vec![(Some(q), Some(q)); n];
    let command_delay: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = CommandDelay { rates: v[0], yaw: v[1], thrust: v[2] };
        effects::command_delay(&values(k), &mut s);
        v.copy_from_slice(&[s.rates, s.yaw, s.thrust]);
    };
    let setpoint: fn(&[f64], &mut [f64]) = |k, v| {
        let (rates, tau, max_rate) = (three(&v[5..]), four(&v[8..]), three(&v[12..]));
        let mut s = CommandSetpoint { command: four(v), throttle: v[4], rates, tau, max_rate };
        effects::setpoint(&values(k), &mut s);
        v[..4].copy_from_slice(&s.command);
    };
    let actuator: fn(&[f64], &mut [f64]) = |k, v| {
        let (inertia, slew) = (three(&v[5..]), three(&v[8..]));
        let mut s = Actuator { tau: four(v), tau_down: v[4], inertia, slew, slower: v[11], missing_v: v[12] };
        effects::actuator(&values(k), &mut s);
        v[..4].copy_from_slice(&s.tau);
        v[4] = s.tau_down;
        v[5..8].copy_from_slice(&s.inertia);
        v[8..11].copy_from_slice(&s.slew);
        v[11] = s.slower;
    };
    let body_rates: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = Rates { rates: three(v), throttle: v[3] };
        effects::body_rates(&values(k), &mut s);
        v[..3].copy_from_slice(&s.rates);
    };
    let battery: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = BatteryLoad { load: v[0], dt: v[1], charge: v[2], polarisation: v[3], drop: v[4] };
        effects::battery_load(&values(k), &mut s);
        (v[3], v[4]) = (s.polarisation, s.drop);
    };
    let thrust_input: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = ThrustInput { command: v[0], voltage: v[1], middle_v: v[2], behind: v[3] };
        effects::thrust_input(&values(k), &mut s);
        (v[0], v[1]) = (s.command, s.voltage);
    };
    let wind: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = RelativeWind { axes: [three(v), three(&v[3..]), three(&v[6..])], velocity: three(&v[9..]) };
        effects::relative_wind(&values(k), &mut s);
        v[9..].copy_from_slice(&s.velocity);
    };
    let forces: fn(&[f64], &mut [f64]) = |k, v| {
        let mut s = AerodynamicForces {
            throttle: v[0],
            velocity: three(&v[1..]),
            damping: v[4],
            drag: three(&v[5..]),
            rates: three(&v[8..]),
            height: v[11],
            rate_error: v[12],
            elapsed: v[13],
            specific_thrust: v[14],
            force: three(&v[15..]),
        };
        effects::aerodynamic_forces(&values(k), &mut s);
        v[14] = s.specific_thrust;
        v[15..].copy_from_slice(&s.force);
    };
    let sense: fn(&[f64], &mut [f64]) = |k, v| {
        let (rates, acceleration, force) = (three(v), three(&v[3..]), three(&v[6..]));
        let mut s = Sensed { rates, acceleration, force, throttle: v[9] };
        effects::SensorErrors::new(&k[COUNT..]).sense(&mut s);
        v[..3].copy_from_slice(&s.rates);
        v[6..9].copy_from_slice(&s.force);
    };
    let rows: Vec<StageRow> = vec![
        (vec![own(RateCommand, 2), own(ThrustCommand, 1)], command_delay),
        (
            vec![own(RateCommand, 3), own(ThrustCommand, 1), input(ThrustCommand, 1), input(RateCommand, 3), fixed(7)],
            setpoint,
        ),
        (vec![own(RateCommand, 3), own(ThrustCommand, 2), own(RateCommand, 7), fixed(1)], actuator),
        (vec![own(BodyRates, 3), input(ThrustCommand, 1)], body_rates),
        (vec![input(ThrustCommand, 1), fixed(1), input(Voltage, 1), own(Voltage, 2)], battery),
        (
            vec![
                changes(ThrustCommand, SpecificForce, 1),
                changes(Voltage, SpecificForce, 1),
                fixed(1),
                input(RateError, 1),
            ],
            thrust_input,
        ),
        (vec![fixed(9), changes(Velocity, SpecificForce, 3)], wind),
        (
            vec![
                input(ThrustCommand, 1),
                input(Velocity, 4),
                fixed(3),
                input(BodyRates, 3),
                fixed(1),
                input(RateError, 1),
                fixed(1),
                own(SpecificForce, 4),
            ],
            forces,
        ),
        (
            vec![
                changes(BodyRates, Gyro, 3),
                input(AngularAcceleration, 3),
                changes(SpecificForce, Accelerometer, 3),
                input(ThrustCommand, 1),
            ],
            sense,
        ),
    ];
    rows.into_iter().map(|(fields, run)| Passage { fields: fields.concat(), run }).collect()
}

/// What the effect reads and writes, seen from outside.
fn seen(card: &Card, rng: &mut StdRng) -> (BTreeSet<Quantity>, BTreeSet<Quantity>) {
    let mut k = vec![0.0; COUNT + LOG_COUNT];
    let span = effects::span(card.id).expect("listed");
    span.zip(card.parameters).for_each(|(i, p)| k[i] = p.typical[1]);
    let (mut reads, mut writes) = (BTreeSet::new(), BTreeSet::new());
    for Passage { fields, run } in passages() {
        for _ in 0..300 {
            let before: Vec<f64> = fields.iter().map(|_| rng.random_range(-1.0..1.0)).collect();
            let after = |change: Option<usize>| {
                let mut v = before.clone();
                change.into_iter().for_each(|i| v[i] += 1e-3);
                run(&k, &mut v);
                v
            };
            let plain = after(None);
            let changed: Vec<usize> = (0..fields.len()).filter(|&i| plain[i] != before[i]).collect();
            writes.extend(changed.iter().filter_map(|&i| fields[i].1));
            for (i, from) in fields.iter().enumerate().filter_map(|(i, f)| Some((i, f.0?))) {
                let other = after(Some(i));
                let through = |&o: &usize| o != i && fields[o].0 != Some(from) && (other[o] - plain[o]).abs() > 1e-12;
                if changed.iter().any(through) {
                    reads.insert(from);
                }
            }
        }
    }
    (reads, writes)
}

#[test]
fn cards_say_what_their_equations_read_and_write() {
    let mut rng = StdRng::seed_from_u64(7);
    for card in effects::cards() {
        let (reads, writes) = seen(card, &mut rng);
        let says = |all: &[Quantity]| all.iter().copied().collect::<BTreeSet<_>>();
        assert_eq!(reads, says(card.reads), "{} reads", card.id);
        // What a corrected reading integrates to is no stage, and what acts on the log is in none.
        let in_stages = matches!(card.role, Role::InStages | Role::ConstantError | Role::UniformWind | Role::OneMotor);
        let mut said = if in_stages { says(card.writes) } else { BTreeSet::new() };
        let reading = [Quantity::Gyro, Quantity::Accelerometer].iter().any(|q| writes.contains(q));
        // The velocity shows this one as well: the reading is right of the point that is logged.
        let corrects = reading && card.id != "com_offset";
        assert_eq!(said.remove(&Quantity::Integrated), corrects, "{} corrects a reading", card.id);
        assert_eq!(writes, said, "{} writes", card.id);
    }
}
