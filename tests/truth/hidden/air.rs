//! Forces of the air other than thrust, and the air's own motion.

use super::thrust::{self, Flow};
use super::{Craft, World};
use crate::truth::drag;
use nalgebra::Vector3;

/// Size of the region that a fan reaches, m.
const FAN_M: f64 = 12.0;

/// Velocity through the air, body frame, m/s; `blowing` is the moving part of the air's, world.
pub fn velocity(craft: &Craft, world: &World, blowing: &Vector3<f64>) -> Vector3<f64> {
    let terms = &world.terms;
    let mut wind = Vector3::new(terms.wind[0], terms.wind[1], 0.0) + blowing;
    if let Some([speed, x, y]) = terms.fan {
        let away = craft.position.xy() - nalgebra::Vector2::new(x, y);
        wind.x += speed * (-away.norm_squared() / (2.0 * FAN_M * FAN_M)).exp();
    }
    craft.rotation().inverse() * (craft.velocity - wind)
}

/// Force over mass without thrust, body frame, m/s2; `lift` is thrust over mass.
pub fn force(craft: &Craft, world: &World, flow: &Flow, lift: f64) -> Vector3<f64> {
    let (terms, v, share) = (&world.terms, flow.air, craft.share());
    let mut force = drag::per_mass(&world.vehicle, v) * (1.0 - terms.axis_drag);
    force += drag::by_axis(&world.vehicle, v) * terms.axis_drag;
    let mut side = terms.rotor_drag * share;
    if terms.blade_drag > 0.0 {
        // Blades drag with their own speed, which goes with the root of thrust.
        let most = thrust::standing(&Craft { u: 1.0, ..*craft }, world, flow.time).max(1.0);
        side += terms.blade_drag * (lift.max(0.0) / most).sqrt();
    }
    if let Some([k, then]) = terms.drag_step {
        side += if flow.time > then { k } else { 0.0 };
    }
    force.x -= side * v.x;
    force.y -= side * v.y;
    force.x -= terms.drag_asymmetry * v.x * v.x;
    force.z -= terms.body_lift * v.xy().norm() * v.z;
    force.x += terms.body_lift * v.z * v.x;
    force.z -= terms.vertical_drag * v.z;
    force.y += terms.magnus * flow.rates.z * v.x;
    force
}
