//! The vehicle that is raced, with and without what is hidden, in either of the truths.

use crate::args::Args;
use crate::truth;
use crate::truth::effects::Hidden;
use crate::truth::hidden::{self, Setting, World};
use crate::truth::other::{self, Airframe, causes};
use crate::truths::{ByMotor, Truth};
use racer::flight::Log;
use racer::model::vehicle::Vehicle;
use rand::SeedableRng;
use rand::rngs::StdRng;

pub enum Truths {
    Effects(truth::Vehicle),
    ByMotor(Airframe),
}

impl Truths {
    pub fn of(args: &Args) -> Self {
        if args.by_motor {
            return Truths::ByMotor(Airframe::draw(args.draw.unwrap_or(1)));
        }
        Truths::Effects(args.draw.map_or_else(truth::Vehicle::seed_class, truth::Vehicle::draw))
    }

    /// The compact model that somebody would have of it.
    pub fn base(&self) -> Vehicle {
        match self {
            Truths::Effects(vehicle) => vehicle.in_racer(),
            Truths::ByMotor(airframe) => airframe.nominal().in_racer(),
        }
    }

    /// What `id` of that size is there; nothing where there is no size.
    pub fn hidden(&self, id: &str, size: f64) -> Option<Hidden> {
        let mut rng = StdRng::seed_from_u64(1);
        (size != 0.0).then(|| match self {
            Truths::Effects(vehicle) => Hidden::sized(id, size, vehicle, &mut rng),
            Truths::ByMotor(_) => {
                let mut cause = causes::draw(id, 1.0, &mut rng);
                cause.size = size;
                cause
            }
        })
    }

    pub fn world<'a>(&'a self, hidden: &'a [Hidden]) -> Box<dyn Truth + 'a> {
        match self {
            Truths::Effects(vehicle) => Box::new(World::new(vehicle, hidden)),
            Truths::ByMotor(airframe) => Box::new(ByMotor { airframe, hidden }),
        }
    }

    pub fn fly(&self, hidden: &[Hidden], setting: &Setting) -> Log {
        match self {
            Truths::Effects(vehicle) => hidden::fly(vehicle, hidden, setting),
            Truths::ByMotor(airframe) => other::fly(airframe, hidden, setting),
        }
    }
}
