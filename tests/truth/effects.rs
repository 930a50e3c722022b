//! What can be hidden in a flight: the truth that a diagnosis is scored against.
//!
//! Identifiers, equations and sizes of the matched form are the catalogue's; every effect is null at size 0 unless it
//! replaces a part of the model (second order, slew limit, asymmetric lag).

pub mod catalogue;
pub mod outside;
mod parts;
pub mod terms;
pub mod unmatched;

use super::Vehicle;
use catalogue::CATALOGUE;
use rand::RngExt;
use rand::rngs::StdRng;

/// A parameter that a diagnosis is to find.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    pub name: &'static str,
    pub value: f64,
    pub unit: &'static str,
    /// What an error is compared with: the value, or for a part of a vector its length.
    pub against: f64,
}

/// Something hidden in a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Hidden {
    /// Identifier of the catalogue, or what an unmatched or outside truth is called here.
    pub id: String,
    /// The main parameter, in the catalogue's unit.
    pub size: f64,
    /// Identifiers that are right names for it; none where it is outside the library.
    pub right: Vec<&'static str>,
    values: Vec<Value>,
    /// Numbers that it needs and that nobody is asked for.
    secret: Vec<(&'static str, f64)>,
}

impl Hidden {
    /// The catalogue's effect `id` at a random typical size, of either sign where physics allows both.
    ///
    /// # Panics
    ///
    /// Where the catalogue has no such identifier.
    pub fn draw(id: &str, vehicle: &Vehicle, rng: &mut StdRng) -> Self {
        let entry = catalogue::entry(id);
        let sign = if entry.signed && rng.random_bool(0.5) { -1.0 } else { 1.0 };
        let [low, high] = entry.range(vehicle);
        Self::sized(id, sign * log_range(rng, low, high), vehicle, rng)
    }

    /// The catalogue's effect `id` at `size`; directions and second parameters are random.
    pub fn sized(id: &str, size: f64, vehicle: &Vehicle, rng: &mut StdRng) -> Self {
        let entry = catalogue::entry(id);
        let (values, secret) = parts::of(entry, size, vehicle, rng);
        Hidden { id: id.into(), size, right: vec![entry.id], values, secret }
    }

    /// A truth that no equation of the catalogue describes.
    pub fn beyond(id: &str, size: f64, right: &[&'static str], secret: &[(&'static str, f64)]) -> Self {
        Hidden { id: id.into(), size, right: right.to_vec(), values: Vec::new(), secret: secret.to_vec() }
    }

    /// What is to be found, by name, with its unit.
    pub fn parameters(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.values.iter().map(|value| (value.name, value.value, value.unit)).collect()
    }

    /// What is to be found, and what errors are compared with.
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// A parameter or secret number by name.
    ///
    /// # Panics
    ///
    /// Where it has none of that name.
    pub fn get(&self, name: &str) -> f64 {
        let known = self.values.iter().map(|value| (value.name, value.value)).chain(self.secret.iter().copied());
        known.into_iter().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{} has no {name}", self.id)).1
    }

    /// Whether `effect` is a right name for it.
    pub fn is(&self, effect: &str) -> bool {
        self.right.contains(&effect)
    }
}

/// Ten effects of at most 0.4 times the catalogue's smallest size, and after them a dominant one: something that moves
/// the vehicle, of the stronger half of its sizes.
pub fn clutter(vehicle: &Vehicle, rng: &mut StdRng) -> Vec<Hidden> {
    let moving: Vec<_> = CATALOGUE.iter().filter(|e| e.dominates()).collect();
    let dominant = moving[rng.random_range(0..moving.len())];
    let small: Vec<_> = CATALOGUE.iter().filter(|e| e.shrinks() && e.id != dominant.id).collect();
    let mut drawn: Vec<Hidden> = Vec::new();
    while drawn.len() < 10 {
        let entry = small[rng.random_range(0..small.len())];
        if drawn.iter().all(|h| h.id != entry.id) {
            let size = entry.range(vehicle)[0] * rng.random_range(0.1..0.4);
            let sign = if entry.signed && rng.random_bool(0.5) { -1.0 } else { 1.0 };
            drawn.push(Hidden::sized(entry.id, sign * size, vehicle, rng));
        }
    }
    let [low, high] = dominant.range(vehicle);
    let middle = (low * high).sqrt();
    let size = if dominant.grows_downwards() { log_range(rng, low, middle) } else { log_range(rng, middle, high) };
    let sign = if dominant.signed && rng.random_bool(0.5) { -1.0 } else { 1.0 };
    drawn.push(Hidden::sized(dominant.id, sign * size, vehicle, rng));
    drawn
}

/// `vehicle` with time constants of the rates, maximum rates or thrust moved by 10 to 30 %: a base parameter that
/// drifted.
pub fn drifted(vehicle: &Vehicle, rng: &mut StdRng) -> Vehicle {
    let mut moved = vehicle.clone();
    let sign = if rng.random_bool(0.5) { -1.0 } else { 1.0 };
    let factor = 1.0 + sign * log_range(rng, 0.1, 0.3);
    match rng.random_range(0..3) {
        0 => moved.tau = std::array::from_fn(|k| if k < 3 { vehicle.tau[k] * factor } else { vehicle.tau[k] }),
        1 => moved.max_rate = vehicle.max_rate.map(|rate| rate * factor),
        _ => moved.thrust_n = vehicle.thrust_n.map(|c| c * factor),
    }
    moved
}

/// Evenly distributed in its logarithm.
pub fn log_range(rng: &mut StdRng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}
