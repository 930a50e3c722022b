//! Runge-Kutta of fourth order over all states, split where a command arrives, and the ground.

use super::link::Link;
use super::thrust::Flow;
use super::weather::Air;
use super::{Craft, World, air, battery, inner, motors, thrust};
use nalgebra::{Quaternion, Vector2, Vector3, Vector4};
use std::f64::consts::TAU;

/// What acts from outside during one integration step.
pub struct Inputs<'a> {
    pub link: &'a Link,
    pub air: Air,
    /// Commands to single motors, where they are modelled.
    pub motors: Vector4<f64>,
}

/// Force over mass without gravity, body frame, m/s2: what an accelerometer at the centre feels.
pub fn specific_force(craft: &Craft, world: &World, inputs: &Inputs, command: [f64; 4], time: f64) -> Vector3<f64> {
    if craft.resting {
        return Vector3::new(0.0, 0.0, world.vehicle.gravity);
    }
    let v = air::velocity(craft, world, &inputs.air.velocity);
    let rates = inner::body_rates(craft, &world.terms);
    let wanted = inner::wanted(craft, world, command);
    let asked = inner::wanted(craft, world, inputs.link.newest());
    let flow = Flow { air: &v, rates: &rates, wanted: &wanted, asked: &asked, time };
    let lift = thrust::flying(craft, world, &flow);
    let mut force = Vector3::new(0.0, 0.0, lift) + air::force(craft, world, &flow, lift);
    if let Some(swing) = world.terms.swing {
        let w = TAU * swing.frequency;
        let pull = (craft.swing * (w * w) + craft.swinging * (2.0 * swing.damping * w)) * swing.share;
        force.x += pull.x + swing.push * craft.swinging.x / w;
        force.y += pull.y;
    }
    force *= 1.0 + world.terms.mass;
    force + craft.rotation().inverse() * inputs.air.force
}

/// Change of the state per second.
pub fn slope(craft: &Craft, world: &World, inputs: &Inputs, command: [f64; 4], time: f64) -> Craft {
    let force = specific_force(craft, world, inputs, command, time);
    let [relaxed, drawn] = battery::change(craft, world);
    let acceleration = craft.rotation() * force - Vector3::new(0.0, 0.0, world.vehicle.gravity);
    let mut change = Craft {
        position: craft.velocity,
        velocity: acceleration,
        attitude: craft.attitude * Quaternion::from_imag(inner::body_rates(craft, &world.terms)) * 0.5,
        relaxed,
        drawn,
        ..Craft::still()
    };
    if let Some(of) = world.terms.motors {
        change.rates = motors::angular(craft, &of);
        change.motors = (inputs.motors - craft.motors) / of.lag;
        // Collective thrust follows the mean of the motors.
        change.u = 2.0 * change.motors.mean();
    } else {
        [change.rates, change.spin] = inner::change(craft, world, command, time);
        change.u = thrust::change(craft, world, command[3]);
    }
    estimator(craft, world, &mut change);
    if let Some(of) = world.terms.swing {
        let w = TAU * of.frequency;
        let drive = if of.push > 0.0 { Vector2::new(w * w * craft.share(), 0.0) } else { -force.xy() };
        change.swing = craft.swinging;
        change.swinging = drive - craft.swing * (w * w) - craft.swinging * (2.0 * of.damping * w);
    }
    change
}

/// The velocity estimate: a low-pass, or an observer of second order.
fn estimator(craft: &Craft, world: &World, change: &mut Craft) {
    let terms = &world.terms;
    let behind = craft.velocity - craft.estimate;
    if terms.velocity_lag > 0.0 {
        change.estimate = behind / terms.velocity_lag;
    } else if terms.estimator > 0.0 {
        // Lag of (2 zeta / wn) with zeta 0.8.
        let wn = 1.6 / terms.estimator;
        change.estimate = craft.correction;
        change.correction = behind * (wn * wn) - craft.correction * (1.6 * wn);
    }
}

/// The state at `until`, from that at `time`.
pub fn flow(craft: &Craft, world: &World, inputs: &Inputs, time: f64, until: f64) -> Craft {
    let (mut craft, mut time) = (*craft, time);
    while until - time > 1e-12 {
        let next = inputs.link.next_edge(time, until).unwrap_or(until);
        craft = step(&craft, world, inputs, time, next - time);
        time = next;
    }
    craft
}

/// One step, in which no command arrives.
fn step(craft: &Craft, world: &World, inputs: &Inputs, time: f64, dt: f64) -> Craft {
    let command = inputs.link.at(time);
    let lifts = thrust::standing(craft, world, time) * (1.0 + world.terms.mass) > world.vehicle.gravity;
    let start = Craft { resting: craft.resting && !lifts, ..*craft };
    let slope = |s: &Craft, later: f64| slope(s, world, inputs, command, time + later);
    let a = slope(&start, 0.0);
    let b = slope(&start.moved(&a, 0.5 * dt), 0.5 * dt);
    let c = slope(&start.moved(&b, 0.5 * dt), 0.5 * dt);
    let d = slope(&start.moved(&c, dt), dt);
    let mut end = start.moved(&a, dt / 6.0).moved(&b, dt / 3.0).moved(&c, dt / 3.0).moved(&d, dt / 6.0);
    end.attitude = end.attitude.normalize();
    on_ground(end)
}

/// Stops what has come down to the ground; it comes to stand level, and takes off again when thrust lifts it.
fn on_ground(mut craft: Craft) -> Craft {
    if craft.position.z < 0.0 {
        let (_, _, yaw) = craft.rotation().euler_angles();
        let half = 0.5 * yaw;
        craft.position.z = 0.0;
        craft.velocity = Vector3::zeros();
        craft.attitude = Quaternion::new(half.cos(), 0.0, 0.0, half.sin());
        craft.resting = true;
    }
    craft
}
