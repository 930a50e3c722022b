//! A flight that nothing records, a command at a time: for who decides as it goes.

use super::link::Link;
use super::motion::{self, Inputs};
use super::motors::Controller;
use super::weather::Weather;
use super::{Craft, World, seen};
use crate::truth::{CONTROL_S, STEPS};
use racer::flight::pilot::Seen;

/// See the module.
pub struct Flight<'a> {
    pub craft: Craft,
    /// Since the pack was full, s.
    pub time_s: f64,
    world: &'a World,
    link: Link,
    weather: Weather,
    controller: Controller,
}

impl<'a> Flight<'a> {
    /// Begins as `craft`; `seed` decides the weather and which commands are lost.
    pub fn new(world: &'a World, craft: Craft, time_s: f64, seed: u64) -> Self {
        let (link, weather) = (Link::new(&world.terms, seed), Weather::new(&world.terms, seed));
        Flight { craft, time_s, world, link, weather, controller: Controller::default() }
    }

    /// What is true now.
    pub fn seen(&self) -> Seen {
        seen(&self.craft, self.world, self.time_s)
    }

    /// Holds `command` (roll, pitch, yaw rate, thrust in [-1, 1]) for a control step.
    pub fn hold(&mut self, command: [f64; 4]) {
        let dt = CONTROL_S / STEPS as f64;
        self.link.send(self.time_s, command);
        for k in 0..STEPS {
            let now = self.time_s + k as f64 * dt;
            let air = self.weather.next(dt);
            let motors = self.controller.next(&self.craft, self.world, &self.link, now, dt);
            let inputs = Inputs { link: &self.link, air, motors };
            self.craft = motion::flow(&self.craft, self.world, &inputs, now, now + dt);
        }
        self.time_s += CONTROL_S;
    }
}
